// Unix time for what must not last longer than it was meant to.
#pragma once

#include <time.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>

#include "net/clock.h"

namespace slosh {

/// CLOCK_REALTIME, ns of Unix time. Jumps when somebody sets it.
inline std::int64_t unix_now_ns() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return static_cast<std::int64_t>(now.tv_sec) * kNanosecondsPerSecond + now.tv_nsec;
}

/// CLOCK_BOOTTIME, ns: as the steady clock, but goes on while the machine is suspended.
inline std::int64_t boot_now_ns() {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<std::int64_t>(now.tv_sec) * kNanosecondsPerSecond + now.tv_nsec;
}

/// The system's clock, but for two tricks: while the machine is suspended it goes on, and when somebody sets
/// the system's clock back it goes on too. Set ahead, it follows. One thread.
class LastingClock {
 public:
  using Source = std::function<std::int64_t()>;  ///< ns
  /// `system`: Unix time, which may be set at will; `elapsed`: goes on evenly, also while suspended.
  explicit LastingClock(Source system = unix_now_ns, Source elapsed = boot_now_ns)
      : system_(std::move(system)), elapsed_(std::move(elapsed)), seen_ns_(system_()), at_ns_(elapsed_()) {}

  std::int64_t now() {
    const std::int64_t at = elapsed_();
    seen_ns_ = std::max(system_(), seen_ns_ + std::max<std::int64_t>(0, at - at_ns_));
    at_ns_ = at;
    return seen_ns_;
  }
  /// What an earlier run of the host had seen: time does not go back over a restart.
  void not_before(std::int64_t unix_ns) { seen_ns_ = std::max(seen_ns_, unix_ns); }

 private:
  Source system_;
  Source elapsed_;
  std::int64_t seen_ns_;
  std::int64_t at_ns_;  // elapsed_ when seen_ns_ was
};

}  // namespace slosh
