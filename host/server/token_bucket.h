// How often somebody may do something.
#pragma once

#include <algorithm>
#include <cstdint>

namespace slosh {

/// Fills by `rate` a second up to `burst`; every take() needs 1. Reads no clock.
class TokenBucket {
 public:
  TokenBucket(double rate, double burst) : rate_(rate), burst_(burst), level_(burst) {}

  /// False when there is not enough; then nothing is taken.
  bool take(std::int64_t now_ns, double amount = 1.0) {
    fill(now_ns);
    if (level_ < amount) return false;
    level_ -= amount;
    return true;
  }

  /// s until take() of so much, `burst` at most, finds enough; 0 = now.
  double wait(std::int64_t now_ns, double amount = 1.0) {
    fill(now_ns);
    return std::max(0.0, amount - level_) / rate_;
  }

 private:
  void fill(std::int64_t now_ns) {
    if (last_ns_ != 0)
      level_ = std::min(burst_, level_ + rate_ * 1e-9 * static_cast<double>(now_ns - last_ns_));
    last_ns_ = now_ns;
  }

  double rate_;
  double burst_;
  double level_;
  std::int64_t last_ns_ = 0;
};

}  // namespace slosh
