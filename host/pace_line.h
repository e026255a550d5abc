// At which moments a world's states belong, and at what pace it goes: as asked while it keeps up, else as
// measured. Reads no clock.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "host/pacer.h"
#include "net/clock.h"

namespace slosh {

/// While a world keeps to its schedule, its states belong to the schedule's moments, however long the single
/// step took, and its pace is the one that was asked for. A world that has fallen behind for good has no
/// schedule: a state then belongs to about when it was ready, smoothed, and the pace is what the steps
/// achieve. Hands take their velocities from it, so it is neither a hope nor the luck of one step.
class PaceLine {
 public:
  /// Steps behind the schedule, and s at least, from which on it counts as lost: as far as a device loop
  /// carries a state on. A pacer hopes on for longer.
  static constexpr double kLost = 2.0;
  static constexpr double kMinLost = 0.002;
  /// s without such a step after which the schedule counts as kept again.
  static constexpr double kKept = 1.0;
  /// s over which the pace is averaged, and over which stamps are drawn to when states are ready.
  static constexpr double kMemory = 0.3;
  static constexpr double kDrawn = 0.03;
  /// s that a stamp may be ahead of when its state was ready.
  static constexpr double kAhead = 0.005;

  /// A run begins, or goes on after a pause.
  void restart(std::int64_t now_ns) {
    ready_ns_ = stamp_ns_ = now_ns;
    measured_ = 1.0;
    measured_for_ = 0.0;
    slow_ = false;
    kept_ = 0.0;
  }

  struct Moment {
    std::int64_t stamp_ns = 0;
    double rate = 1.0;  ///< simulated s a s, > 0, at most the pace that was asked for
  };
  /// A step of `time_step` s that was to take its turn, asked to go at `pace` (0–1], was ready at `ready_ns`.
  Moment after_step(double time_step, double pace, const Pacer::Turn& turn, std::int64_t ready_ns) {
    const double elapsed = std::max(to_seconds(ready_ns - ready_ns_), 1e-6);
    ready_ns_ = ready_ns;
    const double achieved = time_step / elapsed;
    // At first the mean of all there is.
    measured_for_ += elapsed;
    measured_ +=
        std::max(1.0 - std::exp(-elapsed / kMemory), elapsed / measured_for_) * (achieved - measured_);
    const std::int64_t scheduled_ns = turn.deadline_ns + to_nanoseconds(time_step / pace);
    const bool lost = turn.slipped || turn.behind > std::max(kLost * time_step / pace, kMinLost);
    kept_ = lost ? 0.0 : kept_ + elapsed;
    slow_ = lost || (slow_ && kept_ <= kKept);
    const double rate = slow_ ? std::min(measured_, pace) : pace;
    if (!slow_) {
      stamp_ns_ = std::max(stamp_ns_, scheduled_ns);
      return {stamp_ns_, rate};
    }
    const std::int64_t due_ns = std::max(ready_ns, scheduled_ns);
    // A step that took long moves the line by a part of that, and the rest follows.
    const double on = time_step / rate;
    const double off = to_seconds(due_ns - stamp_ns_) - on;
    const double next = on + (1.0 - std::exp(-elapsed / kDrawn)) * off;
    const std::int64_t line_ns = stamp_ns_ + to_nanoseconds(std::clamp(next, 0.0, elapsed + on));
    stamp_ns_ = std::max(stamp_ns_,
                         std::clamp(line_ns, due_ns - to_nanoseconds(on), due_ns + to_nanoseconds(kAhead)));
    return {stamp_ns_, rate};
  }
  bool slow() const { return slow_; }

 private:
  std::int64_t ready_ns_ = 0;
  std::int64_t stamp_ns_ = 0;
  double measured_ = 1.0;
  double measured_for_ = 0.0;  // s
  bool slow_ = false;
  double kept_ = 0.0;  // s since a step was late
};

}  // namespace slosh
