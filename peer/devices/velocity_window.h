// Velocity of a handle that only tells where it is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "net/clock.h"
#include "sim/math/pose.h"

namespace slosh {

/// The mean over the last kWindow s: an encoder's steps are some tens of µm, and one of them in a millisecond
/// would be a velocity of cm/s. Late by half of the window. One thread; no allocation.
class VelocityWindow {
 public:
  /// A pose read at `now_ns`, never falling.
  Twist add(const Pose& pose, std::int64_t now_ns) noexcept {
    if (count_ > 0 && to_seconds(now_ns - at(0).stamp_ns) > kLongest) count_ = 0;
    newest_ = (newest_ + 1) % kKept;
    entries_[newest_] = {pose, now_ns};
    if (count_ < kKept) count_ += 1;
    std::size_t back = count_ - 1;
    while (back > 1 && to_seconds(now_ns - at(back - 1).stamp_ns) >= kWindow) back -= 1;
    const double apart = to_seconds(now_ns - at(back).stamp_ns);
    if (back == 0 || apart <= 0.0) return {};
    const Pose& before = at(back).pose;
    return {(pose.position - before.position) / apart,
            rotation_between(before.orientation, pose.orientation) / apart};
  }
  void forget() noexcept { count_ = 0; }

  static constexpr double kWindow = 0.008;   ///< s
  static constexpr double kLongest = 0.050;  ///< s: a gap after which nothing is known

 private:
  struct Entry {
    Pose pose;
    std::int64_t stamp_ns = 0;
  };
  static constexpr std::size_t kKept = 32;
  const Entry& at(std::size_t back) const { return entries_[(newest_ + kKept - back) % kKept]; }

  std::array<Entry, kKept> entries_{};
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
};

}  // namespace slosh
