// When to let a link's queue run empty, to see how long the way is without it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "net/quic/compat.h"

namespace slosh::quic {

/// A room that is a little larger than the way keeps a little in the router's queue, for good: what then
/// looks like the shortest round trip has that queue in it, the room grows by it, and so does the queue. So
/// when a queue has shown for a few seconds next to nothing is sent until it is gone.
class QueueDrain {
 public:
  /// Whether now is that time. `queueing`: round trips are longer than `shortest`, s; `now` in ns.
  bool due(bool queueing, const PathFigures& path, double shortest, std::int64_t now) {
    if (!queueing) {
      began_ = now;
      until_ = 0;
    } else if (now - began_ > kEvery) {
      began_ = now;
      until_ = now + static_cast<std::int64_t>(1e9 * std::min(kRoundTrips * path.smoothed_rtt, kLongest));
    }
    // By the shortest that there ever was: the last seconds' has a queue in it that was not let run empty.
    const double way = path.min_rtt > 0.0 ? std::min(shortest, path.min_rtt) : shortest;
    if (path.latest_rtt <= kGone * way) until_ = 0;
    return now < until_;
  }

 private:
  // ns that a queue shows before it is let run empty: twice in ShortestRoundTrip's span.
  static constexpr std::int64_t kEvery = 3'000'000'000;
  static constexpr double kRoundTrips = 2.5;
  static constexpr double kLongest = 1.2;  // s
  static constexpr double kGone = 1.05;    // of the shortest round trip

  std::int64_t began_ = 0;
  std::int64_t until_ = 0;
};

}  // namespace slosh::quic
