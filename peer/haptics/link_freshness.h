// Staleness of the link in both directions: how far a device loop may use body states, and when it sends
// poses.
#pragma once

#include <cstdint>

#include "net/channel.h"

namespace slosh {

/// What the loop makes of the newest body state.
struct StateFreshness {
  double share = 0.0;    ///< 0–1, by how long ago it came, or by how long ago the world stopped
  bool current = false;  ///< no later than a world at its pace would have it
  bool resumed = false;  ///< the state came after the one before had been late
  bool anew = false;     ///< the world was reset: hands that hold on re-engage
};

/// Body states come one way and poses go the other, and each may fail alone.
///  - States that are late count by freshness(); those of a world in this process that waits for its first
///    step, as long as it says so; those of one that waits far away, not at all.
///  - A world that stops (a pause, its end) takes the force away over kFadeStale, as a silence does: an arm
///    that carries a weight springs up where that goes faster, and pulls up with it what it holds when the
///    world goes on.
///  - No state counts before the first that follows a pose of ours: on a link that takes a round trip, and
///    until then a host that never receives us looks like one that is far away.
///  - States that no longer follow our poses come from a host that does not receive them: the body stands
///    where our hand was, and a spring to it would be the link's. Late poses count as late states do.
///  - Without states no poses are sent. So the host takes the hand for silent too, and when contact is back
///    both ends re-engage (net/engagement.h), the loop when the host has.
/// Reads no clock; one thread; no allocation.
class LinkFreshness {
 public:
  explicit LinkFreshness(double period) : period_(period) {}

  /// Once a tick, with the newest state and whether it came since the tick before.
  StateFreshness update(const BodyMessage& message, bool fresh, std::int64_t now_ns) noexcept;

  /// Whether poses are to be sent in this tick. After update().
  bool speaks() const { return speaks_; }

 private:
  double stopped_share(std::int64_t now_ns) noexcept;
  double follow_poses(const BodyMessage& message, bool& current) noexcept;
  void turn_to_speak(bool heard, std::int64_t now_ns) noexcept;

  double period_;
  bool ticked_ = false;
  bool late_ = false;            // the newest state was, at the call before
  double running_share_ = 0.0;   // with the last state of a world that ran
  std::int64_t stopped_ns_ = 0;  // since when it does not; 0 = it runs
  std::uint32_t run_ = 0;
  std::int64_t heard_ns_ = 0;  // when the newest state came
  bool speaks_ = true;
  bool resuming_ = false;      // sends again, and the host has not answered yet
  std::int64_t again_ns_ = 0;  // when states came again after a silence; 0 = none did
  std::int64_t since_ns_ = 0;  // when it sent first after it
  double usual_lag_ = 0.0;     // s from our pose to a state that follows it, with the state's own delay
  double lag_spread_ = 0.0;    // s, its mean deviation
  bool usual_known_ = false;
  std::int64_t followed_ns_ = 0;  // the newest pose of ours that a state followed
  double latest_ = 0.0;           // s, the usual lag and what it varies by as they were then
};

}  // namespace slosh
