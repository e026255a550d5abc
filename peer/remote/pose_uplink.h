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
  /// `agreed`: with the host.
  SharedBytes make(const std::vector<bool>& held, wire::Capabilities agreed = wire::kOurCapabilities);

  /// Fills in when the readings were read that `state` answers to, of the hands `held` (HandWord::read_ns and
  /// time).
  void resolve(BodyMessage& state, const std::vector<bool>& held) const;

  std::uint64_t numbered() const { return numbered_; }  ///< distinct samples sent so far

 private:
  struct Reading {
    std::uint64_t number = 0;  ///< 0 = not known, or too long ago
    std::int64_t stamp_ns = 0;
    double time = 0.0;  ///< PoseMessage::time
  };
  Reading reading(std::size_t grip, std::uint64_t number) const;

  static constexpr std::size_t kRemembered = 1024;  // 2 s at 500 a second
  struct Hand {
    std::uint64_t next = 1;
    std::int64_t last_stamp_ns = 0;
    std::deque<wire::PoseSample> last;                               // newest first, at most kPoseSends
    std::vector<Reading> known = std::vector<Reading>(kRemembered);  // a ring by number
  };
  Channel& channel_;
  std::vector<Hand> hands_;
  std::uint64_t numbered_ = 0;
};

}  // namespace slosh
