// Staleness: how long a last value is used when no newer one comes: body states by a hand, readings by the
// loop, wrenches by a device.
#pragma once

#include <algorithm>

#include "net/engagement.h"

namespace slosh {

/// s of silence for which the newest update counts as fresh. A hand whose updates were stale re-engages with
/// the next (net/engagement.h).
constexpr double kHoldStale = kHoldAnew;
/// s over which the force then fades.
constexpr double kFadeStale = 0.3;
/// s of silence after which no hand has a force, whatever the world does and however slow it is.
constexpr double kSilent = kHoldStale + kFadeStale;

/// s over which a force fades at least, however much of kSilent is over before a silence can be known of.
constexpr double kMinFade = 0.1;

/// Share of the force, 0–1, when the newest update is `age` s old and one comes every `interval` s. A slow
/// sender is waited for twice as long and no longer. `way`: s that an update is usually on its way, by which
/// a silence is older than it shows: that comes off the time in which the force fades.
inline double freshness(double age, double interval, double way = 0.0) {
  const double hold = std::clamp(4.0 * interval, kHoldStale, 2.0 * kHoldStale);
  const double silent = std::clamp(kSilent - way, hold + kMinFade, kSilent);
  return std::clamp((silent - age) / (silent - hold), 0.0, 1.0);
}

}  // namespace slosh
