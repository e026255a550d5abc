// What takes the noise of particles out and leaves the flow: drag on what a velocity differs from its
// neighbours' mean, carried to where the particle is along their flow (neighbour_flow.h).
//
// The corrected pressure keeps no energy: particles that jostle gain some. Plain viscosity that would hold it
// would also be a hundred times water's. Against the mean of the neighbours, a flow that is smooth over a
// support radius is not seen (the drag goes with the fourth power of the wave number, not the second), and
// the artificial is damped as by some Pa·s.
#pragma once

#include <cmath>

#include "sim/passes/density/gradient_correction.h"
#include "sim/plan.h"

namespace slosh {

/// The viscosity that artificial feels: this · density · support radius · speed of sound.
inline constexpr double kArtificialViscosity = 0.01;

/// The share of it that is enough where pressures are solved for: a projection feeds artificial less.
inline constexpr double kProjectedShare = 1.0 / 3.0;

/// Pa·s, what a fluid without viscosity needs whose pressures are not solved for.
inline double weakly_compressible_artificial_viscosity(const Plan& plan, double density) {
  return kArtificialViscosity * density * plan.support_radius * std::sqrt(plan.stiffness);
}
/// Pa·s, what a fluid without viscosity needs.
inline double artificial_viscosity(const Plan& plan, double density) {
  const double share = plan.model == ParticleModel::kIncompressible ? kProjectedShare : 1.0;
  return share * weakly_compressible_artificial_viscosity(plan, density);
}

/// Fluid of less than this share of that is thin: its own drag is next to nothing beside the drag on
/// artificial.
inline constexpr double kThin = 0.25;

/// Up to this share of it a fluid gets all of the drag on artificial beside its own, and from the second on
/// none. A step's length counts all of it at any viscosity (viscosity/stability.cpp).
inline constexpr double kAllOfIt = 0.75;
inline constexpr double kNoneOfIt = 1.25;

/// What is left to damp in a fluid of `viscosity`, Pa·s, of the `noise` that one without needs: nothing where
/// its own drag is stronger. The two shares were chosen while, at walls and surfaces, the flow felt it
/// (neighbour_flow.h): torque between cylinders of 1 Pa·s, three spacings apart, had +13 % with all of 0.66
/// Pa·s.
SLOSH_HD inline float artificial_viscosity_left(float noise, float viscosity) {
  constexpr auto kNone = static_cast<float>(kNoneOfIt);
  constexpr auto kWay = static_cast<float>(kNoneOfIt - kAllOfIt);
  const float left = (kNone * noise - viscosity) / kWay;
  return left > noise ? noise : RealOps<float>::positive_part(left);
}

/// In an impact it is more: what differs from its neighbours' mean by more than this share of the speed of
/// sound is damped the more the faster it is, by this factor more for each speed of sound beyond it, as Von
/// Neumann and Richtmyer's viscosity (1950) grows with the speed at which fluid meets. Calm fluid is slower
/// than that and bitwise identical. Without it water that fell on a shallow layer sprang back from
/// it particle by particle (tests/notebook/2026-11-23-impacts-and-boundary-share.md). Not where
/// pressures are solved for: little springs back there.
inline constexpr double kImpactSpeed = 0.05;
inline constexpr double kImpactGrowth = 50.0;

/// s/m, by which it grows with the speed; 0: never.
inline double impact_growth(const Plan& plan) {
  return plan.model == ParticleModel::kIncompressible ? 0.0 : kImpactGrowth / std::sqrt(plan.stiffness);
}

/// The viscosity that artificial feels at `speed` m/s, Pa·s, of a fluid whose artificial feels `artificial`
/// while it is calm: `noise` where it is thin, nothing where it is thick, which meets as hard. `growth`: s/m;
/// `most`: what a step holds of all that drags a particle explicitly, of which the fluid's own `viscosity` is
/// a part.
SLOSH_HD inline float artificial_viscosity_in_impact(float artificial, float noise, float growth, float speed,
                                                     float viscosity, float most) {
  constexpr auto kQuietPart = static_cast<float>(kImpactGrowth * kImpactSpeed);
  const float more = RealOps<float>::positive_part(growth * speed - kQuietPart);
  const float grown = artificial * (1.0f + more) + (noise - artificial) * more;
  const float left = most - viscosity;
  return grown <= left ? grown : left > artificial ? left : artificial;
}

/// Adds factor · (v less the mean velocity of its fluid neighbours) to u. `own`: W(0) as the neighbourhood
/// counted the particle itself. Nothing for one that is alone.
SLOSH_HD inline void add_fluctuation(const Neighborhood<float>& n, float own, float factor,
                                     const float (&v)[3], float (&u)[3]) {
  const float others = n.fluid_number - own;
  if (others < 1e-3f * own) return;
  const float f = factor / others;
  u[0] += f * (n.fluid_number * v[0] - n.vx);
  u[1] += f * (n.fluid_number * v[1] - n.vy);
  u[2] += f * (n.fluid_number * v[2] - n.vz);
}

/// Takes out of that what the neighbours' flow makes a particle differ from their mean by (neighbour_flow.h).
SLOSH_HD inline void follow_fluctuation(const Neighborhood<float>& n, float own, float factor,
                                        float (&u)[3]) {
  const float others = n.fluid_number - own;
  if (others < 1e-3f * own) return;
  const float f = factor / others;
  u[0] -= f * n.fx;
  u[1] -= f * n.fy;
  u[2] -= f * n.fz;
}

}  // namespace slosh
