// What a hand's coupling asked of its device beyond what that gives: for whoever is to see that it clips.
#pragma once

#include <algorithm>
#include <atomic>
#include <string>

#include "peer/haptics/device_limits.h"
#include "sim/math/format.h"

namespace slosh {

/// In the world's measure, as DeviceLimits are.
struct ForceBudget {
  double asked_force = 0.0;   ///< N, the most lately; 0 while it does not clip
  double asked_torque = 0.0;  ///< N·m, the same
  double max_force = 0.0;     ///< N and N·m that the device gives
  double max_torque = 0.0;
  double clipped = 0.0;  ///< s of the run so far in which one of both was beyond it
};

/// note() and restart() by the device loop, now() by any thread: a number may be of the tick before.
class ForceBudgetNote {
 public:
  void restart() noexcept {
    left_ = 0.0;
    for (std::atomic<double>* number : {&asked_force_, &asked_torque_, &clipped_}) set(*number, 0.0);
  }
  /// What was wanted of the device in a tick of `period` s.
  void note(double force, double torque, const DeviceLimits& limits, double period) noexcept {
    const bool over_force = force > limits.max_force, over_torque = torque > limits.max_torque;
    if (over_force || over_torque) {
      left_ = kShown;
      set(clipped_, get(clipped_) + period);
    } else if (left_ > 0.0 && (left_ -= period) <= 0.0) {
      set(asked_force_, 0.0);
      set(asked_torque_, 0.0);
    }
    if (over_force) set(asked_force_, std::max(get(asked_force_), force));
    if (over_torque) set(asked_torque_, std::max(get(asked_torque_), torque));
    set(max_force_, limits.max_force);
    set(max_torque_, limits.max_torque);
  }
  ForceBudget now() const noexcept {
    return {get(asked_force_), get(asked_torque_), get(max_force_), get(max_torque_), get(clipped_)};
  }

  static constexpr double kShown = 1.5;  ///< s: long enough to be read

 private:
  static void set(std::atomic<double>& number, double value) noexcept {
    number.store(value, std::memory_order_relaxed);
  }
  static double get(const std::atomic<double>& number) noexcept {
    return number.load(std::memory_order_relaxed);
  }
  double left_ = 0.0;  // s that it is still shown
  std::atomic<double> asked_force_{0.0}, asked_torque_{0.0}, max_force_{0.0}, max_torque_{0.0}, clipped_{0.0};
};

/// A line for a person, e.g. "left: 14.2 N asked of a device of 8.0 N"; empty while nothing clips.
inline std::string budget_line(const std::string& grip, const ForceBudget& b) {
  std::string line;
  if (b.asked_force > 0.0) line += format("%.1f N asked of a device of %.1f N", b.asked_force, b.max_force);
  if (b.asked_torque > 0.0)
    line += (line.empty() ? "" : ", ") +
            format("%.2f Nm asked of a device of %.2f Nm", b.asked_torque, b.max_torque);
  return line.empty() ? line : grip + ": " + line;
}

}  // namespace slosh
