#include "render/passes/bridges.h"

#include <algorithm>

namespace slosh {
namespace {

float squared(const glm::vec3& v) {
  return glm::dot(v, v);
}

}  // namespace

std::uint32_t Bridges::find_near(std::uint32_t a, float reach) {
  const glm::vec3 here = cells_.place(a);
  near_.clear();
  for (const ParticleCells::Run& run : cells_.around(here)) {
    for (std::uint32_t k = run.first; k < run.end; ++k) {
      if (k == a || squared(cells_.place(k) - here) >= reach * reach) continue;
      near_.push_back(k);
      if (near_.size() > kSurrounded) return kSurrounded + 1;
    }
  }
  return static_cast<std::uint32_t>(near_.size());
}

void Bridges::add(Frame& frame) {
  const std::size_t count = std::min(frame.particles.size(), frame.particle_fluid.size());
  const float radius = frame.particle_radius;
  if (count == 0 || count > kMaxParticles || !(radius > 0.0f)) return;
  const float reach = kMaxGap * radius;
  cells_.sort(frame, reach);
  particles_.assign(frame.particles.begin(), frame.particles.begin() + static_cast<std::ptrdiff_t>(count));
  fluids_.assign(frame.particle_fluid.begin(),
                 frame.particle_fluid.begin() + static_cast<std::ptrdiff_t>(count));
  neighbours_.resize(cells_.size());
  const auto may_bridge = [&](std::uint32_t a) {
    return neighbours_[a] >= 2 && neighbours_[a] <= kSurrounded;
  };
  for (std::uint32_t a = 0; a < cells_.size(); ++a) {
    neighbours_[a] = find_near(a, reach);
    if (!may_bridge(a)) continue;
    const glm::vec3 here = cells_.place(a);
    const std::uint8_t fluid = fluids_[cells_.source(a)];
    for (const std::uint32_t b : near_) {
      if (fluids_[cells_.source(b)] != fluid || (b < a && may_bridge(b))) continue;
      const glm::vec3 way = cells_.place(b) - here;
      const float length2 = squared(way);
      if (length2 < kMinGap * kMinGap * radius * radius) continue;
      // Who is nearer to the middle than the two is in reach of both.
      const glm::vec3 middle = here + 0.5f * way;
      const bool free = std::ranges::none_of(near_, [&](std::uint32_t k) {
        return k != b && squared(cells_.place(k) - middle) < 0.25f * length2;
      });
      if (!free) continue;
      particles_.push_back(middle);
      fluids_.push_back(fluid | FluidSample::kFlag);
    }
  }
  frame.particles = particles_;
  frame.particle_fluid = fluids_;
}

}  // namespace slosh
