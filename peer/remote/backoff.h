// When a peer that lost its host tries again.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>

#include "net/clock.h"

namespace slosh {

/// 0.1, 0.2, 0.5, then 1 s after each failure, until `patience` s have passed since contact was lost. Reads
/// no clock.
class Backoff {
 public:
  explicit Backoff(double patience = 300.0) : patience_ns_(to_nanoseconds(patience)) {}

  /// Contact was lost. The first try is due 0.1 s later.
  void lost(std::int64_t now_ns) {
    lost_ns_ = now_ns;
    tries_ = 0;
    failed(now_ns);
  }
  /// A try failed: the next is due after a while.
  void failed(std::int64_t now_ns) {
    constexpr double kWaits[] = {0.1, 0.2, 0.5, 1.0};
    due_ns_ = now_ns + to_nanoseconds(kWaits[std::min<std::size_t>(tries_, std::size(kWaits) - 1)]);
    tries_ += 1;
  }
  std::int64_t due_ns() const { return due_ns_; }
  bool gave_up(std::int64_t now_ns) const { return now_ns - lost_ns_ > patience_ns_; }

 private:
  std::int64_t patience_ns_;
  std::int64_t lost_ns_ = 0;
  std::int64_t due_ns_ = 0;
  std::size_t tries_ = 0;
};

}  // namespace slosh
