// How much faster than the library's pace a connection may send.
#pragma once

#include <algorithm>
#include <cstdint>

#include "net/quic/compat.h"

namespace slosh::quic {

/// Raises the pace while something waits for it and the link shows room.
///
/// ngtcp2 0.12's BBR takes what it delivered in the last few rounds for what the link can carry, also when
/// there was little to send (RFC draft-cheng-iccrg-delivery-rate-estimation's "application-limited" is not
/// written there). What random loss takes from the delivered bytes it takes from the next rounds' pace, and
/// at one packet a round trip its probing by a quarter shows nothing: it stays there. The round trip time
/// knows better: a link with room answers as fast as it ever did.
class PaceGain {
 public:
  static constexpr double kMax = 4.0;

  double factor() const { return factor_; }

  /// What a flush saw; acts once a round trip. `waiting`: something is left that the window would let
  /// through. `sent`, `lost`: datagrams so far.
  void note(const PathFigures& path, bool waiting, std::uint64_t sent, std::uint64_t lost, std::int64_t now) {
    waited_ |= waiting;
    if (path.smoothed_rtt <= 0.0 || now - round_ns_ < static_cast<std::int64_t>(1e9 * path.smoothed_rtt))
      return;
    round_ns_ = now;
    if (sent - sent_ >= kFewDatagrams) {
      lossy_ = static_cast<double>(lost - lost_) > kHeavyLoss * static_cast<double>(sent - sent_);
      sent_ = sent;
      lost_ = lost;
    }
    const bool queueing = path.smoothed_rtt > kQueueing * path.min_rtt + kSlack;
    if (queueing || lossy_)
      factor_ = std::max(1.0, kDown * factor_);
    else if (waited_)
      factor_ = std::min(kMax, kUp * factor_);
    waited_ = false;
  }

 private:
  static constexpr double kUp = 1.25;         // a round trip
  static constexpr double kDown = 0.7;        // a round trip
  static constexpr double kQueueing = 1.25;   // of the shortest round trip
  static constexpr double kSlack = 8e-3;      // s beyond that: acknowledgements are late, Wi-Fi dithers
  static constexpr double kHeavyLoss = 0.15;  // share; a link that drops rather than queues when it is full
  static constexpr std::uint64_t kFewDatagrams = 32;

  double factor_ = 1.0;
  bool waited_ = false;
  bool lossy_ = false;
  std::uint64_t sent_ = 0;
  std::uint64_t lost_ = 0;
  std::int64_t round_ns_ = 0;
};

}  // namespace slosh::quic
