// From a particle's neighbourhood to the coefficients of the pressure projection: the incompressible model's
// end of the density pass.
//
// Pairs press by the corrected tensors, T = P K, with a P that keeps particles from being compressed. Such
// forces are Qᵀ P; Q v is then V⁰ times the corrected divergence of v, walls with their own velocities, and
//
//     Q (v* + dt M⁻¹ Qᵀ P) ≥ V⁰ e / dt,    P ≥ 0,    one of the two equal
//
// is symmetric and a projection: it gives no energy. It is the aim of DFSPH (Bender & Koschier 2015, 2017) in
// one solve, with inequalities in place of a list of surface particles.
#pragma once

#include "sim/passes/density/corrected_state.h"

namespace slosh {

/// The share of the compression there is that a step undoes. All of it at once is thrown back as speed.
inline constexpr float kUndoneShare = 0.2f;

template <class Real = float>
struct SolvedState {
  Real volume;       ///< m³
  Real compression;  ///< ρ/ρ⁰ − 1
  Real expansion;    ///< e: by how much the step is to expand it; below 0, how much it may be pushed together
                     ///< first
  Symmetric<Real> push;  ///< K, m⁶
  Real u[3];             ///< Pa·m
};

/// As corrected_state().
template <class Real>
SLOSH_HD SolvedState<Real> solved_state(const Neighborhood<Real>& n, const CorrectionConstants& c,
                                        Real viscosity, Real in_u, const Real (&v)[3]) {
  SolvedState<Real> state;
  state.compression = n.number / c.rest_number - 1.0f;
  const Real dense = RealOps<Real>::positive_part(state.compression);
  state.volume = c.rest_volume / (1.0f + dense);
  state.expansion = RealOps<Real>::where_less(Real(0.0f), state.compression, kUndoneShare * state.compression,
                                              state.compression);
  state.push = scaled_and_shifted(directions_of(n, c, state.volume, state.compression, viscosity),
                                  state.volume * state.volume, Real(0.0f));
  set_drag(n, c, viscosity, in_u, v, state.u);
  return state;
}

}  // namespace slosh
