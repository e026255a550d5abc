// How many bytes may be under way before snapshots wait.
#pragma once

#include <algorithm>
#include <cstdint>

#include "net/quic/compat.h"
#include "net/quic/udp_socket.h"

namespace slosh::quic {

/// Keeps snapshots from filling the link's queues.
///
/// Congestion control lets two round trips' worth of bytes out; on a full link half of them stand in some
/// router, and poses and states that come later stand behind them. Snapshots stop at a little more than what
/// fills the way itself: delivery rate × shortest round trip. Poses, states and streams may use the whole
/// window.
class SnapshotRoom {
 public:
  /// Bytes in flight up to which snapshots may be sent; SIZE_MAX = nothing is known of the link yet.
  std::size_t limit(const PathFigures& path, std::int64_t now) {
    if (path.latest_rtt > 0.0) note(path.latest_rtt, now);
    const double shortest = std::min(this_, last_);
    if (path.delivery_rate <= 0.0 || shortest >= kNever) return SIZE_MAX;
    return static_cast<std::size_t>(kGain * path.delivery_rate * shortest) + kFew * kMaxPacket;
  }

 private:
  static constexpr double kGain = 1.5;                  // room to find out that the link carries more
  static constexpr std::size_t kFew = 16;               // packets: short ways, and a start from little
  static constexpr std::int64_t kSpan = 6'000'000'000;  // ns; BBR empties the queues every 5 s
  static constexpr double kNever = 1e9;

  /// The shortest round trip of the last one to two spans: ways may grow longer.
  void note(double rtt, std::int64_t now) {
    if (now - began_ > kSpan) {
      last_ = this_;
      this_ = kNever;
      began_ = now;
    }
    this_ = std::min(this_, rtt);
  }

  double this_ = kNever;  // s
  double last_ = kNever;
  std::int64_t began_ = 0;
};

}  // namespace slosh::quic
