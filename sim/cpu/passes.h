// The particle passes of a step on the CPU. sim/README.md lists what each reads and writes.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/cpu/parallel.h"
#include "sim/cpu/particles.h"
#include "sim/passes/body_drag/body_drag.h"
#include "sim/run_constants.h"

namespace slosh {

/// What the passes of one run share. Constant but for the two counts.
struct PassContext : RunConstants {
  std::atomic<std::uint32_t> status{0};
  std::atomic<std::uint64_t> broken{0};  ///< ParticleState's
};

struct FluidViscosity;
struct FluidPress;

/// Pa·s of a fluid particle itself, whoever it meets.
inline float particle_viscosity(const PassContext& context, const FluidParticles& fluid, std::size_t p) {
  return fluid.thickness.empty() ? context.kinds[fluid.kind[p]].viscosity : fluid.thickness[p];
}

/// Sorts fluid particles by cell and reorders every column that lives on; forgets the retired ones.
void sort_fluid(PassContext& context, ThreadTeam& team, FluidParticles& fluid, KeySorter& sorter,
                GatheredColumns& scratch);

/// The surface particles of all fixed or of all free bodies: placed with their bodies (Eq 14) and sorted by
/// cell, once for the fixed ones, every step for the free.
class BodySurface {
 public:
  explicit BodySurface(std::vector<SurfaceParticle> particles);
  /// World positions and velocities from the bodies' states, sorted.
  void place(const PassContext& context, std::span<const RigidBody> bodies);
  /// Gives each particle the velocity of its body's twist in `twists` (one a body) about where the body was
  /// placed.
  void set_velocities(std::span<const RigidBody> bodies, std::span<const Twist> twists);

  /// Other particles from place `first` on, of the same body.
  void replace(std::size_t first, std::span<const SurfaceParticle> particles);

  const BoundaryParticles& sorted() const { return sorted_; }

 private:
  // Of one body among local_.
  struct Run {
    std::size_t body = 0, first = 0, end = 0;
  };
  std::vector<SurfaceParticle> local_;
  std::vector<Run> runs_;
  std::vector<std::uint32_t> keys_;
  std::vector<std::uint32_t> from_;  // which of local_ each placed one is
  std::vector<glm::vec3> placed_, velocity_;
  KeySorter sorter_;
  BoundaryParticles sorted_;
};

/// Eq 2 and 7: density (kPaper: from fluid particles only, section 4.1), then pressure and volume. With
/// kPressureSolve or kImplicitViscosity `press` gets the pressure pairs: the same loop over the neighbours
/// finds it.
void compute_density(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                     const BoundaryParticles& fixed, const BoundaryParticles& moving, FluidPress& press);

/// The same for the corrected model (density.cpp calls it), and with it each one's pressure tensor and
/// damping.
void compute_corrected_density(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                               const BoundaryParticles& fixed, const BoundaryParticles& moving,
                               FluidPress& press);

/// Eq 5, 6 and 9 on fluid particles, by fluid and by body particles. With kImplicitViscosity without the
/// viscous force, and `drag` gets the viscous pairs over `dt` s (pressure_force/cpu_rows.cpp): both by
/// `press`, which is from the density pass.
void compute_fluid_forces(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                          const BoundaryParticles& fixed, const BoundaryParticles& moving, double dt,
                          FluidViscosity& drag, FluidPress& press);

/// The same with kImplicitViscosity (force.cpp calls it).
void compute_forces_by_rows(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                            const BoundaryParticles& fixed, const BoundaryParticles& moving, double dt,
                            FluidViscosity& drag, const FluidPress& press);

/// What each chunk of body particles' runs adds, body by body.
struct SurfaceSums {
  struct Part {
    int body;
    Wrench wrench;
    BodyDrag drag;
  };
  std::vector<std::vector<Part>> of_chunk;
};

/// Eq 5, 6, 9 on body particles by fluid ones, summed by Eq 10–12 over those bodies of `boundary` that are
/// marked in `wanted` (one flag a body). Adds to wrenches, about `centers` (m, world, one a body), in a fixed
/// order; and to `drags` (one a body) unless it is empty.
void sum_body_wrenches(PassContext& context, ThreadTeam& team, const FluidParticles& fluid,
                       const BoundaryParticles& boundary, std::span<const glm::dvec3> centers,
                       const std::vector<char>& wanted, SurfaceSums& scratch, std::span<Wrench> wrenches,
                       std::span<BodyDrag> drags);

/// Adds to the forces on the fluid the viscous force of moving body particles by the velocities that they
/// have now; `press` is from the force pass.
void drag_fluid(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                const BoundaryParticles& moving, const FluidPress& press);

/// The bodies of the penetration clamp in a sub-step, and what it takes from particles.
struct WallClamps {
  const ClampBodies& solids;
  std::span<const glm::dvec3> centers;  ///< m, world, of mass as the sub-step ends, one a body
  std::span<std::int64_t> impulses;     ///< as ImpulseSums; added to
};

/// Leap-frog (section 3.1) over `dt` s: v(t+½) from forces and gravity, x(t+1), no further than to the walls,
/// then the new cell or retirement.
void integrate_fluid(PassContext& context, ThreadTeam& team, FluidParticles& fluid, const WallClamps& clamps,
                     double dt);

}  // namespace slosh
