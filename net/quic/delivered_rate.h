// How fast bytes really leave a link at its other end.
#pragma once

#include <algorithm>
#include <cstdint>

namespace slosh::quic {

/// Bytes a second that were acknowledged (or given up), the most of the last seconds: what is told is a mean
/// over a round trip, so that acknowledgements that come in clumps do not pass for a fast link. The library's
/// own estimate (0.12) never falls: one clump, 1.6 MB/s where 1.0 go, stays for good, and 1.x tells none.
class DeliveredRate {
 public:
  /// `delivered`: bytes since the beginning, never falling by much; `now` in ns; `span` in s. 0 = nothing
  /// known yet.
  double note(std::uint64_t delivered, std::int64_t now, double span) {
    const double passed = 1e-9 * static_cast<double>(now - began_);
    if (began_ == 0 || passed >= std::max(span, kMinSpan)) {
      if (began_ != 0 && delivered > delivered_)
        this_ = std::max(this_, static_cast<double>(delivered - delivered_) / passed);
      began_ = now;
      delivered_ = delivered;
    }
    if (now - turn_ > kTurn) {
      last_ = this_;
      this_ = 0.0;
      turn_ = now;
    }
    return std::max(this_, last_);
  }

 private:
  static constexpr double kMinSpan = 0.05;  // s: acknowledgements may be late by half of that
  static constexpr std::int64_t kTurn =
      2'000'000'000;  // ns: a link that got slower is known after twice that

  double this_ = 0.0, last_ = 0.0;  // bytes a s
  std::int64_t turn_ = 0;
  std::int64_t began_ = 0;
  std::uint64_t delivered_ = 0;
};

}  // namespace slosh::quic
