// What becomes of each packet of one direction: pure arithmetic, no clock and no socket.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>

#include "net/clock.h"
#include "net/impair/relay.h"

namespace slosh {

class Fate {
 public:
  Fate(const Impairment& impairment, std::uint64_t seed) : impairment_(impairment), random_(seed) {}

  void set(const Impairment& impairment) { impairment_ = impairment; }

  struct Verdict {
    int copies = 0;  ///< 0 = lost
    std::int64_t due_ns = 0;
  };

  Verdict judge(std::size_t bytes, std::int64_t now_ns) {
    if (lost()) return {};
    std::int64_t leaves = now_ns;
    if (impairment_.rate > 0.0) {
      const std::int64_t start = std::max(now_ns, free_ns_);
      if (to_seconds(start - now_ns) * impairment_.rate > impairment_.queue) return {};
      free_ns_ = start + to_nanoseconds(static_cast<double>(bytes) / impairment_.rate);
      leaves = free_ns_;
    }
    Verdict verdict;
    verdict.copies = chance(impairment_.duplicate) ? 2 : 1;
    verdict.due_ns = leaves + to_nanoseconds(impairment_.delay + impairment_.jitter * uniform_(random_));
    if (chance(impairment_.reorder)) {
      verdict.due_ns += to_nanoseconds(impairment_.reorder_delay);
    } else {
      verdict.due_ns = std::max(verdict.due_ns, last_ns_);
      last_ns_ = verdict.due_ns;
    }
    return verdict;
  }

 private:
  bool chance(double probability) { return probability > 0.0 && uniform_(random_) < probability; }

  /// Two states (Gilbert): in the bad one everything is lost. Stays in it for `burst` packets on average,
  /// and enters it so often that `loss` of all packets are lost.
  bool lost() {
    const double loss = std::clamp(impairment_.loss, 0.0, 1.0);
    if (loss <= 0.0) return false;
    if (loss >= 1.0) return true;
    const double burst = std::max(impairment_.burst, 1.0);
    if (burst <= 1.0) return chance(loss);
    const double leave = 1.0 / burst;
    const double enter = std::min(1.0, leave * loss / (1.0 - loss));
    bad_ = bad_ ? !chance(leave) : chance(enter);
    return bad_;
  }

  Impairment impairment_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
  bool bad_ = false;
  std::int64_t free_ns_ = 0;  // when the link has sent what waits
  std::int64_t last_ns_ = 0;  // when the last in order arrives
};

}  // namespace slosh
