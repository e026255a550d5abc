// The particle passes of a step on the CPU. sim/README.md lists what each reads and writes.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "sim/bodies.h"
#include "sim/cpu/parallel.h"
#include "sim/cpu/particles.h"
#include "sim/plan.h"

namespace slosh {

/// What all particles of one fluid (or one probe) share.
struct ParticleKind {
  float rest_density = 1000.0f;  ///< kg/m³
  float viscosity = 0.0f;        ///< Pa·s
  float mass = 0.0f;             ///< kg
  bool probe = false;            ///< moved by its body, not by the fluid integrator
};

/// What the passes of one run share. Constant but for `status`.
struct PassContext {
  Plan plan;
  CellGrid grid;
  KernelConstants kernels;
  float rest_number_density =
      0.0f;  ///< Σ of the kernel's shape over the rest lattice: density is measured against it
  float rest_volume = 0.0f;  ///< m³ of a particle at rest density
  glm::vec3 gravity{0.0f};
  std::vector<ParticleKind> kinds;
  std::atomic<std::uint32_t> status{0};
};

/// Sorts fluid particles by cell and reorders every column that lives on; forgets the retired ones.
void sort_fluid(PassContext& context, ThreadTeam& team, FluidParticles& fluid, KeySorter& sorter,
                FluidParticles& scratch);

/// The surface particles of all fixed or of all free bodies: placed with their bodies (Eq 14) and sorted by
/// cell, once for the fixed ones, every step for the free.
class BodySurface {
 public:
  /// Collects the particles of the bodies whose motion is `motion`. P_b and μ_b come from the scene.
  BodySurface(const Scene& scene, const SampledScene& sampled, const Plan& plan, BodyMotion motion);
  /// World positions and velocities from the bodies' states, sorted.
  void place(const PassContext& context, const std::vector<RigidBody>& bodies);

  const BoundaryParticles& sorted() const { return sorted_; }
  std::size_t size() const { return local_.size(); }

 private:
  struct Local {
    glm::vec3 position;  // in the mesh frame
    std::uint16_t body;
    float pressure, volume, viscosity;
  };
  std::vector<Local> local_;
  std::vector<std::uint32_t> keys_;
  std::vector<glm::vec3> placed_, velocity_;
  KeySorter sorter_;
  BoundaryParticles sorted_;
};

/// Eq 2 and 7: density (kPaper: from fluid particles only, section 4.1), then pressure and volume.
void compute_density(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                     const BoundaryParticles& fixed, const BoundaryParticles& moving);

/// Eq 5, 6 and 9 on fluid particles, by fluid and by body particles.
void compute_fluid_forces(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                          const BoundaryParticles& fixed, const BoundaryParticles& moving);

/// Eq 5, 6, 9 on body particles by fluid ones, summed by Eq 10–12 over those bodies of `boundary` that are
/// marked in `wanted` (one flag a body). Adds to wrenches, about each body's centre of mass, in a fixed
/// order.
void sum_body_wrenches(PassContext& context, ThreadTeam& team, const FluidParticles& fluid,
                       const BoundaryParticles& boundary, const std::vector<RigidBody>& bodies,
                       const std::vector<char>& wanted, std::vector<glm::vec3>& scratch,
                       std::vector<Wrench>& wrenches);

/// Leap-frog (section 3.1): v(t+½) from forces and gravity, x(t+1), then the new cell or retirement.
void integrate_fluid(PassContext& context, ThreadTeam& team, FluidParticles& fluid);

}  // namespace slosh
