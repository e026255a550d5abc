// What the particle passes of one run share, on either backend, and what the particles start from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.h"
#include "sim/bodies/rigid_body.h"
#include "sim/columns.h"
#include "sim/neighbours/cell_grid.h"
#include "sim/passes/density/corrected_state.h"
#include "sim/passes/heat/conduction.h"
#include "sim/plan.h"
#include "sim/walls/clamp_bodies.h"
#include "sim/walls/clamp_impulse.h"
#include "sim/walls/wall_particles.h"

namespace slosh {

/// What all particles of one fluid (or one probe) share.
struct ParticleKind {
  float rest_density = 1000.0f;      ///< kg/m³
  float viscosity = 0.0f;            ///< Pa·s, with kHeat that of the start (HeatKind)
  float mass = 0.0f;                 ///< kg
  float pressing_density = 1000.0f;  ///< kg/m³ that Eq 7 takes for it (step_limits.h, pressing_density)
  bool probe = false;                ///< moved by its body, not by the fluid integrator
  float least_viscosity = 0.0f;      ///< Pa·s, below `viscosity` where kHeat lowers it
};

struct RunConstants {
  Plan plan;
  HeatConstants heat;  ///< kHeat's; else empty
  CellGrid grid;
  float support_radius = 0.0f;              ///< m
  float force_scale = 0.0f;                 ///< the force kernel's constant, m⁻⁶
  DragShape<float> drag_shape{1.0f, 0.0f};  ///< of all pairs
  float rest_number_density =
      0.0f;  ///< Σ of the kernel's shape over the rest lattice: density is measured against it
  float rest_volume = 0.0f;  ///< m³ of a particle at rest density
  CorrectionConstants
      correction;  ///< ParticleModel::kCorrected's, of the lattice (passes/rest_density/rest_density.h)
  double load_compression = 0.0;  ///< ρ/ρ⁰ − 1 of the fluid under its own weight, mean over its depth
  glm::vec3 gravity{0.0f};
  std::vector<ParticleKind> kinds;
  ImpulseUnits impulse_units;  ///< of what walls take from particles
};

/// Fluid denser than this over rest (ρ/ρ⁰ − 1) sets kStatusCompressed: a drop that hits a table at half the
/// speed of sound gets to half of this.
inline constexpr float kTooCompressed = 1.0f;

/// A probe is one more particle, moved by its body (section 3).
struct Probe {
  std::uint32_t id = 0;  ///< of the particle
  int body = 0;
};

/// The particles at the start, by id: the scene's fluid first, the probes behind it.
struct ParticleStart {
  ParticleState
      particles;  ///< with their kinds; at rest volume; retired those outside the domain or not finite
  std::uint32_t status = 0;  ///< StatusBits of those
  std::vector<Probe> probes;
  std::size_t fluid_count = 0;  ///< without the probes
  std::size_t waiting = 0;      ///< of these, so many come later (FluidVolume), retired until then
  std::vector<SurfaceParticle> fixed, moving;
  std::vector<DistanceField> clamp_fields;  ///< one a body (clamp_fields)
};

/// One entry a fluid of the scene, and one a probe behind those.
std::vector<ParticleKind> particle_kinds(const Scene& scene, double spacing);

/// Whether any of them needs artificial viscosity (viscosity/artificial_viscosity.h) beside its own. `noise`:
/// Pa·s, what one without viscosity needs.
bool any_artificial_viscosity(std::span<const ParticleKind> kinds, float noise);

/// Everything of a run's constants; kinds has one entry a fluid, and one a probe behind those.
RunConstants make_run_constants(const Scene& scene, const SampledScene& sampled, Plan plan);

ParticleStart make_particle_start(const Scene& scene, const SampledScene& sampled,
                                  const RunConstants& constants, std::span<const RigidBody> bodies);

}  // namespace slosh
