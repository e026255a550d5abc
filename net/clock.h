// The steady clock both ends of a channel read, and sleeping on it until an absolute time.
#pragma once

#include <time.h>

#include <cerrno>
#include <cstdint>

namespace slosh {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

/// CLOCK_MONOTONIC, ns. Never goes back; its zero means nothing.
inline std::int64_t steady_now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * kNanosecondsPerSecond + now.tv_nsec;
}

/// Sleeps until the steady clock shows `deadline_ns`; returns at once when that has passed. A signal does
/// not cut the sleep short.
inline void sleep_until_ns(std::int64_t deadline_ns) {
  timespec until{};
  until.tv_sec = static_cast<time_t>(deadline_ns / kNanosecondsPerSecond);
  until.tv_nsec = static_cast<long>(deadline_ns % kNanosecondsPerSecond);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

inline double to_seconds(std::int64_t nanoseconds) {
  return 1e-9 * static_cast<double>(nanoseconds);
}
inline std::int64_t to_nanoseconds(double seconds) {
  return static_cast<std::int64_t>(seconds * 1e9);
}

}  // namespace slosh
