// From meshes to particles and distance fields at one spacing.
#pragma once

#include "scenes/scene.h"
#include "sim/math/result.h"

#include <cstddef>

namespace slosh {

/// Samples every body's surface evenly (blue noise, about one particle a spacing²), fills every fluid volume
/// with a lattice that keeps half a spacing clear of solids, and builds one distance field a body.
/// Deterministic. Errors: spacing above a wall's thickness, fluid overlapping a solid, no particle fits.
Result<SampledScene> sample_scene(const Scene& scene, double spacing);

/// A quick estimate for choosing a spacing, without sampling: fluid volume / spacing³ and area / spacing².
struct ParticleEstimate {
  double fluid = 0.0;
  double surface = 0.0;
};
ParticleEstimate estimate_particles(const Scene& scene, double spacing);

/// The thinnest solid wall of any body, m (infinity when there is none); `body` receives whose it is.
double thinnest_wall(const Scene& scene, std::size_t* body = nullptr);

}  // namespace slosh
