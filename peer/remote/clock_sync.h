// The host's steady clock as a peer reckons it, from pings: offset, drift and how far off both may be.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace slosh {

/// A correction is worked off at this speed at most: the reckoned clock then runs up to 0.5 % fast or slow.
constexpr double kMaxClockSlew = 0.005;

/// Four stamps a ping, as NTP has them. The delay there and the delay back cannot be told apart, so the
/// offset of a ping is off by half of what they differ by, at most by half of its round trip: of the pings of
/// the last seconds the one with the shortest is used. Reads no clock; one thread.
class ClockSync {
 public:
  /// One answered ping: sent and received on the peer's clock, in between on the host's, all ns. What cannot
  /// be (an answer before its ping, longer than 10 s on its way) is left out; false then.
  bool add(std::int64_t sent_ns, std::int64_t host_received_ns, std::int64_t host_sent_ns,
           std::int64_t received_ns);

  /// A new connection: its host may run on another clock. The mapping stays until pings disagree with it, and
  /// may step until kSettled of them came.
  void restart();

  /// Enough pings to go by.
  bool settled() const { return pings_ >= kSettled; }
  bool known() const { return known_; }

  /// Peer clock ↔ host clock, ns. Before the first ping both are the same.
  std::int64_t to_host(std::int64_t peer_ns) const;
  std::int64_t to_peer(std::int64_t host_ns) const;

  /// By how much to_host may be wrong at `peer_ns`, s: half the round trip of the ping in use, what the
  /// clocks may have drifted since, and what has not been worked off yet.
  double error_bound(std::int64_t peer_ns) const;
  double round_trip() const { return last_round_trip_; }  ///< s, of the newest ping
  double shortest_round_trip() const;                     ///< s, of those remembered
  double drift() const { return drift_; }                 ///< host seconds a peer second, less 1
  std::uint64_t steps() const { return steps_; }          ///< times that the mapping jumped once settled

  static constexpr int kSettled = 8;

 private:
  struct Sample {
    std::int64_t at_ns;      // peer's clock, received
    std::int64_t offset_ns;  // host − peer
    double round_trip;       // s
  };
  double cost(const Sample& sample, std::int64_t now_ns) const;
  double offset_from_base(const Sample& sample, std::int64_t now_ns) const;
  void estimate_drift();
  double mapped_offset(std::int64_t peer_ns) const;
  void step_to(const Sample& best);

  std::vector<Sample> recent_;  // newest last
  std::vector<Sample> coarse_;  // the best of each couple of seconds, for the drift
  Sample accepted_{};
  std::int64_t base_ns_ = 0;    // offsets are kept as doubles relative to this one
  std::int64_t anchor_ns_ = 0;  // peer's clock: the mapping is a line from here
  double anchor_offset_ = 0.0;  // s from base
  double correction_ = 0.0;     // s still to be worked off at the anchor
  double drift_ = 0.0;
  double last_round_trip_ = 0.0;
  int pings_ = 0;
  int contradictions_ = 0;
  bool known_ = false;
  std::uint64_t steps_ = 0;
};

/// When to send the next ping: a burst at the start, then a few a second.
class PingSchedule {
 public:
  void restart(std::int64_t now_ns) {
    sent_ = 0;
    due_ns_ = now_ns;
  }
  std::int64_t due_ns() const { return due_ns_; }
  void sent(std::int64_t now_ns) {
    sent_ += 1;
    due_ns_ = now_ns + (sent_ < kBurst ? kBurstGap_ns : kGap_ns);
  }

 private:
  static constexpr int kBurst = 10;
  static constexpr std::int64_t kBurstGap_ns = 20'000'000;
  static constexpr std::int64_t kGap_ns = 300'000'000;
  int sent_ = 0;
  std::int64_t due_ns_ = 0;
};

}  // namespace slosh
