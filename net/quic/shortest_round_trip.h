// What a way takes when nothing stands in its queues.
#pragma once

#include <algorithm>
#include <cstdint>

namespace slosh::quic {

/// The shortest round trip of the last one to two spans: ways may grow longer.
class ShortestRoundTrip {
 public:
  static constexpr double kNever = 1e9;  ///< s, while nothing is known

  /// `rtt` in s, 0 = none; `now` in ns. The shortest, s, or kNever.
  double note(double rtt, std::int64_t now) {
    if (rtt > 0.0) {
      if (now - began_ > kSpan) {
        last_ = this_;
        this_ = kNever;
        began_ = now;
      }
      this_ = std::min(this_, rtt);
    }
    return std::min(this_, last_);
  }

 private:
  static constexpr std::int64_t kSpan = 6'000'000'000;  // ns; BBR empties the queues every 5 s

  double this_ = kNever;  // s
  double last_ = kNever;
  std::int64_t began_ = 0;
};

/// The shortest round trip of the last one to two of them: what stands in queues is in all of it, what
/// dithers in some.
class RecentRoundTrip {
 public:
  /// `rtt` in s, 0 = none; `now` in ns; `span` in s. The shortest of the last one to two spans, s, 0 before
  /// any.
  double note(double rtt, std::int64_t now, double span) {
    if (rtt <= 0.0) return std::min(this_, last_) < ShortestRoundTrip::kNever ? std::min(this_, last_) : 0.0;
    if (static_cast<double>(now - began_) > 1e9 * span) {
      last_ = this_;
      this_ = ShortestRoundTrip::kNever;
      began_ = now;
    }
    this_ = std::min(this_, rtt);
    return std::min(this_, last_);
  }

 private:
  double this_ = ShortestRoundTrip::kNever;  // s
  double last_ = ShortestRoundTrip::kNever;
  std::int64_t began_ = 0;
};

}  // namespace slosh::quic
