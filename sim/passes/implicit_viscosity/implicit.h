// Implicit viscosity: the viscous force by the velocities that a sub-step ends with, one linear system over
// the fluid and the free bodies.
//
// Explicit viscosity needs a step of some density · spacing² / viscosity: 0.2 ms for honey at 1 cm. Here the
// end velocities u solve
//
//     M u + dt D u = p,    p: the momentum that everything but viscosity gives
//
// where M holds the particles' masses and, for each free body, its inertia with what its couplings take
// (solve_body), and D is Eq 9 between all of them. Both are symmetric and positive, so conjugate gradients
// solve it without assembling D: one loop over the neighbours an iteration (Weiler 2018, with bodies inside).
//
// The residual of the last iteration is given to each particle by its own mass: momentum is then conserved to
// rounding, however early the iterations end.
#pragma once

#include <cstdint>

#include "sim/math/dense.h"
#include "sim/math/pose.h"
#include "sim/math/symmetric.h"

namespace slosh {

/// A body in the system. One that does not move exerts viscous forces by `twist`, as it is.
struct ViscousBody {
  bool moves = false;
  Twist twist;         ///< about the centre of mass, as the sub-step begins
  Matrix6 inertia{};   ///< what each unit of its twist costs: its mass, and couplings over the sub-step
  Vector6 momentum{};  ///< inertia · the twist that it would end with without viscosity
};

/// A sub-step is at most so many times as long as the explicit one: beyond, single precision has too little
/// left.
inline constexpr double kMaxImplicit = 2000.0;

/// How one solve went.
struct ViscousReport {
  int iterations = 0;
  bool converged = true;
};

/// Iterations end when the residual would change the velocities by less than this share of what viscosity
/// changed.
inline constexpr double kViscousTolerance = 0.01;
/// Or by less than this share of gravity's change in a sub-step: the force on a hand then varies from step to
/// step by a fiftieth more than after an exact solve.
inline constexpr double kViscousFloor = 3e-3;
/// And here whatever is left (kStatusViscosityCut).
inline constexpr int kMaxViscosityIterations = 100;

/// The inverse of mass · 1 + dt · rate: what a residual of a particle means as a velocity, were its
/// neighbours to stand still. `rate`: N·s/m.
SLOSH_HD inline Symmetric<float> inverse_block(float mass, float dt, const Symmetric<float>& rate) {
  return inverse(scaled_and_shifted(rate, dt, mass));
}

}  // namespace slosh
