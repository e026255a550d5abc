// How many bytes may be under way before snapshots wait.
#pragma once

#include <cstddef>
#include <cstdint>

#include "net/quic/compat.h"
#include "net/quic/queue_drain.h"
#include "net/quic/shortest_round_trip.h"
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
  /// Bytes in flight up to which snapshots may be sent.
  std::size_t limit(const PathFigures& path, std::int64_t now) {
    const double shortest = shortest_.note(path.latest_rtt, now);
    if (path.delivery_rate <= 0.0 || shortest >= ShortestRoundTrip::kNever) return kFew * kMaxPacket;
    if (drain_.due(path.smoothed_rtt > kQueueing * shortest + kSlack, path, shortest, now)) return 0;
    return static_cast<std::size_t>(kGain * path.delivery_rate * shortest) + kFew * kMaxPacket;
  }

 private:
  static constexpr double kGain = 1.5;     // room to find out that the link carries more
  static constexpr std::size_t kFew = 16;  // packets: short ways, and a start from little

  static constexpr double kQueueing = 1.25;  // of the shortest round trip
  static constexpr double kSlack = 8e-3;     // s beyond that: acknowledgements are late

  ShortestRoundTrip shortest_;
  QueueDrain drain_;
};

}  // namespace slosh::quic
