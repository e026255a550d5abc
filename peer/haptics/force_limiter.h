// The last limit before a device: magnitude, rate and jerk of the wrench within what device and hand take.
#pragma once

#include <algorithm>
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

/// One device's limiter. What is wanted within the limits passes as it is; beyond them the wrench follows as
/// fast as they allow, and slows down in time to stop where it is wanted. A non-finite wrench becomes zero at
/// once.
class ForceLimiter {
 public:
  explicit ForceLimiter(const DeviceLimits& limits) : limits_(limits) {}

  struct Outcome {
    Wrench wrench;
    Wrench wanted;         ///< as it was asked for
    bool limited = false;  ///< by size or rate; the jerk alone is not told
    bool non_finite = false;
    double asked_force = 0.0;   ///< N that was wanted, whatever was given
    double asked_torque = 0.0;  ///< N·m
  };
  /// The device has only that share (0–1) of the wrench before left: somebody else took the rest.
  void faded(double share) noexcept {
    last_ = wanted_ = {share * last_.force, share * last_.torque};
    rate_ = Wrench{};
  }
  /// `period` in s since the wrench before.
  Outcome limit(const Wrench& wanted, double period) noexcept {
    Outcome outcome;
    outcome.wanted = wanted;
    const double sum = wanted.force.x + wanted.force.y + wanted.force.z + wanted.torque.x + wanted.torque.y +
                       wanted.torque.z;
    if (!std::isfinite(sum)) {
      outcome.non_finite = true;
      last_ = rate_ = wanted_ = Wrench{};
      return outcome;
    }
    bool& cut = outcome.limited;
    outcome.asked_force = glm::length(wanted.force);
    outcome.asked_torque = glm::length(wanted.torque);
    const glm::dvec3 force = limit_length(wanted.force, limits_.max_force, cut);
    const glm::dvec3 torque = limit_length(wanted.torque, limits_.max_torque, cut);
    follow(force, wanted_.force, last_.force, rate_.force, limits_.max_force_rate, limits_.max_force_jerk,
           period, cut);
    follow(torque, wanted_.torque, last_.torque, rate_.torque, limits_.max_torque_rate,
           limits_.max_torque_jerk, period, cut);
    bool over = false;  // by following a target that turned away
    last_.force = limit_length(last_.force, limits_.max_force, over);
    last_.torque = limit_length(last_.torque, limits_.max_torque, over);
    outcome.wrench = last_;
    return outcome;
  }

 private:
  static void follow(const glm::dvec3& wanted, glm::dvec3& before, glm::dvec3& at, glm::dvec3& rate,
                     double most_rate, double jerk, double period, bool& cut) noexcept {
    // What is wanted moves by itself; what is left to catch up with is from before.
    const glm::dvec3 moves = (wanted - before) / period;
    const glm::dvec3 left = before - at;
    before = wanted;
    const double distance = glm::length(left);
    // The rate from which it can still stop there: d = v²/2j + v·T/2.
    const double half = 0.5 * jerk * period;
    const double stops = 2.0 * jerk * distance / (std::sqrt(half * half + 2.0 * jerk * distance) + half);
    const bool reaches = distance <= stops * period;
    glm::dvec3 goal = (wanted - at) / period;
    if (!reaches) goal = moves + left * (stops / distance);
    bool fast = false;
    goal = limit_length(goal, most_rate, fast);
    cut = cut || fast;
    const glm::dvec3 change = goal - rate;
    const double jolt = glm::length(change);
    if (jolt <= jerk * period) {
      rate = goal;
      at = reaches && !fast ? wanted : at + period * rate;
    } else {
      rate += change * (jerk * period / jolt);
      at += period * rate;
    }
  }

  DeviceLimits limits_;
  Wrench last_;
  Wrench rate_;    // a second, of the call before
  Wrench wanted_;  // within the limits of size, at the call before
};

}  // namespace slosh
