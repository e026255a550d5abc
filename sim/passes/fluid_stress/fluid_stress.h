// What thick fluid passes on far from walls that hold: each particle the stress of its own neighbourhood's
// flow, in place of Eq 9 between pairs, which passes on what the packing lets it
// (tests/notebook/2026-11-27-particle-stress.md).
//
// G is the least-squares gradient of the velocity by fluid neighbours alone, τ = μ (G + Gᵀ), g = d (−W'/r)
// and
//
//     f_p = Σ (T_p + T_i) g,    T = −V τ M⁻¹,    M = Σ d ⊗ g,    G = Σ (v_p − v_i) ⊗ g M⁻¹
//
// T is the adjoint of G: what is lost is V τ : G, so that no flow gains by it. Pairs push with equal and
// opposite forces, and since T M = −V τ is symmetric a particle's pushes turn nothing together (T itself is
// not symmetric).
//
// Beside walls that hold nobody sees the first layer's own velocity, and Eq 9 stays: each particle's half of
// it is as much as the particle lacks of a stress of its own. What is no part of the flow is braked as
// jostling is.
#pragma once

#include "sim/math/symmetric.h"
#include "sim/passes/density/gradient_correction.h"
#include "sim/viscosity/neighbour_flow.h"

namespace slosh {

/// Of the fluid's viscosity, for what a velocity differs by from the flow around it. Half of it drives a
/// vortex by 4 to 6 % at 3 mm and finer, twice is unstable.
inline constexpr float kResidualDamping = 0.25f;
/// Of Eq 9 between fluid beside walls: a ball that goes along a tube meets 1 to 2 % more with it.
inline constexpr float kNearNoSlipWalls = 1.03f;
/// Where walls that hold add up to this share of the rest lattice's Σ x² (−W'/r), and nearer, a particle
/// passes on no stress of its own: up to nearly two spacings off.
inline constexpr float kNoSlipReach = 0.02f;

/// Sums over the fluid neighbours at x_i = x_p − d, without the kernels' constants.
struct StressSums {
  FlowAround flow;
  float number;          ///< Σ W
  Vector3<float> apart;  ///< Σ W (v_p − v_i), m/s
};

struct FluidStress {
  Matrix3<float> push;  ///< T, without the kernel's constant: T d (−W'/r) of the same kernel is N
  float left;           ///< Pa·s, its side of Eq 9 with fluid
  Vector3<float> rest;  ///< Pa·m, what it drags by besides, as on jostling
};

/// The share of a stress of its own that a particle passes on, 0 to 1. `no_slip`: Σ d² (−W'/r) V/V⁰ over
/// walls that hold.
SLOSH_HD inline float share_of_stress(float no_slip, float rest_moment) {
  return RealOps<float>::positive_part(1.0f - no_slip / (kNoSlipReach * rest_moment));
}

/// `moment`: M by fluid alone; `by_walls`: share_of_stress(). `rest_moment`: Σ x² (−W'/r) over the rest
/// lattice. `volume`: m³; `viscosity`: the fluid's own, Pa·s. Where M is too flat to be turned round (a
/// layer, a thread, drops) Eq 9 takes over by as much; M_u is taken for M and both G and T lose K = M_u⁻¹ M
/// besides, so that each is the other's adjoint and T M symmetric still.
SLOSH_HD inline FluidStress fluid_stress(const StressSums& sums, const InverseMoment& moment, float by_walls,
                                         float rest_moment, float volume, float viscosity) {
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
  const float brake = kResidualDamping * share * viscosity / sums.number;
  found.rest = {brake * (sums.apart.x - flow.x), brake * (sums.apart.y - flow.y),
                brake * (sums.apart.z - flow.z)};
  return found;
}

}  // namespace slosh
