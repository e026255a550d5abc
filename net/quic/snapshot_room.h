// How many bytes may be under way before snapshots wait.
#pragma once

#include <algorithm>
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
/// router, and poses and states that come later stand behind them, or are dropped there. Snapshots stop at
/// what fills the way itself, delivery rate × shortest round trip, and a little more: a quarter as much again
/// while the link shows no queue, to find out that it carries more, and the less the longer its queue stands.
/// What stands is told from what dithers by the shortest of the last round trips: a radio's are short now and
/// then. Poses, states and streams may use the whole window.
class SnapshotRoom {
 public:
  /// Bytes in flight up to which snapshots may be sent.
  std::size_t limit(const PathFigures& path, std::int64_t now) {
    const double shortest = shortest_.note(path.latest_rtt, now);
    const double recent = recent_.note(path.latest_rtt, now, std::max(path.smoothed_rtt, kMinSpan));
    if (path.delivery_rate <= 0.0 || shortest >= ShortestRoundTrip::kNever) return kAtFirst * kMaxPacket;
    const double queue = std::max(0.0, recent - shortest);
    if (drain_.due(queue > kShows * shortest + kShowsSlack, path, shortest, now)) {
      more_ = 0.0;
      then_ = now;
      return 0;
    }
    const double wish = std::max(0.0, 1.0 - queue / (kQueueing * shortest + kSlack));
    // Only so fast, or it would swing: what is let out shows a round trip later.
    const double passed = 1e-9 * static_cast<double>(now - then_);
    then_ = now;
    more_ += (wish - more_) * std::min(1.0, passed / (kRoundTrips * std::max(path.smoothed_rtt, kMinSpan)));
    return static_cast<std::size_t>((1.0 + kGain * more_) * path.delivery_rate * shortest +
                                    (kFew + (kMax - kFew) * more_) * kMaxPacket);
  }

 private:
  static constexpr std::size_t kAtFirst = 16;  // packets while nothing is known
  static constexpr double kGain = 0.25;        // of what fills the way, beyond it, while no queue shows
  static constexpr double kFew = 4;            // packets beyond it: short ways, and a start from little
  static constexpr double kMax = 12;           // likewise while no queue shows

  // A queue of so much, of the shortest round trip and s beyond that, leaves nothing but kFew.
  static constexpr double kQueueing = 0.1;
  static constexpr double kSlack = 6e-3;
  // And so much is let run empty from time to time, or it would pass for a part of the way.
  static constexpr double kShows = 0.05;
  static constexpr double kShowsSlack = 2e-3;

  static constexpr double kMinSpan = 0.02;    // s
  static constexpr double kRoundTrips = 4.0;  // in which it follows

  ShortestRoundTrip shortest_;
  RecentRoundTrip recent_;
  QueueDrain drain_;
  double more_ = 1.0;  // 0–1
  std::int64_t then_ = 0;
};

}  // namespace slosh::quic
