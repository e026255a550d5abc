#include "peer/haptics/link_freshness.h"

#include <algorithm>
#include <cmath>

#include "net/clock.h"
#include "peer/haptics/freshness.h"

namespace slosh {
namespace {

/// s between two updates of a world that waits: a host repeats them ten times a second, and one may be lost.
constexpr double kStandingInterval = 0.05;
/// s by which poses may be later than usual before what they stretch counts as the link's, besides three
/// times what the lag usually varies by.
constexpr double kLatePose = 0.01;
constexpr double kSpread = 3.0;
/// s over which the usual lag and its spread are averaged.
constexpr double kLagMemory = 1.0;
/// s more than kHoldAnew that a silence lasts at least, so that a host cannot have missed it.
constexpr double kSureSilence = 0.03;

}  // namespace

double LinkFreshness::follow_poses(const BodyMessage& message, bool& current) noexcept {
  if (message.heard_pose_ns == kPoseNotTold) return 1.0;
  if (resuming_) {
    if (message.heard_pose_ns < since_ns_) {
      current = false;
      return 0.0;
    }
    resuming_ = usual_known_ = false;
  }
  // A host that has not received us yet may never do so: no force begins before it has, so that none is left
  // to end.
  if (message.heard_pose_ns <= 0) {
    current = false;
    return 0.0;
  }
  const double lag = to_seconds(message.stamp_ns - message.heard_pose_ns);
  if (!usual_known_) {
    usual_lag_ = lag;
    lag_spread_ = 0.0;
    usual_known_ = true;
  }
  // A silence is no measure of itself: what is usual is as it was when a pose was last received.
  if (message.heard_pose_ns != followed_ns_) {
    followed_ns_ = message.heard_pose_ns;
    latest_ = usual_lag_ + kSpread * lag_spread_;
  }
  const double late = lag - latest_;
  if (late > kLatePose) current = false;
  if (late < kHoldStale) {  // beyond, it is a silence and says nothing of what is usual
    const double share = period_ / kLagMemory;
    lag_spread_ += share * (std::abs(lag - usual_lag_) - lag_spread_);
    usual_lag_ += share * (lag - usual_lag_);
  }
  return freshness(late, period_, latest_);
}

double LinkFreshness::stopped_share(std::int64_t now_ns) noexcept {
  if (stopped_ns_ == 0) stopped_ns_ = now_ns;
  return std::max(running_share_ - to_seconds(now_ns - stopped_ns_) / kFadeStale, 0.0);
}

/// What we said before the silence may have been kept back with it: ours counts from when the link is back.
void LinkFreshness::turn_to_speak(bool heard, std::int64_t now_ns) noexcept {
  if (!heard) {
    speaks_ = false;
    again_ns_ = 0;
  } else if (!speaks_) {
    if (again_ns_ == 0) again_ns_ = now_ns;
    if (to_seconds(now_ns - again_ns_) < kHoldAnew + kSureSilence) return;
    speaks_ = resuming_ = true;
    since_ns_ = now_ns;
  }
}

StateFreshness LinkFreshness::update(const BodyMessage& message, bool fresh, std::int64_t now_ns) noexcept {
  if (fresh || !ticked_) heard_ns_ = now_ns;
  StateFreshness found;
  found.anew = ticked_ && message.run != run_;
  run_ = message.run;
  ticked_ = true;
  const double since_heard = to_seconds(now_ns - heard_ns_);
  if (message.rate <= 0.0) {
    const double share = freshness(since_heard, kStandingInterval);
    // After the first step a pace of 0 means that the world stopped: it holds nothing up any more. Before it
    // no world far away follows anybody's poses.
    const bool waits_here = message.bodies.tick == 0 && message.heard_pose_ns == kPoseNotTold;
    found.share = waits_here ? share : std::min(share, stopped_share(now_ns));
    found.current = waits_here && found.share >= 1.0;
    turn_to_speak(share >= 1.0, now_ns);
    return found;
  }
  stopped_ns_ = 0;
  const double age = to_seconds(now_ns - message.stamp_ns);  // negative while the state is still to come
  const double interval = message.time_step / message.rate;
  // What it takes one way is a half of what it takes both.
  const double way = 0.5 * latest_;
  const double states = std::min(freshness(age, interval, way), freshness(since_heard, interval, way));
  turn_to_speak(states >= 1.0, now_ns);
  found.current = age <= 2.0 * interval + period_;
  found.resumed = fresh && late_;
  late_ = !found.current;
  found.share = running_share_ = std::min(states, follow_poses(message, found.current));
  return found;
}

}  // namespace slosh
