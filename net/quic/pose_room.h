// How many bytes a peer may have under way.
#pragma once

#include <cstddef>
#include <cstdint>

#include "net/quic/compat.h"
#include "net/quic/shortest_round_trip.h"
#include "net/quic/udp_socket.h"

namespace slosh::quic {

/// What a peer sends is little and steady: 500 datagrams of poses a second, 0.25 MB/s at most. Congestion
/// control is made for who fills a link: it stops a hand for 0.2 s to look at the round trip, and takes
/// random loss and overtaken packets for a full link. So a peer's window is wide, and this is what holds it
/// back: round trips that grow by more than their own length show that the link does not carry it, and then a
/// little more than what fills the way may be under way.
class PoseRoom {
 public:
  /// Bytes in flight up to which a peer may send; SIZE_MAX = the link shows no queue.
  std::size_t limit(const PathFigures& path, std::int64_t now) {
    const double shortest = shortest_.note(path.latest_rtt, now);
    if (shortest >= ShortestRoundTrip::kNever || path.smoothed_rtt <= kQueueing * shortest + kSlack)
      return SIZE_MAX;
    return static_cast<std::size_t>(kGain * path.delivery_rate * shortest) + kFew * kMaxPacket;
  }

 private:
  static constexpr double kQueueing = 2.0;  // of the shortest round trip
  static constexpr double kSlack = 0.02;    // s beyond that: a radio's dithering
  static constexpr double kGain = 1.5;
  static constexpr std::size_t kFew = 8;  // packets

  ShortestRoundTrip shortest_;
};

}  // namespace slosh::quic
