// Eq 7: pressure from density.
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

/// What a particle has after the density pass.
template <class Real = float>
struct PressureState {
  Real pressure;     ///< Pa; kCorrected: V²P, N·m⁴
  Real volume;       ///< m³
  Real compression;  ///< ρ/ρ⁰ − 1
};

/// Bulk damping of the corrected model: this times the compression gained since the last step is felt on top
/// of the compression itself. It takes the ring out of sound and the bounce out of a drop that meets a wall,
/// which without it comes back with up to twice its speed (a contact lasts about three steps); shear does not
/// feel it. Explicit, so with ω the stiffest mode (1 + 2 · this) ω²Δt² must stay below 4.
inline constexpr float kBulkDamping = 0.25f;

/// Eq 7 from the density kernel's sum over neighbours (itself included), measured against the rest lattice's
/// sum. `density`: kg/m³ that Eq 7 takes for the particle's fluid. `last_volume` (> 0) is the particle's
/// volume one step ago, the rest volume at the start.
template <class Real>
SLOSH_HD PressureState<Real> pressure_state(Real sum, float rest_sum, float rest_volume, Real density,
                                            float stiffness, float tension, Real last_volume,
                                            bool corrected) {
  const Real compression = sum / rest_sum - 1.0f;
  const Real effective = effective_compression(compression, Real(tension));
  Real felt = effective;
  if (corrected) {
    const Real gained = effective - (rest_volume / last_volume - 1.0f);
    const Real damped = RealOps<Real>::positive_part(effective + kBulkDamping * gained);
    felt = RealOps<Real>::where_less(Real(0.0f), effective, damped, effective);
  }
  const Real pressure = stiffness * density * felt;
  const Real volume = rest_volume / (1.0f + effective);
  return {corrected ? volume * volume * pressure : pressure, volume, compression};
}

}  // namespace slosh
