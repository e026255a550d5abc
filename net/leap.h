// Whether a hand went from one pose to the next, or is simply elsewhere.
#pragma once

#include <algorithm>

#include "sim/math/pose.h"

namespace slosh {

/// m that a hand may be off where it was said to go without anybody minding ...
constexpr double kLeapDistance = 0.03;
/// ... and m/s that it may have gone besides twice the speed that it told.
constexpr double kLeapSpeed = 1.0;

/// True for a change that no hand makes in `seconds`, as after a silence, a clutch or a glitch of a tracker:
/// the hand re-engages (net/engagement.h) where a spring would pull it back from there. `speed` in m/s, the
/// greater of those told before and after. Both ends of a channel ask.
inline bool leapt(const glm::dvec3& from, const glm::dvec3& to, double speed, double seconds) {
  const double distance = glm::length(to - from);
  return distance > kLeapDistance && distance > (kLeapSpeed + 2.0 * speed) * std::max(seconds, 0.0);
}

}  // namespace slosh
