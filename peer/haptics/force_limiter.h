// The last guard before a device: magnitude and rate of the wrench within what the device takes.
#pragma once

#include <cmath>

#include "peer/haptics/device_limits.h"
#include "sim/math/pose.h"

namespace slosh {

/// Scales a vector down to at most `longest`; sets `limited` when it had to.
inline glm::dvec3 limit_length(const glm::dvec3& v, double longest, bool& limited) {
  const double length = glm::length(v);
  if (length <= longest) return v;
  limited = true;
  return v * (longest / length);
}

/// One device's limiter. Directions are kept; a non-finite wrench becomes zero.
class ForceLimiter {
 public:
  explicit ForceLimiter(const DeviceLimits& limits) : limits_(limits) {}

  struct Outcome {
    Wrench wrench;
    bool limited = false;
    bool non_finite = false;
  };
  /// `period` in s since the wrench before.
  Outcome limit(const Wrench& wanted, double period) noexcept {
    Outcome outcome;
    const double sum = wanted.force.x + wanted.force.y + wanted.force.z + wanted.torque.x + wanted.torque.y +
                       wanted.torque.z;
    if (!std::isfinite(sum)) {
      outcome.non_finite = true;
      last_ = Wrench{};
      return outcome;
    }
    bool& cut = outcome.limited;
    const glm::dvec3 force = limit_length(wanted.force, limits_.max_force, cut);
    const glm::dvec3 torque = limit_length(wanted.torque, limits_.max_torque, cut);
    last_.force += limit_length(force - last_.force, limits_.max_force_rate * period, cut);
    last_.torque += limit_length(torque - last_.torque, limits_.max_torque_rate * period, cut);
    outcome.wrench = last_;
    return outcome;
  }

 private:
  DeviceLimits limits_;
  Wrench last_;
};

}  // namespace slosh
