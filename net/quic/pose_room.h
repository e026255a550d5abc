// How many bytes of poses, or of states, may be under way.
#pragma once

#include <cstddef>
#include <cstdint>

#include "net/quic/compat.h"
#include "net/quic/queue_drain.h"
#include "net/quic/shortest_round_trip.h"
#include "net/quic/udp_socket.h"

namespace slosh::quic {

/// What a hand says, and what it must hear, is little and steady: 500 datagrams a second, 0.25 MB/s at most.
/// Congestion control is made for who fills a link: it stops a hand for 0.2 s to look at the round trip,
/// takes random loss and overtaken packets for a full link, and a link that stood for a second for one that
/// carries nothing. So the window is wide, and this is what holds poses and states back: round trips that
/// grow by more than their own length show that the link does not carry them, and then a little more than
/// what fills the way may be under way.
class PoseRoom {
 public:
  static constexpr std::size_t kOfPeer = 8;  ///< packets
  /// More than snapshots may have under way beyond what fills the way (snapshot_room.h): states go before
  /// them.
  static constexpr std::size_t kOfHost = 24;

  /// `few`: packets that may be under way beside what fills the way.
  explicit PoseRoom(std::size_t few) : few_(few) {}

  /// Bytes in flight up to which more may be sent; SIZE_MAX = the link shows no queue.
  std::size_t limit(const PathFigures& path, std::int64_t now) {
    const double shortest = shortest_.note(path.latest_rtt, now);
    const bool queueing =
        shortest < ShortestRoundTrip::kNever && path.smoothed_rtt > kQueueing * shortest + kSlack;
    if (drain_.due(queueing, path, shortest, now)) return 0;
    if (!queueing) return SIZE_MAX;
    return static_cast<std::size_t>(kGain * path.delivery_rate * shortest) + few_ * kMaxPacket;
  }

 private:
  static constexpr double kQueueing = 2.0;  // of the shortest round trip
  static constexpr double kSlack = 0.02;    // s beyond that: a radio's dithering
  static constexpr double kGain = 1.5;

  std::size_t few_;
  ShortestRoundTrip shortest_;
  QueueDrain drain_;
};

}  // namespace slosh::quic
