// Viscous stress of thick fluid away from no-slip walls: each particle has the stress of its neighbourhood's
// flow, in place of Eq 9 between pairs, whose effective viscosity depends on the packing
// (tests/notebook/2026-11-27-particle-stress.md).
//
// G is the least-squares gradient of the velocity by fluid neighbours alone, τ = μ (G + Gᵀ), g = d (−W'/r)
// and
//
//     f_p = Σ (T_p + T_i) g,    T = −V τ M⁻¹,    M = Σ d ⊗ g,    G = Σ (v_p − v_i) ⊗ g M⁻¹
//
// T is the adjoint of G: the dissipated power is V τ : G, so that no flow gains energy. Pair forces are equal
// and opposite, and since T M = −V τ is symmetric a particle's forces exert no net torque (T itself is not
// symmetric).
//
// Beside no-slip walls the velocity gradient by fluid neighbours misses the wall, and Eq 9 stays: each
// particle's half of it is weighted by what its own stress lacks. Velocity fluctuations are damped besides.
#pragma once

#include "sim/math/symmetric.h"
#include "sim/passes/density/gradient_correction.h"
#include "sim/viscosity/neighbour_flow.h"

namespace slosh {

/// Of the fluid's viscosity, for the velocity's fluctuation about the flow around it. Half of it drives a
/// vortex by 4 to 6 % at 3 mm and finer, twice is unstable.
inline constexpr float kResidualDamping = 0.25f;
/// Of Eq 9 between fluid beside walls: 1 to 2 % more drag on a ball in a tube.
inline constexpr float kNearNoSlipWalls = 1.03f;
/// From this share of no-slip walls in the rest lattice's Σ x² (−W'/r) on a particle has no stress of its
/// own: up to nearly two spacings off.
inline constexpr float kNoSlipReach = 0.02f;

/// Sums over the fluid neighbours at x_i = x_p − d, without the kernels' constants.
struct StressSums {
  FlowAround<float> flow;
  float number;          ///< Σ W
  Vector3<float> apart;  ///< Σ W (v_p − v_i), m/s
};

struct FluidStress {
  Matrix3<float> push;  ///< T, without the kernel's constant: T d (−W'/r) of the same kernel is N
  float left;           ///< Pa·s, its side of Eq 9 with fluid
  Vector3<float> rest;  ///< Pa·m, damping of its fluctuation, as by artificial viscosity
};

/// The share of a stress of its own that a particle passes on, 0 to 1. `no_slip`: Σ d² (−W'/r) V/V⁰ over
/// no-slip walls.
SLOSH_HD inline float share_of_stress(float no_slip, float rest_moment) {
  return RealOps<float>::positive_part(1.0f - no_slip / (kNoSlipReach * rest_moment));
}

/// `moment`: M by fluid alone; `by_walls`: share_of_stress(). `rest_moment`: Σ x² (−W'/r) over the rest
/// lattice. `volume`: m³; `viscosity`: the fluid's own, Pa·s. Where M is near singular (a layer, a thread,
/// drops) Eq 9 takes over by as much; M_u is taken for M and G and T get a factor K = M_u⁻¹ M, so that they
/// stay adjoint and T M symmetric.
SLOSH_HD inline FluidStress fluid_stress(const StressSums& sums, const InverseMoment<float>& moment,
                                         float by_walls, float rest_moment, float volume, float viscosity) {
  const float share = by_walls * moment.kept;
  const bool flat = moment.kept < 1.0f;
  FluidStress found{{}, kNearNoSlipWalls * (1.0f - share) * viscosity, {}};
  if (share <= 0.0f) return found;
  const Symmetric<float> turned = scaled_and_shifted(moment.inverse, 1.0f / rest_moment, 0.0f);
  const auto kept = [&](const Matrix3<float>& t) {  // K t; M_u and M commute
    return flat ? times(turned, times(scaled_and_shifted(moment.whole, rest_moment, 0.0f), t)) : t;
  };
  const Matrix3<float> g = kept(times(sums.flow.carried, turned));
  const Matrix3<float> stress{{2.0f * g.x.x, g.x.y + g.y.x, g.x.z + g.z.x},
                              {g.x.y + g.y.x, 2.0f * g.y.y, g.y.z + g.z.y},
                              {g.x.z + g.z.x, g.y.z + g.z.y, 2.0f * g.z.z}};
  const float scale = -share * volume * viscosity;
  found.push = times(kept(stress), scaled_and_shifted(turned, scale, 0.0f));
  const Vector3<float> flow = times(g, sums.flow.offset.x, sums.flow.offset.y, sums.flow.offset.z);
  // Of one far neighbour rounding may leave no number at all, and a moment that is not quite flat.
  const float brake = sums.number > 0.0f ? kResidualDamping * share * viscosity / sums.number : 0.0f;
  found.rest = {brake * (sums.apart.x - flow.x), brake * (sums.apart.y - flow.y),
                brake * (sums.apart.z - flow.z)};
  return found;
}

}  // namespace slosh
