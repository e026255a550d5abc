// What takes the noise of particles out and leaves the flow: drag on what a velocity differs from its
// neighbours' mean.
//
// The corrected pressure keeps no energy: particles that jostle gain some. Plain viscosity that would hold it
// would also be a hundred times water's. Against the mean of the neighbours, a flow that is smooth over a
// support radius is not seen (the drag goes with the fourth power of the wave number, not the second), and
// the jostling is damped as by some Pa·s.
#pragma once

#include <cmath>

#include "sim/plan.h"
#include "sim/pressure/gradient_correction.h"

namespace slosh {

/// The viscosity that jostling feels: this · density · support radius · speed of sound.
inline constexpr double kNoiseViscosity = 0.01;

/// Pa·s.
inline double noise_viscosity(const Plan& plan, double density) {
  return kNoiseViscosity * density * plan.support_radius * std::sqrt(plan.stiffness);
}

/// Adds factor · (v less the mean velocity of its fluid neighbours) to u. `own`: W(0) as the neighbourhood
/// counted the particle itself. Nothing for one that is alone.
SLOSH_HD inline void add_noise(const Neighborhood<float>& n, float own, float factor, const float (&v)[3],
                               float (&u)[3]) {
  const float others = n.fluid_number - own;
  if (others < 1e-3f * own) return;
  const float f = factor / others;
  u[0] += f * (n.fluid_number * v[0] - n.vx);
  u[1] += f * (n.fluid_number * v[1] - n.vy);
  u[2] += f * (n.fluid_number * v[2] - n.vz);
}

}  // namespace slosh
