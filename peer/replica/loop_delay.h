// How long this site's hand takes through the host and back, from what the host acknowledges.
#pragma once

#include <algorithm>
#include <cmath>

namespace slosh {

/// The delay of this site's loop through the host.
struct LoopDelay {
  double round_trip = 0.0;  ///< s, from a reading to the state that follows it, at its quickest
  double jitter = 0.0;      ///< s by which it is longer at its slowest
};

/// The lower and the upper envelope of the acknowledgements' ages: each falls upon an age beyond it at once,
/// half way, and forgets over kMemory s. Reads no clock; one thread.
class LoopDelayEstimate {
 public:
  static constexpr double kMemory = 5.0;
  static constexpr double kLongest = 1.0;  ///< s: an older acknowledgement says that the link stood

  void restart() noexcept { *this = LoopDelayEstimate{}; }
  /// An acknowledgement that came `age` s after its reading, `elapsed` s after the one before.
  void note(double age, double elapsed) noexcept {
    if (!std::isfinite(age)) return;
    const double a = std::clamp(age, 0.0, kLongest);
    if (!known_) {
      low_ = high_ = a;
      known_ = true;
      return;
    }
    const double forget = 1.0 - std::exp(-std::clamp(elapsed, 0.0, kMemory) / kMemory);
    low_ += (a < low_ ? 0.5 : forget) * (a - low_);
    high_ += (a > high_ ? 0.5 : forget) * (a - high_);
  }
  LoopDelay delay() const noexcept { return {low_, high_ - low_}; }
  bool known() const noexcept { return known_; }

 private:
  bool known_ = false;
  double low_ = 0.0;
  double high_ = 0.0;
};

}  // namespace slosh
