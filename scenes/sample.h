// From meshes to particles and distance fields at one spacing.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "scenes/scene.h"
#include "sim/math/result.h"

namespace slosh {

/// What became of one fluid volume, m³. `sampled` is `mesh` less the rest, to a particle.
struct FilledVolume {
  double mesh = 0.0;       ///< what its mesh encloses
  double sampled = 0.0;    ///< what its particles stand for
  double in_bodies = 0.0;  ///< of the mesh, inside bodies
  double in_others = 0.0;  ///< of the mesh, taken by volumes before it
  double no_place = 0.0;   ///< what found no free place at this spacing
};

/// One entry a fluid volume of the scene.
struct SampleReport {
  std::vector<FilledVolume> volumes;
};

/// Samples every body's surface evenly (blue noise, about one particle a spacing²), fills every fluid volume
/// with a lattice that keeps half a spacing clear of solids, and builds one distance field a body.
/// Deterministic. Errors: spacing above a wall's thickness, fluid overlapping a solid, no particle fits.
/// `report` receives what became of the fluid volumes, unless null. `tell`, where there is one, is told the
/// share of the work that is done, 0–1, mesh by mesh and between the stages of each.
Result<SampledScene> sample_scene(const Scene& scene, double spacing, SampleReport* report = nullptr,
                                  const std::function<void(double)>& tell = {});

/// How far apart the samples of a body's surface are, m. Boundary particle layers have bumps, which brake
/// what slides along them: fluid that turns slowly in a glass without friction loses a quarter of that in 0.4
/// s. Of fixed bodies that slip they are finer than `spacing`, and the bumps are gone
/// (tests/notebook/2026-11-25-free-slip-walls.md). Bodies that move keep the spacing, as do models that do
/// not correct gradients.
double boundary_spacing(const Scene& scene, const Body& body, double spacing);

/// A quick estimate for choosing a spacing, without sampling: fluid volume / spacing³ and area / spacing².
struct ParticleEstimate {
  double fluid = 0.0;
  double surface = 0.0;
};
ParticleEstimate estimate_particles(const Scene& scene, double spacing);

/// s of one ordinary core that sample_scene takes for so many, to within a factor of about two.
double estimate_sampling(const ParticleEstimate& particles);

/// The thinnest solid wall of any body, m (infinity when there is none); `body` receives whose it is.
double thinnest_wall(const Scene& scene, std::size_t* body = nullptr);

}  // namespace slosh
