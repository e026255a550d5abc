// How fast a world steps, as windows and consoles show it. Reads no clock.
#pragma once

#include <cstdint>

#include "net/clock.h"

namespace slosh {

/// Rates over the last window.
class RateMeter {
 public:
  void restart(std::int64_t now_ns) {
    window_ns_ = now_ns;
    window_steps_ = 0;
    window_step_time_ = 0.0;
  }

  /// True when a window is over; then the rates are new.
  bool add(double step_time, std::int64_t now_ns) {
    window_steps_ += 1;
    window_step_time_ += step_time;
    const double elapsed = to_seconds(now_ns - window_ns_);
    if (elapsed < kWindow) return false;
    step_rate = static_cast<double>(window_steps_) / elapsed;
    step_ms = 1e3 * window_step_time_ / static_cast<double>(window_steps_);
    window_ns_ = now_ns;
    window_steps_ = 0;
    window_step_time_ = 0.0;
    return true;
  }

  double step_rate = 0.0;
  double step_ms = 0.0;

 private:
  static constexpr double kWindow = 0.25;  // wall s

  std::int64_t window_ns_ = 0;
  std::uint64_t window_steps_ = 0;
  double window_step_time_ = 0.0;
};

}  // namespace slosh
