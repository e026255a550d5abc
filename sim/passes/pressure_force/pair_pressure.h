// Eq 5 between two particles.
#pragma once

#include "sim/particle_view.h"

namespace slosh {

/// How many lattice particles one wall particle of a flat boundary layer at the spacing stands for.
inline constexpr float kWallShare = 2.0f;

/// How two particles press on each other. The force on p is −(coefficient) · ∇W:
enum class PairRule {
  kPaper,          ///< Eq 5: V_p V_i (P_p + P_i)/2. `pressure` is P.
  kCorrected,      ///< (T_p + T_i) ∇W of two tensors `push`.
  kCorrectedWall,  ///< fluid p against wall particle i: T_p times the wall's share (how many lattice
                   ///< particles it stands for), which is the wall's `pressure`.
  kCorrectedBody,  ///< the other side of it: wall particle p against fluid i.
  // With pressure projection:
  kSolved,      ///< fluid on fluid: the solve gives pressures, only viscosity is left
  kSolvedWall,  ///< of walls on fluid, likewise
  kSolvedBody,  ///< kCorrectedBody, where `push` is the tensor of 1 Pa, m⁶, and `pressure` the fluid's, Pa
};

constexpr bool presses_by_tensor(PairRule rule) {
  return rule == PairRule::kCorrected || rule == PairRule::kCorrectedWall ||
         rule == PairRule::kCorrectedBody || rule == PairRule::kSolvedBody;
}
/// Between fluid particles, which have artificial viscosity besides.
constexpr bool is_corrected_fluid(PairRule rule) {
  return rule == PairRule::kCorrected || rule == PairRule::kSolved;
}
/// On a wall's particle, by fluid.
constexpr bool is_corrected_body(PairRule rule) {
  return rule == PairRule::kCorrectedBody || rule == PairRule::kSolvedBody;
}
constexpr bool presses(PairRule rule) {
  return rule != PairRule::kSolved && rule != PairRule::kSolvedWall;
}

/// What a pair presses with, where that is a tensor.
template <PairRule rule, class Real>
SLOSH_HD Symmetric<Real> pressure_tensor(const ParticleView<Real>& p, const ParticleView<Real>& i) {
  if constexpr (rule == PairRule::kCorrected) {
    return {p.push.xx + i.push.xx, p.push.xy + i.push.xy, p.push.xz + i.push.xz,
            p.push.yy + i.push.yy, p.push.yz + i.push.yz, p.push.zz + i.push.zz};
  } else if constexpr (rule == PairRule::kCorrectedWall) {
    return scaled_and_shifted(p.push, i.pressure, Real(0.0f));
  } else if constexpr (rule == PairRule::kSolvedBody) {
    return scaled_and_shifted(i.push, p.pressure * i.pressure, Real(0.0f));
  } else {
    return scaled_and_shifted(i.push, p.pressure, Real(0.0f));
  }
}

/// What it presses with as published.
template <class Real>
SLOSH_HD Real pressure_coefficient(const ParticleView<Real>& p, const ParticleView<Real>& i) {
  return Real(0.5f) * (p.volume * i.volume) * (p.pressure + i.pressure);
}

}  // namespace slosh
