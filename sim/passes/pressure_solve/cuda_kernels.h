// Pressure projection on the GPU (passes/pressure_solve/solved_state.h has the system): the pressure pairs,
// written down once a sub-step, and the conjugate gradients that read them, all iterations in one launch.
//
// The unknowns are the fluid's pressures. The particles of the bodies that may move have rows too, by which
// pressures push their bodies.
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

/// Sums over the fluid: one part a block.
struct PressureParts {
  double* step = nullptr;       ///< residual · preconditioned residual
  double* turned = nullptr;     ///< the same with the residual before
  double* clipped = nullptr;    ///< what pressures went below 0 by, squared, times the diagonal
  double* squares = nullptr;    ///< residual²
  double* pressing = nullptr;   ///< how many press
  double* curvature = nullptr;  ///< direction · product
};
inline constexpr int kPressureParts = 6;

/// The pairs of the fluid with fluid, 8 bytes each and twice: for a flow what 1 Pa of a particle pushes
/// itself by, for a push what 1 Pa of the other does. Three pushes of 16 bits in units of the particle whose
/// pressure it is, and 16 bits of by how much the other's place is above that of the entry before: a row is
/// in the fluid's order. Where it is further an entry without a push lies between; such fill rows up to a
/// multiple of kListed. The pushes of p and j by p's pressure are opposite to the last bit.
struct PressRows {
  std::uint32_t room = 0;     ///< entries a thread, a multiple of kListed; who has more walks the cells anew
  uint4* by_own = nullptr;    ///< two entries each; those of a warp's 32 threads are one run of memory
  uint4* by_other = nullptr;  ///< the same, of the same pairs
  uint2* heads = nullptr;     ///< the first entry's other, and how many entries, written down or not

  SLOSH_HD std::size_t at(std::uint32_t thread) const {
    return std::size_t{thread / 32} * (room * 16) + thread % 32;
  }
  static std::size_t places(std::size_t threads, std::uint32_t room) {
    return (threads + 31) / 32 * (room * 16);
  }
};

/// All that the solve works on, in device memory.
struct PressureView {
  std::uint32_t fluid = 0, surface = 0;  ///< particles, the latter of the bodies that may move
  PressRows rows;                        ///< one a thread, kTensorTeams.lanes() a particle
  PairRows touches;       ///< of the fluid: what 1 Pa of its own pushes it by, by bodies that may move, m²
  PairRows presses;       ///< of a body's particle: what 1 Pa of a fluid particle pushes it by, in its units
  float4* own = nullptr;  ///< what 1 Pa of its own pushes it by, in its units, by fluid, walls and bodies;
                          ///< w: the unit, m²
  float2* scale = nullptr;     ///< inverse of the system's diagonal (from launch_pressure_rows(): the sum of
                               ///< the square of pushes by fluid over each neighbour's mass, m⁴/kg); the unit
  float* flow = nullptr;       ///< Q v − V⁰ e/dt, m³/s: wanted 0 where it presses, not below 0 elsewhere
  float* pressure = nullptr;   ///< Pa
  float* product = nullptr;    ///< the system times the direction
  float* clipped = nullptr;    ///< Pa, what was cut off below 0 and `flow` does not know of
  float* direction = nullptr;  ///< Pa
  float2* pressing = nullptr;  ///< preconditioned residual and the direction before, of those that press,
                               ///< times their units
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

/// cuda_rows.cu, of the lists of the density pass: the rows of all, and to fluid.force what the last step's
/// pressures push each by.
void launch_pressure_rows(const StepConstants& constants, const ParticleKind* kinds, const SortedFluid& fluid,
                          const SortedSurface& fixed, const SortedSurface& moving, const PressureView& view,
                          cudaStream_t stream);

/// How many blocks of the solve for so many particles can be on the GPU at a time, > 0, or an error.
cudaError_t most_pressure_blocks(std::uint32_t fluid, int& blocks);
/// The solve: adds to fluid.force what the pressures found over `dt` s differ by from the last ones, replaces
/// those, fills view.wrenches and view.probes. `density_time`: s (step_limits.h). `blocks`: at most
/// most_pressure_blocks(); the order of sums depends on it.
cudaError_t launch_pressure_solve(const StepConstants& constants, const ParticleKind* kinds, float dt,
                                  float density_time, const SortedFluid& fluid, const SortedSurface& moving,
                                  const LocalSurface& local, const PressureView& view, int blocks,
                                  cudaStream_t stream);

}  // namespace slosh::cuda
