// What the corrected model takes for rest density, against the lattice that fluid is sampled on.
//
// A fluid under its own weight is denser than rest, by half of what it is at the floor in the mean: so much
// lower a pool stands, and what follows from its depth is off with it. And particles that have settled lie
// otherwise than on the cubic lattice that they start from: at the same density their moment is 5 % smaller,
// and measured against the lattice's they are taken for a surface, where less of the correction is made. So
// pressure is none at a smaller sum, and the moment that directions of pressure are measured against is that
// of settled particles. A tank 10 cm deep at 10 mm, before and with it: level −4.5, −1.6 %; pressure 3 and
// 7 cm down −12, −3.5 and −2.9, −0.1 %; a wave keeps 91.7 and 93.6 % of its swing each period.
//
// A lattice let go is then under pressure, as much as half its depth makes: let go at once it throws its
// surfaces off (the front of a dam break 20 % ahead of the reading instead of 14). So it expands over
// kSettlingTime.
#pragma once

#include <algorithm>

#include "sim/passes/density/corrected_state.h"

namespace slosh {

/// The share of the lattice's moment that settled particles lack. At 0, 3, 5 % (expansion alone is 2) a wave
/// keeps 89, 93, 94 % of its swing, a ball of 1.5 spacings in a tube is dragged by 24, 29, 31 % too little.
inline constexpr double kPackedMoment = 0.05;
/// Of the compression under the fluid's weight, at most: a softer fluid is one that shall give.
inline constexpr double kMaxLoad = 0.02;
inline constexpr double kSettlingTime = 0.2;  ///< s, settling before the run counted

/// `lattice` as a fluid needs it after `age` s. `load`: its compression by its own weight, mean over its
/// depth.
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
