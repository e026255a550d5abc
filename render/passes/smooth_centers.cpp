#include "render/passes/smooth_centers.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace slosh {
namespace {

constexpr float kReach = 3.6f;  // particle radii, 2.2 spacings: some 45 neighbours inside the fluid
constexpr float kShare = 0.9f;  // of the way to the mean (their λ)
constexpr float kFlat = 0.22f;  // of the reach: from a flat surface's particles to their mean

glm::ivec3 cell_of(const glm::vec3& at, float reach) {
  return glm::ivec3(glm::floor(glm::clamp(at / reach, glm::vec3(-1e8f), glm::vec3(1e8f))));
}

}  // namespace

std::size_t SmoothCenters::bucket_of(const glm::ivec3& cell) const {
  const auto hash = static_cast<std::uint32_t>(cell.x) * 73856093u ^
                    static_cast<std::uint32_t>(cell.y) * 19349663u ^
                    static_cast<std::uint32_t>(cell.z) * 83492791u;
  return hash & (begin_.size() - 2);
}

void SmoothCenters::sort(const Frame& frame) {
  const std::size_t count = std::min(frame.particles.size(), frame.particle_fluid.size());
  reach_ = kReach * frame.particle_radius;
  // Buckets: a power of two, and one entry for the end of the last.
  begin_.assign(std::bit_ceil(std::max<std::size_t>(count, 2)) + 1, 0);
  constexpr std::uint32_t kNone = ~0u;
  bucket_.assign(count, kNone);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3& at = frame.particles[i];
    if (frame.particle_fluid[i] >= frame.fluids.size() || !std::isfinite(at.x + at.y + at.z)) continue;
    bucket_[i] = static_cast<std::uint32_t>(bucket_of(cell_of(at, reach_)));
    ++begin_[bucket_[i] + 1];
    ++kept;
  }
  for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
  sorted_.resize(kept);
  // Filled from each bucket's end downwards; afterwards begin_[b + 1] is where b begins.
  for (std::size_t i = count; i-- > 0;) {
    if (bucket_[i] != kNone) sorted_[--begin_[bucket_[i] + 1]] = frame.particles[i];
  }
  for (std::size_t b = 0; b + 1 < begin_.size(); ++b) begin_[b] = begin_[b + 1];
  begin_.back() = static_cast<std::uint32_t>(kept);
}

void SmoothCenters::move(const Frame& frame, std::span<glm::vec4> spheres) const {
  const glm::mat4 world_from_eye = glm::inverse(frame.view.view);
  const float inverse = 1.0f / reach_;
  for (glm::vec4& sphere : spheres) {
    const glm::vec3 at(world_from_eye * glm::vec4(glm::vec3(sphere), 1.0f));
    const glm::ivec3 middle = cell_of(at, reach_);
    glm::vec3 sum(0.0f);  // of weighted ways to the neighbours, itself among them
    float weights = 0.0f;
    for (int n = 0; n < 27; ++n) {
      const glm::ivec3 cell = middle + glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      const std::size_t bucket = bucket_of(cell);
      for (std::uint32_t k = begin_[bucket]; k < begin_[bucket + 1]; ++k) {
        const glm::vec3 way = sorted_[k] - at;
        const float squared = glm::dot(way, way);
        // Cells may share a bucket: what is not of this cell comes with its own.
        if (squared >= reach_ * reach_ || cell_of(sorted_[k], reach_) != cell) continue;
        const float share = std::sqrt(squared) * inverse;
        const float weight = 1.0f - share * share * share;
        sum += weight * way;
        weights += weight;
      }
    }
    if (weights <= 0.0f) continue;
    // A particle of a flat surface would go inwards by a length that is known: without it, what sticks out
    // goes in, what lies deep comes out, and the surface as a whole stays. Inside, and in a thin sheet, means
    // are near: no correction.
    const glm::vec3 way = sum / weights;
    const float length = glm::length(way);
    const float flat = kFlat * reach_;
    const float kept = glm::smoothstep(0.3f * flat, 0.8f * flat, length) * flat / std::max(length, 1e-9f);
    const glm::vec3 moved = at + kShare * (1.0f - kept) * way;
    sphere = glm::vec4(glm::vec3(frame.view.view * glm::vec4(moved, 1.0f)), sphere.w);
  }
}

}  // namespace slosh
