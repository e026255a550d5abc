// Implicit viscosity on the GPU (passes/implicit_viscosity/implicit.h): the viscous pairs, written down once
// a sub-step, and the conjugate gradients that read them, all iterations in one launch.
//
// The unknowns are entries: the fluid's particles in the order of their cells, [0, fluid), and behind them
// the particles of the bodies that may move, in theirs. The latter move with their bodies' twists.
#pragma once

#include "sim/cuda/solve_rows.h"
#include "sim/passes/implicit_viscosity/implicit.h"

namespace slosh::cuda {

/// A symmetric 3×3 an entry: xx, xy, xz, yy and yz, zz.
struct TensorColumn {
  float4* a = nullptr;
  float2* b = nullptr;
};

/// A body as the solve gets it.
struct DeviceViscousBody {
  ViscousBody body;
  glm::dvec3 center{0.0};            ///< of mass, m, world
  std::uint32_t begin = 0, end = 0;  ///< its particles in local order
  std::int32_t drag = -1;            ///< its place among the drags, below 0: none
};

/// A body's share of the vectors.
struct ViscousUnknown {
  Matrix6 factor;  // Cholesky of inertia + dt · drag
  Vector6 change, residual, product;
  Vector6 direction[2];  // of even and odd iterations: one is read while the next is written
};

/// What one solve leaves behind for the host.
struct ViscousOutcome {
  std::uint32_t iterations = 0;
  std::uint32_t converged = 0;
};

/// Sums over the fluid: one part for each kSolveThreads entries, and one for each body.
struct ViscousParts {
  double* mass = nullptr;       ///< kg
  double* step = nullptr;       ///< residual · its preconditioned self
  double* curvature = nullptr;  ///< direction · product
  double* left = nullptr;       ///< mass · (residual/mass)²
  double* changed = nullptr;    ///< mass · change²
  double* body_step = nullptr;
  double* body_curvature = nullptr;
};

/// All that the solve works on, in device memory.
struct ViscousView {
  std::uint32_t fluid = 0, surface = 0;  ///< entries
  PairRows rows;
  TensorColumn by_walls;  ///< of the fluid: N·s for each m/s of its own that fixed bodies take
  TensorColumn block;     ///< the inverse of its own block
  float4 *change = nullptr, *residual = nullptr, *product = nullptr;  ///< of the fluid
  float4* direction = nullptr;   ///< of every entry; w: mass, kg, 0 of what is not the fluid's
  float4* on_surface = nullptr;  ///< N·s on each particle of the bodies that may move, local order
  std::uint32_t bodies = 0;      ///< 0 where none may move
  const DeviceViscousBody* body = nullptr;
  ViscousUnknown* unknown = nullptr;
  const BodyDrag* drags = nullptr;
  Wrench* wrenches = nullptr;  ///< the drag on those that move, one a body
  ViscousParts parts;
  ViscousOutcome* outcome = nullptr;
};

/// viscous_rows.cu: the rows and own blocks of all entries over `dt` s, and each body particle's drag to
/// `moving`'s drag_a and drag_b, in N·s/m.
void launch_viscous_rows(const StepConstants& constants, const Plan& plan, const ParticleKind* kinds,
                         float first_viscosity, float dt, const SortedFluid& fluid,
                         const SortedSurface& fixed, const SortedSurface& moving, const LocalSurface& local,
                         const ViscousView& view, cudaStream_t stream);

/// viscous_iterations.cu: how many blocks of the solve can be on the GPU at a time, > 0, or an error.
cudaError_t most_solve_blocks(int& blocks);
/// The solve: adds to fluid.force the viscous force over `dt` s, fills view.wrenches and view.outcome, sets
/// kStatusViscosityCut. `blocks`: at most most_solve_blocks(); the result does not depend on it.
cudaError_t launch_viscous_solve(const StepConstants& constants, const Plan& plan, const ParticleKind* kinds,
                                 float first_viscosity, float dt, const SortedFluid& fluid,
                                 const SortedSurface& moving, const LocalSurface& local,
                                 const ViscousView& view, int blocks, std::uint32_t* status,
                                 cudaStream_t stream);

/// viscous_rows.cu: the viscous force by the velocities that the solve found on the particles of `fixed`
/// whose body is wanted, to `local`'s force, N.
void launch_drag_on_fixed(const StepConstants& constants, const Plan& plan, float first_viscosity,
                          const SortedFluid& fluid, const SortedSurface& fixed, const std::uint8_t* wanted,
                          const LocalSurface& local, const ViscousView& view, cudaStream_t stream);

}  // namespace slosh::cuda
