// Poses on their way up: the newest of each hand, numbered, with the last few again in case they were lost.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "net/channel.h"
#include "net/quic/endpoint.h"
#include "net/wire/messages.h"

namespace slosh {

/// Between two datagrams of poses, ns: 500 Hz, half of what the device loop reads, and about a step of the
/// world.
constexpr std::int64_t kPoseGap_ns = 2'000'000;
/// How often a sample is sent in all. Three losses on end at 5 % each are one in 8 000.
constexpr std::size_t kPoseSends = 4;

/// Reads the channel's poses: belongs to the network's thread.
class PoseUplink {
 public:
  explicit PoseUplink(Channel& channel) : channel_(channel), hands_(channel.devices()) {}

  /// One datagram of at most wire::kMaxDatagram bytes with what is new of the hands `held`, or null when
  /// nothing is. A reading gets a number of its own, rising by one a grip; repeats keep theirs.
  SharedBytes make(const std::vector<bool>& held);

  std::uint64_t numbered() const { return numbered_; }  ///< distinct samples sent so far

 private:
  struct Hand {
    std::uint64_t next = 1;
    std::int64_t last_stamp_ns = 0;
    std::deque<wire::PoseSample> last;  // newest first, at most kPoseSends
  };
  Channel& channel_;
  std::vector<Hand> hands_;
  std::uint64_t numbered_ = 0;
};

}  // namespace slosh
