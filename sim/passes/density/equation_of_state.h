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
struct PressureState {
  float pressure;     ///< Pa; kCorrected: V²P, N·m⁴
  float volume;       ///< m³
  float compression;  ///< ρ/ρ⁰ − 1
};

/// Bulk damping of the corrected model: this times the compression gained since the last step is felt on top
/// of the compression itself. It takes the ring out of sound and the bounce out of a drop that meets a wall,
/// which without it comes back with up to twice its speed (a contact lasts about three steps); shear does not
/// feel it. Explicit, so with ω the stiffest mode (1 + 2 · this) ω²Δt² must stay below 4.
inline constexpr float kBulkDamping = 0.25f;

/// Eq 7 from the density kernel's sum over neighbours (itself included), measured against the rest lattice's
/// sum. `density`: kg/m³ that Eq 7 takes for the particle's fluid. `last_volume` (> 0) is the particle's
/// volume one step ago, the rest volume at the start.
SLOSH_HD inline PressureState pressure_state(float sum, float rest_sum, float rest_volume, float density,
                                             float stiffness, float tension, float last_volume,
                                             bool corrected) {
  const float compression = sum / rest_sum - 1.0f;
  const float effective = effective_compression(compression, tension);
  float felt = effective;
  if (corrected && effective > 0.0f) {
    const float gained = effective - (rest_volume / last_volume - 1.0f);
    felt = RealOps<float>::positive_part(effective + kBulkDamping * gained);
  }
  const float pressure = stiffness * density * felt;
  const float volume = rest_volume / (1.0f + effective);
  return {corrected ? volume * volume * pressure : pressure, volume, compression};
}

}  // namespace slosh
