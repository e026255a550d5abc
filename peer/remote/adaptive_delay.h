// How far a peer lives behind the host: as little as the jitter of what arrives allows.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace slosh {

struct DelayOptions {
  double share = 0.95;    ///< of arrivals that shall be in time, 0–1
  double smallest = 0.0;  ///< s
  double largest = 2.0;   ///< s
  double rise = 0.15;     ///< s a second: the peer's clock then runs 15 % slow
  double fall = 0.02;     ///< s a second
  double jump = 0.25;     ///< s: a larger change is made at once
};

/// Follows a percentile of the last arrivals' lateness, slowly, so that what is shown by it neither jumps nor
/// runs backwards. Reads no clock; one thread.
class AdaptiveDelay {
 public:
  explicit AdaptiveDelay(const DelayOptions& options = {}) : options_(options), value_(options.smallest) {}

  /// One arrival: by how much it came after the moment that it belongs to, s; negative = ahead of it.
  void add(double lateness) {
    if (!std::isfinite(lateness)) return;
    last_[count_ % kWindow] = std::clamp(lateness, -options_.largest, options_.largest);
    count_ += 1;
    if (count_ <= kFirst || count_ % kEvery == 0) find_target();
  }

  /// The delay now, s, `elapsed` s after the call before.
  double advance(double elapsed) {
    if (count_ == 0) return value_;
    const double gap = target_ - value_;
    if (count_ <= kFirst || std::abs(gap) > options_.jump) {
      value_ = target_;
    } else {
      value_ += std::clamp(gap, -options_.fall * elapsed, options_.rise * elapsed);
    }
    return value_;
  }
  double value() const { return value_; }  ///< s

  /// A new connection: forget, but stay where we are until there is something to go by.
  void restart() { count_ = 0; }

 private:
  static constexpr std::size_t kWindow = 512;
  static constexpr std::size_t kFirst = 16;
  static constexpr std::size_t kEvery = 16;

  void find_target() {
    const std::size_t n = std::min(count_, kWindow);
    std::copy_n(last_.begin(), n, sorted_.begin());
    const auto place = std::min(static_cast<std::size_t>(options_.share * static_cast<double>(n)), n - 1);
    std::nth_element(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(place),
                     sorted_.begin() + static_cast<std::ptrdiff_t>(n));
    target_ = std::clamp(sorted_[place], options_.smallest, options_.largest);
  }

  DelayOptions options_;
  std::array<double, kWindow> last_{};
  std::array<double, kWindow> sorted_{};
  std::size_t count_ = 0;
  double target_ = 0.0;
  double value_ = 0.0;
};

}  // namespace slosh
