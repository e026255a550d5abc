#include "tests/lab/picture/reference/focused_light.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <thread>

#include "render/shader_math.h"
#include "tests/lab/picture/reference/sampling.h"

namespace slosh::reference {
namespace {

constexpr int kMaxIterations = 32;
constexpr float kApart = 2e-5f;           // m that a new ray starts off a surface
constexpr float kPhotonsInReach = 50.0f;  // of unfocused light
constexpr float kMargin = 1e-3f;          // m, round the fluids

}  // namespace

void Bounds::add(const glm::vec3& point) {
  const bool first = empty();
  low = first ? point : glm::min(low, point);
  high = first ? point : glm::max(high, point);
}

FocusedLight::FocusedLight(const RayScene& scene, std::span<const FluidLook> looks,
                           const std::vector<RayTexture>& textures, const Source& source) {
  if (source.fluids.empty() || source.photons < 1) return;
  // The fluids' box, seen from the light: a rectangle that photons start from, in even cells.
  const glm::vec3 other = std::abs(source.to_light.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 u = glm::normalize(glm::cross(other, source.to_light));
  const glm::mat3 axes(u, glm::cross(source.to_light, u), source.to_light);
  Bounds seen;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::bvec3 high(corner & 1, corner & 2, corner & 4);
    seen.add(glm::mix(source.fluids.low, source.fluids.high, high) * axes);
  }
  seen.low -= kMargin;
  seen.high += kMargin;
  const int side = std::max(static_cast<int>(std::lround(std::sqrt(source.photons))), 1);
  const glm::vec2 step = glm::vec2(seen.high - seen.low) / static_cast<float>(side);
  radius_ = std::sqrt(kPhotonsInReach * step.x * step.y / glm::pi<float>());

  const auto follow = [&](int column, int row, std::vector<Photon>& out) {
    Random random((std::uint64_t{1} << 40) + static_cast<std::uint64_t>(row),
                  static_cast<std::uint64_t>(column));
    const glm::vec2 start =
        glm::vec2(seen.low) + step * (glm::vec2(column, row) + glm::vec2(random(), random()));
    glm::vec3 from = axes * glm::vec3(start, seen.high.z);
    glm::vec3 way = -source.to_light;
    glm::vec3 flux = step.x * step.y * source.arriving(from);
    int fluid = -1;
    bool met = false;
    for (int turn = 0; turn < kMaxIterations; ++turn) {
      if (!(flux.x + flux.y + flux.z > 0.0f)) return;
      const Hit hit = scene.nearest(from, way);
      if (!hit.there()) return;
      // What is scattered on its way is lost, as for light that comes straight.
      if (fluid >= 0) flux *= glm::exp(-looks[static_cast<std::size_t>(fluid)].extinction * hit.distance);
      from += way * hit.distance;
      if (hit.fluid >= 0) {
        const bool entering = glm::dot(hit.face, way) < 0.0f;
        if (cross_fluid(hit, looks[static_cast<std::size_t>(hit.fluid)], false, way, random))
          fluid = entering ? hit.fluid : -1;
        met = true;
      } else if (const SurfaceLook surface = look_at(hit, textures); surface.look.opacity < 1.0f) {
        const float facing = std::max(std::abs(glm::dot(hit.normal, way)), 1e-3f);
        flux *= pane_tint(surface.look, facing) *
                (1.0f - shader::pane_reflectance(shader::schlick(0.04f, facing)));
      } else if (!surface.hole) {
        if (met) out.push_back({from, glm::dot(hit.face, way) > 0.0f ? -hit.face : hit.face, flux});
        return;
      }
      from += way * kApart;
    }
  };
  std::vector<std::vector<Photon>> rows(static_cast<std::size_t>(side));
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int row = next++; row < side; row = next++) {
      for (int column = 0; column < side; ++column) follow(column, row, rows[static_cast<std::size_t>(row)]);
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < source.threads; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<Photon>& row : rows) photons_.insert(photons_.end(), row.begin(), row.end());
  for (std::size_t i = 0; i < photons_.size(); ++i)
    cells_[cell(photons_[i].at)].push_back(static_cast<std::uint32_t>(i));
}

glm::vec3 FocusedLight::at(const glm::vec3& point, const glm::vec3& normal) const {
  glm::vec3 sum(0.0f);
  if (photons_.empty()) return sum;
  const glm::ivec3 middle = cell(point);
  glm::ivec3 c;
  for (c.z = middle.z - 1; c.z <= middle.z + 1; ++c.z) {
    for (c.y = middle.y - 1; c.y <= middle.y + 1; ++c.y) {
      for (c.x = middle.x - 1; c.x <= middle.x + 1; ++c.x) {
        const auto found = cells_.find(c);
        if (found == cells_.end()) continue;
        for (const std::uint32_t i : found->second) {
          const Photon& photon = photons_[i];
          const glm::vec3 off = photon.at - point;
          const float weight = 1.0f - glm::dot(off, off) / (radius_ * radius_);
          if (weight > 0.0f && glm::dot(photon.normal, normal) > 0.3f) sum += weight * photon.flux;
        }
      }
    }
  }
  return sum * (2.0f / (glm::pi<float>() * radius_ * radius_));
}

}  // namespace slosh::reference
