// Pressure projection on the GPU (passes/pressure_solve/solved_state.h has the system): the pressure pairs,
// written down once a sub-step, and the conjugate gradients that read them, all iterations in one launch.
//
// The unknowns are the fluid's pressures. Entries are the fluid's particles in the order of their cells,
// [0, fluid), and behind them the particles of the bodies that may move, in theirs: those have rows too, by
// which pressures push their bodies.
#pragma once

#include "sim/cuda/solve_rows.h"
#include "sim/passes/implicit_viscosity/implicit.h"
#include "sim/passes/pressure_solve/limits.h"

namespace slosh::cuda {

/// A body as the solve gets it.
struct DevicePressedBody {
  ViscousBody body;
  glm::dvec3 center{0.0};            ///< of mass, m, world
  std::uint32_t begin = 0, end = 0;  ///< its particles in local order
};

/// What the solve has of a body.
struct PressedUnknown {
  Matrix6 factor;  ///< Cholesky of its inertia
  Vector6 twist;   ///< 0 where it does not move
};

/// Sums over the fluid: one part for each kSolveThreads entries.
struct PressureParts {
  double* step = nullptr;       ///< residual · preconditioned residual
  double* turned = nullptr;     ///< the same with the residual before
  double* clipped = nullptr;    ///< what pressures went below 0 by, squared, times the diagonal
  double* squares = nullptr;    ///< residual²
  double* pressing = nullptr;   ///< how many press
  double* curvature = nullptr;  ///< direction · product
};
inline constexpr int kPressureParts = 6;

/// All that the solve works on, in device memory.
struct PressureView {
  std::uint32_t fluid = 0, surface = 0;  ///< entries
  /// Of the fluid: what 1 Pa of its own pushes it by, m², by fluid and, behind those, by bodies that may
  /// move. Of a body's particle: what 1 Pa of a fluid particle pushes it by.
  PairRows rows;
  std::uint32_t* with_fluid = nullptr;  ///< how many of an entry's pairs are with fluid
  float4* by_other = nullptr;           ///< what 1 Pa of the other pushes it by, m²: of pairs of fluid alone
  float4* own = nullptr;      ///< of the fluid: what 1 Pa of its own pushes it by, m², by fluid, walls and
                              ///< bodies; w: the sum of its square by fluid over each neighbour's mass, m⁴/kg
  float* flow = nullptr;      ///< Q v − V⁰ e/dt, m³/s: wanted 0 where it presses, not below 0 elsewhere
  float* inverse = nullptr;   ///< of the system's diagonal
  float* pressure = nullptr;  ///< Pa
  float* residual = nullptr;  ///< −flow of those that press
  float* product = nullptr;   ///< the system times the direction
  float* clipped = nullptr;   ///< Pa, what was cut off below 0 and `flow` does not know of
  float* direction = nullptr;                        ///< Pa
  float4* velocity = nullptr;                        ///< m/s; in w 1/mass
  float4 *on_surface = nullptr, *turning = nullptr;  ///< N and N·m on each body's particle, local order
  std::uint32_t bodies = 0;                          ///< 0 where none may move
  const DevicePressedBody* body = nullptr;
  PressedUnknown* unknown = nullptr;
  Wrench* wrenches = nullptr;  ///< what the pressures found add to the last ones', one a body
  std::uint32_t first_probe = 0;
  float4* probes = nullptr;  ///< N, by id less first_probe; null where there are none
  PressureParts parts;
};

/// pressure_rows.cu: the rows of all entries.
void launch_pressure_rows(const StepConstants& constants, const ParticleKind* kinds, const SortedFluid& fluid,
                          const SortedSurface& fixed, const SortedSurface& moving, const PressureView& view,
                          cudaStream_t stream);
/// pressure_iterations.cu: adds to fluid.force what the last step's pressures push each by.
void launch_push_by_last(const StepConstants& constants, const SortedFluid& fluid,
                         const SortedSurface& moving, const PressureView& view, cudaStream_t stream);

/// How many blocks of the solve can be on the GPU at a time, > 0, or an error.
cudaError_t most_pressure_blocks(int& blocks);
/// The solve: adds to fluid.force what the pressures found over `dt` s differ by from the last ones, replaces
/// those, fills view.wrenches and view.probes. `density_time`: s (step_limits.h). `blocks`: at most
/// most_pressure_blocks(); the result does not depend on it.
cudaError_t launch_pressure_solve(const StepConstants& constants, const ParticleKind* kinds, float dt,
                                  float density_time, const SortedFluid& fluid, const SortedSurface& moving,
                                  const LocalSurface& local, const PressureView& view, int blocks,
                                  cudaStream_t stream);

}  // namespace slosh::cuda
