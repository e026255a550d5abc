#include "render/passes/smooth_centers.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace slosh {
namespace {

constexpr float kReach = 4.0f;  // particle radii, 2.5 spacings: some 60 neighbours inside the fluid
constexpr float kShare = 0.9f;  // of the way to the mean (their λ)
constexpr float kFlat = 0.22f;  // of the reach: from a flat surface's particles to their mean

// Of ellipsoids, in particle radii. Along a flat surface, and in what is round: a drop, or a particle inside
// that shows through a gap; the least that an ellipsoid is thick, which is what a sheet of one layer has.
constexpr float kAlong = 2.2f;
constexpr float kRound = 1.2f;
constexpr float kThin = 0.6f;
constexpr float kFull = 0.15f;  // of the reach squared: a neighbourhood's variance where it is full

/// Weighted moments of the ways to a particle's neighbours, itself among them. m
class Neighbourhood {
 public:
  void add(const glm::vec3& way, float weight) {
    weights_ += weight;
    sum_ += weight * way;
    const glm::vec3 w = weight * way;
    square_ += way * w;
    mixed_ += glm::vec3(w.x * way.y, w.y * way.z, w.z * way.x);
  }

  /// Where the centre goes.
  glm::vec3 step(float reach) const {
    if (weights_ <= 0.0f) return glm::vec3(0.0f);
    // A particle of a flat surface would go inwards by a length that is known: without it, what sticks out
    // goes in, what lies deep comes out, and the surface as a whole stays. Inside, and in a thin sheet, means
    // are near: no correction.
    const glm::vec3 way = sum_ / weights_;
    const float length = glm::length(way);
    const float flat = kFlat * reach;
    const float kept = glm::smoothstep(0.3f * flat, 0.8f * flat, length) * flat / std::max(length, 1e-9f);
    return kShare * (1.0f - kept) * way;
  }

  /// m². Radii go with the variances, as theirs do; so no axes have to be found.
  glm::mat3 ellipsoid(float reach, float radius) const {
    const float ball = kRound * kRound * radius * radius;
    if (weights_ < kFewNeighbours) return glm::mat3(ball);
    const glm::vec3 mean = sum_ / weights_;
    const float scale = 1.0f / (kFull * reach * reach);
    const glm::vec3 d = (square_ / weights_ - mean * mean) * scale;
    const glm::vec3 m = (mixed_ / weights_ - mean * glm::vec3(mean.y, mean.z, mean.x)) * scale;
    const glm::mat3 variance(d.x, m.x, m.z, m.x, d.y, m.y, m.z, m.y, d.z);
    // 1 where it is as wide in every direction.
    const float third = (d.x + d.y + d.z) / 3.0f;
    const float round = glm::determinant(variance) / std::max(third * third * third, 1e-9f);
    const float size = radius * glm::mix(kAlong, kRound, glm::smoothstep(0.7f, 0.95f, round));
    const glm::mat3 wide = size * size * (variance * variance) + glm::mat3(kThin * kThin * radius * radius);
    // Few neighbours say little about a shape.
    const float known = glm::smoothstep(kFewNeighbours, 2.0f * kFewNeighbours, weights_);
    return glm::mat3(ball) * (1.0f - known) + wide * known;
  }

 private:
  static constexpr float kFewNeighbours = 4.0f;  // in sum of weights, itself counting as one
  float weights_ = 0.0f;
  glm::vec3 sum_{0.0f};
  glm::vec3 square_{0.0f};
  glm::vec3 mixed_{0.0f};  // xy, yz, zx
};

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
    if (bucket_[i] == kNone) continue;
    sorted_[--begin_[bucket_[i] + 1]] = {frame.particles[i], cell_of(frame.particles[i], reach_)};
  }
  for (std::size_t b = 0; b + 1 < begin_.size(); ++b) begin_[b] = begin_[b + 1];
  begin_.back() = static_cast<std::uint32_t>(kept);
  smoothed_.resize(count);
  known_.assign(count, 0);
}

SmoothCenters::Smoothed SmoothCenters::smooth(const glm::vec3& at, float radius) const {
  const float inverse = 1.0f / reach_;
  const glm::ivec3 middle = cell_of(at, reach_);
  Neighbourhood around;
  for (int n = 0; n < 27; ++n) {
    const glm::ivec3 cell = middle + glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    const std::size_t bucket = bucket_of(cell);
    for (std::uint32_t k = begin_[bucket]; k < begin_[bucket + 1]; ++k) {
      const glm::vec3 way = sorted_[k].at - at;
      const float squared = glm::dot(way, way);
      // Cells may share a bucket: what is not of this cell comes with its own.
      if (squared >= reach_ * reach_ || sorted_[k].cell != cell) continue;
      const float share = std::sqrt(squared) * inverse;
      around.add(way, 1.0f - share * share * share);
    }
  }
  return {at + around.step(reach_), around.ellipsoid(reach_, radius)};
}

void SmoothCenters::move(const Frame& frame, Splats& splats) {
  const glm::mat3 turn(frame.view.view);
  splats.shapes.resize(splats.spheres.size());
  for (std::size_t i = 0; i < splats.spheres.size(); ++i) {
    const std::uint32_t particle = splats.particles[i];
    Smoothed& smoothed = smoothed_[particle];
    if (!known_[particle]) {
      smoothed = smooth(frame.particles[particle], frame.particle_radius);
      known_[particle] = 1;
    }
    glm::vec4& sphere = splats.spheres[i];
    sphere = glm::vec4(glm::vec3(frame.view.view * glm::vec4(smoothed.center, 1.0f)), sphere.w);
    splats.shapes[i] = shape_of(turn * smoothed.ellipsoid * glm::transpose(turn), glm::vec3(sphere));
  }
}

}  // namespace slosh
