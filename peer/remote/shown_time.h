// Which moment of the world is on show now: a little behind the host, on a clock that runs evenly.
#pragma once

#include <algorithm>
#include <cstdint>

#include "net/clock.h"
#include "peer/remote/adaptive_delay.h"

namespace slosh {

/// The delay follows how late frames come, against the host's simulated time: as small as lets 95 % of them
/// be there when they are needed. Reads no clock; one thread, or one lock.
class ShownTime {
 public:
  /// A frame of `frame_time` was decoded when the host's world stood at `world_time`, both simulated s.
  void arrived(double frame_time, double world_time) { delay_.add(world_time - frame_time); }

  /// What to show while the host's world stands at `world_time`, simulated s. Rises, but after a reset.
  double at(double world_time, std::int64_t now_ns) {
    delay_.advance(std::clamp(to_seconds(now_ns - last_ns_), 0.0, 1.0));
    last_ns_ = now_ns;
    const double wanted = world_time - delay_.value();
    const bool jumped = wanted < shown_ - kBackBySurprise;
    shown_ = jumped ? wanted : std::max(shown_, wanted);
    return shown_;
  }
  double delay() const { return delay_.value(); }  ///< s

  /// A new run or connection.
  void restart() {
    shown_ = -1e9;
    delay_.restart();
  }

 private:
  static constexpr double kBackBySurprise = 1.0;  // s: no jitter of the reckoning does that
  AdaptiveDelay delay_{DelayOptions{.share = 0.95, .largest = 3.0, .rise = 0.2, .fall = 0.02, .jump = 0.5}};
  double shown_ = -1e9;
  std::int64_t last_ns_ = 0;
};

}  // namespace slosh
