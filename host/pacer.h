// When the next step is due, so that simulated time keeps up with the steady clock. Reads no clock itself.
#pragma once

#include <cmath>
#include <cstdint>

#include "net/clock.h"

namespace slosh {

/// Steps are due a period apart from the start, not from each other: a late step does not delay the next.
/// When the steps have fallen behind by more than the tolerance, the world slows down instead of racing to
/// catch up: the schedule moves to now, which is counted as a slip.
class Pacer {
 public:
  /// `period` in s, > 0; `tolerance` in s, >= 0.
  explicit Pacer(double period, double tolerance = 0.05)
      : period_ns_(period * 1e9), tolerance_ns_(to_nanoseconds(tolerance)) {}

  /// The first step is due one period after `now_ns`. Also after a pause.
  void restart(std::int64_t now_ns) {
    origin_ns_ = now_ns;
    steps_ = 0;
  }

  /// From `now_ns` on steps are due so far apart (s, > 0); what they were before changes nothing.
  void set_period(double period, std::int64_t now_ns) {
    if (period * 1e9 == period_ns_) return;
    period_ns_ = period * 1e9;
    restart(now_ns);
  }

  struct Turn {
    std::int64_t deadline_ns = 0;  ///< sleep until then, then step
    bool slipped = false;
    double behind = 0.0;  ///< s after the schedule that this is; negative where there is time left
  };

  /// Call when ready to step.
  Turn next(std::int64_t now_ns) {
    steps_ += 1;
    const std::int64_t deadline = origin_ns_ + std::llround(period_ns_ * static_cast<double>(steps_));
    const std::int64_t behind = now_ns - deadline;
    if (behind <= tolerance_ns_) return {deadline, false, to_seconds(behind)};
    origin_ns_ += behind;
    slips_ += 1;
    slipped_ns_ += behind;
    return {now_ns, true, to_seconds(behind)};
  }

  std::uint64_t slips() const { return slips_; }
  double slipped_seconds() const { return to_seconds(slipped_ns_); }

 private:
  double period_ns_;
  std::int64_t tolerance_ns_;
  std::int64_t origin_ns_ = 0;
  std::uint64_t steps_ = 0;
  std::uint64_t slips_ = 0;
  std::int64_t slipped_ns_ = 0;
};

}  // namespace slosh
