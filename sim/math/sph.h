// The paper's particle physics as pure functions: Eq 2 and 5–9. A CUDA kernel calls them with float, the CPU
// with a SIMD batch of neighbours.
#pragma once

#include "sim/math/kernels.h"

namespace slosh {

/// Eq 7 with a share of the negative pressures. `compression` is ρ/ρ⁰ − 1; the result is ρ/ρ⁰ − 1 as Eq 5–7
/// are to see it: positive values pass, negative ones are scaled by `tension` (1 = the paper's Eq 7 as it
/// stands, 0 = a deficit of neighbours at a free surface is taken for what it is, not for low density).
template <class Real>
SLOSH_HD Real effective_compression(Real compression, Real tension) {
  const Real stretched = RealOps<Real>::positive_part(-compression);
  return RealOps<Real>::positive_part(compression) - tension * stretched;
}

/// A particle as the force pass sees it. SI. What `pressure` and `volume` hold depends on the rule below.
template <class Real>
struct ParticleView {
  Real x, y, z;     ///< m
  Real vx, vy, vz;  ///< m/s
  Real pressure;    ///< Pa, or pressure energy V²P (kConsistent)
  Real volume;      ///< m³
  Real viscosity;   ///< Pa·s (its side of Eq 9)
};

/// How two particles press on each other. The force on p is −(coefficient) · ∇W:
enum class PairRule {
  kPaper,       ///< Eq 5: V_p V_i (P_p + P_i)/2. `pressure` is P.
  kConsistent,  ///< V_p² P_p + V_i² P_i, the gradient of an energy of the densities. `pressure` is V²P.
  kWall,  ///< fluid against a wall particle that counts in its density: V² P of the fluid, times the wall's
          ///< share (how many lattice particles it stands for), which is the wall's `pressure`.
};

/// Eq 9 drags along the velocity difference: such pairs exert a torque on each other, and a glass of fluid that turns
/// like a rigid body still brakes its glass. The consistent model keeps only the part along d (Monaghan 2005), which
/// conserves angular momentum and is nothing in rigid rotation; five times that has the same viscosity in 3-D
/// (the mean of d̂ d̂ᵀ against a linear velocity field is a fifth of Eq 9's).
inline constexpr float kCentralDrag = 5.0f;

template <class Real>
struct ForceSum {
  Real x, y, z;
};

/// Adds one neighbour's (or one batch of neighbours') part of the pressure force and, with `with_viscosity`,
/// of Eq 9 to `sum`. The force on p is `spiky` times the sum. The pair (p, i) and the pair (i, p) give
/// opposite forces to rounding: every factor is symmetric but d and dv. Coincident particles (and p itself)
/// add nothing. `weight` is 1 where the neighbour counts, else 0.
template <PairRule rule, bool with_viscosity, class Real>
SLOSH_HD void add_pair_force(const ParticleView<Real>& p, const ParticleView<Real>& i, Real h, Real weight,
                             ForceSum<Real>& sum) {
  const Real dx = p.x - i.x;
  const Real dy = p.y - i.y;
  const Real dz = p.z - i.z;
  const Real r_squared = dx * dx + dy * dy + dz * dz;
  // The floor keeps 1/r finite at r = 0; it is 10⁻⁶ h, where d/r is already nothing but rounding.
  const Real floored = r_squared + h * h * Real(1e-12f);
  const Real inverse_r = RealOps<Real>::inverse_sqrt(floored);
  const Real reach = kernel_reach(floored * inverse_r, h) * weight;
  Real coefficient;
  if constexpr (rule == PairRule::kPaper) {
    coefficient = Real(0.5f) * (p.volume * i.volume) * (p.pressure + i.pressure);
  } else if constexpr (rule == PairRule::kConsistent) {
    coefficient = p.pressure + i.pressure;
  } else {
    coefficient = p.pressure * i.pressure;
  }
  Real along = coefficient * (reach * reach * inverse_r);  // of d
  if constexpr (with_viscosity) {
    const Real dvx = i.vx - p.vx;
    const Real dvy = i.vy - p.vy;
    const Real dvz = i.vz - p.vz;
    // What p alone decides comes first, so that it leaves the loop where all share one viscosity.
    const Real drag = (Real(0.5f) * (p.viscosity + i.viscosity) * p.volume) * (i.volume * reach);
    if constexpr (rule == PairRule::kPaper) {
      sum.x += drag * dvx;
      sum.y += drag * dvy;
      sum.z += drag * dvz;
    } else {
      along += (Real(kCentralDrag) * drag) * ((dvx * dx + dvy * dy + dvz * dz) * (inverse_r * inverse_r));
    }
  }
  sum.x += along * dx;
  sum.y += along * dy;
  sum.z += along * dz;
}

}  // namespace slosh
