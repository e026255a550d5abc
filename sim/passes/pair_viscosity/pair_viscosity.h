// Eq 6 and 9 between two particles.
#pragma once

#include "scenes/scene.h"
#include "sim/particle_view.h"

namespace slosh {

/// kPair: both sides have their own viscosity (Eq 9). kOne: all share p's (Eq 6). kNone: no viscous force.
enum class Viscosity { kNone, kOne, kPair };

/// Eq 9 acts along the velocity difference: such pairs exert a torque on each other, and a glass of fluid
/// that turns like a rigid body still brakes its glass. The corrected models keep only the part along d
/// (Monaghan 2005), which conserves angular momentum and is nothing in rigid rotation; five times that has
/// the same viscosity in 3-D (the mean of d̂ d̂ᵀ against a linear velocity field is a fifth of Eq 9's).
enum class DragRule { kAlongVelocity, kCentral };
inline constexpr float kCentralDrag = 5.0f;

/// Both sides of Eq 9's mean (own + of_fluid · the fluid's)/2 for a wall's particle. Below 0
/// (kFluidsViscosity) it has the fluid's viscosity, whichever fluid it is; at kFreeSlip there is no viscous
/// force.
struct WallViscosity {
  float own, of_fluid;
};
SLOSH_HD inline WallViscosity wall_viscosity(float viscosity) {
  if (viscosity == static_cast<float>(kFreeSlip)) return {0.0f, 0.0f};
  return viscosity < 0.0f ? WallViscosity{0.0f, 2.0f} : WallViscosity{viscosity, 1.0f};
}

/// A wall's side of Eq 9 as a fluid's particle of `fluid` Pa·s sees it: the same, so that both sum to nothing
/// where the fluid slides freely.
SLOSH_HD inline float side_of_wall(float own, float fluid) {
  return own >= 0.0f ? own : own == static_cast<float>(kFreeSlip) ? -fluid : fluid;
}

/// Eq 9's factor of the velocity difference, without the kernel's constant. What p alone decides comes first,
/// so that it leaves the loop where all share one viscosity. `shape`: DragShape's of the two.
template <class Real>
SLOSH_HD Real drag_coefficient(const ParticleView<Real>& p, const ParticleView<Real>& i, Real shape) {
  return (Real(0.5f) * (p.viscosity + i.viscosity) * p.volume) * (i.volume * shape);
}

}  // namespace slosh
