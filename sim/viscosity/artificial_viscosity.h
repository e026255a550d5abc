// Artificial viscosity on velocity fluctuations: it damps the difference between a particle's velocity and
// its neighbours' mean, extrapolated to the particle along their flow (neighbour_flow.h).
//
// Gradient correction does not conserve energy: velocity fluctuations gain some. Plain viscosity that damps
// them would be a hundred times water's. The difference to the neighbours' mean leaves a flow that is smooth
// over a support radius alone (damping goes with the fourth power of the wave number, not the second), and
// fluctuations are damped as by some Pa·s.
#pragma once

#include <cmath>

#include "sim/passes/density/gradient_correction.h"
#include "sim/plan.h"

namespace slosh {

/// The artificial viscosity: this · density · support radius · speed of sound.
inline constexpr double kArtificialViscosity = 0.01;

/// The share of it that is enough with pressure projection, which excites fluctuations less.
inline constexpr double kProjectedShare = 1.0 / 3.0;

/// Pa·s, what an inviscid fluid needs without pressure projection.
inline double weakly_compressible_artificial_viscosity(const Plan& plan, double density) {
  return kArtificialViscosity * density * plan.support_radius * std::sqrt(plan.stiffness);
}
/// Pa·s, what an inviscid fluid needs.
inline double artificial_viscosity(const Plan& plan, double density) {
  const double share = plan.model == ParticleModel::kIncompressible ? kProjectedShare : 1.0;
  return share * weakly_compressible_artificial_viscosity(plan, density);
}

/// Fluid of less than this share of that is thin: its own viscosity hardly counts beside the artificial one.
inline constexpr double kThin = 0.25;

/// Up to this share of it a fluid gets all of the artificial viscosity beside its own, and from the second on
/// none. A step's length counts all of it at any viscosity (viscosity/stability.cpp).
inline constexpr double kAllOfIt = 0.75;
inline constexpr double kNoneOfIt = 1.25;

/// The artificial viscosity of a fluid of `viscosity`, Pa·s, of the `noise` that an inviscid one needs: none
/// where its own is larger. The two shares were chosen before neighbour_flow.h, for the torque between
/// cylinders of 1 Pa·s.
template <class Real>
SLOSH_HD Real artificial_viscosity_left(float noise, Real viscosity) {
  constexpr auto kNone = static_cast<float>(kNoneOfIt);
  constexpr auto kWay = static_cast<float>(kNoneOfIt - kAllOfIt);
  const Real left = (kNone * noise - viscosity) / kWay;
  return RealOps<Real>::where_less(Real(noise), left, Real(noise), RealOps<Real>::positive_part(left));
}

/// In an impact it is more: fluctuations of more than this share of the speed of sound are damped by this
/// factor more for each speed of sound beyond it, as Von Neumann and Richtmyer's viscosity (1950) grows with
/// the speed at which fluid meets. Slower fluctuations stay bitwise identical. Without it water rebounds from
/// a shallow layer (tests/notebook/2026-11-23-impacts-and-boundary-share.md). Not with pressure projection:
/// little rebounds there.
inline constexpr double kImpactSpeed = 0.05;
inline constexpr double kImpactGrowth = 50.0;

/// s/m, by which it grows with the speed; 0: never.
inline double impact_growth(const Plan& plan) {
  return plan.model == ParticleModel::kIncompressible ? 0.0 : kImpactGrowth / std::sqrt(plan.stiffness);
}

/// The artificial viscosity, Pa·s, of a fluctuation of `speed` m/s, in a fluid whose own is `artificial`
/// below the impact speed: `noise` in thin fluid, nothing in thick. `growth`: s/m; `most`: the explicit
/// viscosity that a step bears, of which the fluid's own `viscosity` is a part.
template <class Real>
SLOSH_HD Real artificial_viscosity_in_impact(Real artificial, float noise, float growth, Real speed,
                                             Real viscosity, float most) {
  constexpr auto kQuietPart = static_cast<float>(kImpactGrowth * kImpactSpeed);
  const Real more = RealOps<Real>::positive_part(growth * speed - kQuietPart);
  const Real grown = artificial * (1.0f + more) + (noise - artificial) * more;
  const Real left = most - viscosity;
  const Real most_of_it = RealOps<Real>::where_less(artificial, left, left, artificial);
  return RealOps<Real>::where_less(left, grown, most_of_it, grown);
}

/// Adds factor · (v less the mean velocity of its fluid neighbours) to u. `own`: W(0) as the neighbourhood
/// counted the particle itself. Nothing for one that is alone.
template <class Real>
SLOSH_HD void add_fluctuation(const Neighborhood<Real>& n, float own, Real factor, const Real (&v)[3],
                              Real (&u)[3]) {
  const Real others = n.fluid_number - own;
  const Real f = RealOps<Real>::where_less(others, Real(1e-3f * own), Real(0.0f), factor / others);
  u[0] += f * (n.fluid_number * v[0] - n.vx);
  u[1] += f * (n.fluid_number * v[1] - n.vy);
  u[2] += f * (n.fluid_number * v[2] - n.vz);
}

/// Subtracts from that the part that the neighbours' flow explains (neighbour_flow.h).
template <class Real>
SLOSH_HD void follow_fluctuation(const Neighborhood<Real>& n, float own, Real factor, Real (&u)[3]) {
  const Real others = n.fluid_number - own;
  const Real f = RealOps<Real>::where_less(others, Real(1e-3f * own), Real(0.0f), factor / others);
  u[0] -= f * n.fx;
  u[1] -= f * n.fy;
  u[2] -= f * n.fz;
}

}  // namespace slosh
