// From a particle's neighbourhood to its pressure tensor and damping: the corrected model's end of the
// density pass.
#pragma once

#include <cmath>

#include "sim/passes/density/equation_of_state.h"
#include "sim/passes/density/gradient_correction.h"
#include "sim/passes/pressure_force/pair_pressure.h"
#include "sim/viscosity/artificial_viscosity.h"

namespace slosh {

/// What the particles of a run share, for the corrected model.
struct CorrectionConstants {
  float rest_number = 0.0f;           ///< Σ of the kernel's shape over the rest lattice
  float rest_moment = 0.0f;           ///< Σ x² (−W'/r) over it, without the kernel's constant
  float push_scale = 0.0f;            ///< 1/(V⁰ · rest_moment · the kernel's constant), near 1.3
  float own_number = 0.0f;            ///< the kernel's shape at no distance
  float artificial_viscosity = 0.0f;  ///< Pa·s (viscosity/artificial_viscosity.h)
  float rest_volume = 0.0f;           ///< m³
  float stiffness = 0.0f;             ///< m²/s²
  float tension = 0.0f;
  float impact_growth = 0.0f;            ///< s/m (viscosity/artificial_viscosity.h)
  float most_drag = 0.0f;                ///< Pa·s (viscosity/stability.h, max_explicit_viscosity)
  float wall_layer = 1.0f / kWallShare;  ///< share of a wall's particle in the moment (wall_layers.h)
};

template <class Real = float>
struct CorrectedState {
  Real pressure;         ///< V² P, N·m⁴
  Real volume;           ///< m³
  Real compression;      ///< ρ/ρ⁰ − 1
  Symmetric<Real> push;  ///< N·m⁴
  Real u[3];             ///< Pa·m
};

/// From which share of the settled moment on no neighbour is missing. Settled particles have 0.95 to 1.1 of
/// it, 0.9 where they lie unevenly or beside a wall, which is one layer in it; particles taken for a surface
/// press in part by an energy's gradient, and yield. A fluid without artificial viscosity counts nine
/// tenths as all; one with it needs all (tests/notebook/2026-11-25-slow-flow-yields.md). `viscosity`: Pa·s.
inline constexpr float kPassedOver = 0.1f;
template <class Real>
SLOSH_HD Real whole_from(const CorrectionConstants& c, Real viscosity) {
  const Real artificial =
      artificial_viscosity_left(c.artificial_viscosity, viscosity) / c.artificial_viscosity;
  return 1.0f - kPassedOver * (1.0f - artificial);
}

/// What V² P is multiplied by. `volume`: m³; `compression`: ρ/ρ⁰ − 1; `viscosity`: the fluid's own, Pa·s.
template <class Real>
SLOSH_HD Symmetric<Real> directions_of(const Neighborhood<Real>& n, const CorrectionConstants& c, Real volume,
                                       Real compression, Real viscosity) {
  const Symmetric<Real> moment = scaled_and_shifted(n.moment, Real(1.0f / c.rest_moment), Real(0.0f));
  // The energy's gradient has V², a virial of V P has V V⁰.
  const Real virial = c.push_scale * (c.rest_volume / volume);
  return pressure_directions(moment, corrected_share(compression), virial, whole_from(c, viscosity));
}

/// Viscosity times velocity fluctuation, Pa·m. What an impact adds goes by the mean: fluid that meets a wall
/// flows linearly, too.
template <class Real>
SLOSH_HD void set_drag(const Neighborhood<Real>& n, const CorrectionConstants& c, Real viscosity, Real in_u,
                       const Real (&v)[3], Real (&u)[3]) {
  for (int k = 0; k < 3; ++k) u[k] = in_u * v[k];
  const Real calm = artificial_viscosity_left(c.artificial_viscosity, viscosity);
  Real artificial = calm;
  if (c.impact_growth > 0.0f) {
    Real d[3] = {Real(0.0f), Real(0.0f), Real(0.0f)};
    add_fluctuation(n, c.own_number, Real(1.0f), v, d);
    const Real speed = RealOps<Real>::root(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    artificial = artificial_viscosity_in_impact(calm, c.artificial_viscosity, c.impact_growth, speed,
                                                viscosity, c.most_drag);
  }
  add_fluctuation(n, c.own_number, artificial, v, u);
  follow_fluctuation(n, c.own_number, calm, u);
}

/// `viscosity`: the fluid's own, Pa·s. `in_u`: the same where u is to carry it (all fluids share it and
/// viscosity is explicit, Eq 6), else 0. `v`: m/s.
template <class Real>
SLOSH_HD CorrectedState<Real> corrected_state(const Neighborhood<Real>& n, const CorrectionConstants& c,
                                              Real pressing_density, Real viscosity, Real in_u,
                                              Real last_volume, const Real (&v)[3]) {
  const PressureState<Real> eos = pressure_state(n.number, c.rest_number, c.rest_volume, pressing_density,
                                                 c.stiffness, c.tension, last_volume, true);
  CorrectedState<Real> state;
  state.volume = eos.volume;
  state.compression = eos.compression;
  state.pressure = eos.pressure;
  state.push = scaled_and_shifted(directions_of(n, c, eos.volume, eos.compression, viscosity), eos.pressure,
                                  Real(0.0f));
  set_drag(n, c, viscosity, in_u, v, state.u);
  return state;
}

}  // namespace slosh
