// Rest-density calibration of the corrected model, against the lattice that fluid is sampled on.
//
// A fluid under its own weight is denser than rest, in the mean by half of what it is at the floor, and its
// level is lower by as much. Settled particles have a moment matrix 5 % smaller than the cubic lattice's at
// the same density, and against the lattice's they would be taken for a surface. So pressure is zero at a
// smaller sum, and the reference moment is that of settled particles.
// (tests/notebook/2026-11-27-thinner-rest-density.md)
//
// The starting lattice is then under pressure, as much as half its depth makes, and would throw its surfaces
// off. So the rest density relaxes over kSettlingTime.
#pragma once

#include <algorithm>

#include "sim/passes/density/corrected_state.h"

namespace slosh {

/// The share of the lattice's moment that settled particles lack. At 0, 3, 5 % (expansion alone is 2) a wave
/// keeps 89, 93, 94 % of its swing, drag on a ball of 1.5 spacings in a tube is 24, 29, 31 % too small.
inline constexpr double kPackedMoment = 0.05;
/// Of the compression under the fluid's weight, at most: a softer fluid is one that shall give.
inline constexpr double kMaxLoad = 0.02;
inline constexpr double kSettlingTime = 0.2;  ///< s, relaxation time; settling before the run counts

/// `lattice` as a fluid needs it `age` s after its start. `load`: its compression by its own weight, mean
/// over its depth.
inline CorrectionConstants settled(const CorrectionConstants& lattice, double load, double age) {
  const double share = std::clamp(age / kSettlingTime, 0.0, 1.0);
  const double thinner = std::min(load, kMaxLoad);
  const double moment = 1.0 - share * (kPackedMoment + thinner);
  CorrectionConstants c = lattice;
  c.rest_number = static_cast<float>((1.0 - share * thinner) * lattice.rest_number);
  c.rest_moment = static_cast<float>(moment * lattice.rest_moment);
  c.push_scale = static_cast<float>(lattice.push_scale / moment);
  return c;
}

}  // namespace slosh
