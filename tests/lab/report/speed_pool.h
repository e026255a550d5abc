// The pools of the paper's Figure 6: fluid alone, and with spheres that float in it.
#pragma once

#include <cstddef>

#include "scenes/sample.h"
#include "scenes/scene.h"

namespace slosh::report {

struct SpeedPool {
  Scene scene;
  SampledScene sampled;
  std::size_t body_particles = 0;  ///< of all spheres
  std::size_t wall_particles = 0;  ///< of the pool's walls, which no total counts
};

/// The least that speed_pool takes, 1.
inline constexpr std::size_t kMinSpeedParticles = 500;

/// A pool of 1 m by 1 m with `particles` (kMinSpeedParticles and more) of fluid and spheres together: without
/// spheres a fifth as deep as wide. `spheres`, 0 or a square number, are equal and free, have about
/// `on_spheres` particles in all (up to 0.4 of `particles`), do not touch, and float half submerged, or less
/// where the fluid is not deep enough; for large ones the pool is wider. Body particles lie on surfaces: a
/// sphere of as many is larger than the paper's, which is filled. Throws Refused.
SpeedPool speed_pool(std::size_t particles, std::size_t on_spheres, int spheres);

}  // namespace slosh::report
