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

}  // namespace slosh::make
