// Smooth hand motion between keys.
#pragma once

#include <algorithm>
#include <vector>

namespace slosh::make {

struct Key {
  double time;  ///< s
  double value;
};

/// Minimum-jerk way from 0 to 1: rest, speed and acceleration zero at both ends (Flash & Hogan 1985).
inline double minimum_jerk(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

/// The value at `time` of a line of keys with minimum-jerk ways between them; held before and after.
inline double follow(const std::vector<Key>& keys, double time) {
  if (time <= keys.front().time) return keys.front().value;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const Key& a = keys[i - 1];
    const Key& b = keys[i];
    if (time < b.time)
      return a.value + (b.value - a.value) * minimum_jerk((time - a.time) / (b.time - a.time));
  }
  return keys.back().value;
}

/// A steady turn with a smooth start and stop.
struct Turn {
  double start;   ///< s, when the speed begins to rise
  double ramp;    ///< s, of the rise and of the fall
  double steady;  ///< s at full speed between them
  double rate;    ///< rad/s at full speed
};

/// The angle turned until `time`, rad: the speed follows a minimum-jerk rise, stays, and falls likewise.
inline double turned(const Turn& turn, double time) {
  // ∫ minimum_jerk from 0 to u
  const auto rise = [](double u) { return u * u * u * u * (2.5 + u * (-3.0 + u)); };
  const double up = std::clamp((time - turn.start) / turn.ramp, 0.0, 1.0);
  const double level = std::clamp(time - turn.start - turn.ramp, 0.0, turn.steady);
  const double down = std::clamp((time - turn.start - turn.ramp - turn.steady) / turn.ramp, 0.0, 1.0);
  return turn.rate * (turn.ramp * rise(up) + level + turn.ramp * (down - rise(down)));
}

}  // namespace slosh::make
