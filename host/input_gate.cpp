#include "host/input_gate.h"

#include <algorithm>
#include <cmath>

#include "net/leap.h"

namespace slosh {
namespace {

// s of simulated time over which a pose is carried on by its own twist to the start of a step.
constexpr double kMaxCarried = kYieldAfter;
// s of wall time for which what a hand carries is what it carried in its last step: poses come each 2 ms.
constexpr double kCarriedAfter = 0.005;
// A step that comes so much later than steps usually do, s of wall time and times the usual interval, finds
// hands elsewhere though no time has passed in the world: they re-engage.
constexpr double kStoodStill = 0.02;
constexpr double kStoodIntervals = 3.0;
constexpr double kIntervalShare = 0.1;  // of a new interval in the usual one

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool finite(const PoseMessage& m) {
  const glm::dquat& q = m.pose.orientation;
  return finite(m.pose.position) && finite(m.twist.linear) && finite(m.twist.angular) && std::isfinite(q.w) &&
         std::isfinite(m.time) && std::isfinite(m.energy) && finite(glm::dvec3(q.x, q.y, q.z));
}

}  // namespace

InputGate::InputGate(const Scene& scene)
    : reach_min_(lowest_handle(scene.domain_min)), reach_max_(highest_handle(scene.domain_max)) {
  for (const Grip& grip : scene.grips) {
    Hand hand;
    hand.body = grip.body;
    hand.gains = {grip.stiffness, grip.damping, grip.rotational_stiffness, grip.rotational_damping};
    hands_.push_back(hand);
  }
  inputs_.resize(hands_.size());
  used_.resize(hands_.size());
  refused_.resize(hands_.size());
  for (std::size_t i = 0; i < used_.size(); ++i) used_[i].device = static_cast<std::uint32_t>(i);
}

PoseFault InputGate::check(const PoseMessage& message, const Hand& hand) const {
  if (!finite(message)) return PoseFault::kNonFinite;
  if (std::abs(glm::length(message.pose.orientation) - 1.0) > 0.01) return PoseFault::kNotARotation;
  const glm::dvec3& p = message.pose.position;
  if (glm::any(glm::lessThan(p, reach_min_)) || glm::any(glm::greaterThan(p, reach_max_))) {
    return PoseFault::kOutOfRange;
  }
  if (glm::length(message.twist.linear) > kHandleSpeed ||
      glm::length(message.twist.angular) > kHandleAngularSpeed) {
    return PoseFault::kTooFast;
  }
  const bool same_hand = hand.has_good && !hand.anew && hand.good.hold == message.hold;
  if (same_hand && hand.good.engaged && message.engaged) {
    // The longer the last good pose is ago, the farther the hand may honestly be: a jump is not refused for
    // ever.
    const double elapsed = std::max(to_seconds(message.stamp_ns - hand.good.stamp_ns), 0.001);
    if (glm::length(p - hand.good.pose.position) > kHandleSpeed * elapsed + 0.01) return PoseFault::kTooFast;
  }
  return PoseFault::kNone;
}

bool InputGate::accept(const PoseMessage& message, std::int64_t clock_ns) {
  if (message.device >= hands_.size()) {
    rejected_ += 1;
    return false;
  }
  Hand& hand = hands_[message.device];
  const PoseFault fault = check(message, hand);
  if (fault != PoseFault::kNone) {
    last_fault_ = refused_[message.device] = fault;
    rejected_ += 1;
    hand.good.twist = Twist{};  // a pose that is no longer known to move must not be carried on
    return false;
  }
  // Times of the run before a reset are ahead of those of the new one.
  constexpr double kAhead = 0.1;
  if (clock_ns < old_run_until_ns_ && message.time > time_ + kAhead) return false;
  if (message.lost && !message.engaged) {
    const bool held = hand.has_good && hand.good.engaged;
    // A stand that ended before a step has seen it, as in a world that waits, held all the same.
    const bool stood = message.stand && !(hand.has_good && hand.good.lost);
    if (held || stood) {
      const bool hands_over = stood || company(hand, clock_ns) != Company::kAlone;
      begin_fade(hand, held ? hand.scale : 1.0, hands_over ? kHandOver : kLostFade);
    }
    if (stood && !held) hand.last_pose = hand.last_held = message.pose;
  } else {
    hand.lost_scale = 0.0;
  }
  // Where the hand is after a reset is where it was before; the body is elsewhere. After a silence, or when
  // it is another hand, it is the other way round.
  // One that is suddenly elsewhere is no better. Samples that a link kept back come at once: what counts is
  // the shorter of the times between their readings and between their coming.
  const double elapsed =
      to_seconds(std::min(message.stamp_ns - hand.good.stamp_ns, clock_ns - hand.received_ns));
  const double speed = std::max(glm::length(message.twist.linear), glm::length(hand.good.twist.linear));
  const bool leap = hand.has_good && leapt(hand.good.pose.position, message.pose.position, speed, elapsed);
  // A host that stood still itself has not seen the silence.
  const bool silent = hand.silent || clock_ns - hand.received_ns > to_nanoseconds(kHoldAnew);
  const bool anew = hand.anew || silent || leap || hand.good.hold != message.hold;
  if (anew && !message.lost) hand.engagement.take_hold_anew();
  hand.anew = hand.silent = false;
  hand.good = message;
  hand.good.pose.orientation = glm::normalize(message.pose.orientation);
  hand.has_good = true;
  hand.received_ns = clock_ns;
  used_[message.device] = hand.good;
  return true;
}

void InputGate::reset(const BodySnapshot& now, std::int64_t clock_ns) {
  old_run_until_ns_ = clock_ns + to_nanoseconds(kOldRun);
  time_ = now.time;
  for (std::size_t i = 0; i < hands_.size() && i < now.grips.size(); ++i) {
    Hand& hand = hands_[i];
    const GripState& grip = now.grips[i];
    const bool settled = glm::length(grip.on_hand.force) + glm::length(grip.on_hand.torque) > 0.0;
    hand.good.pose = settled ? grip.handle : grip.pose;
    hand.good.twist = Twist{};
    hand.good.time = now.time;
    hand.received_ns = clock_ns;
    hand.engagement = Engagement{};
    hand.lost_scale = 0.0;
    // The start was settled into all hands: one that is not there now gives its share over, as a stand does.
    if (settled && !hand.good.engaged) {
      begin_fade(hand, 1.0, kHandOver);
      hand.last_pose = hand.last_held = hand.good.pose;
    }
    hand.anew = true;
  }
}

void InputGate::stood_still() {
  for (Hand& hand : hands_) hand.engagement.take_hold_anew();
}

/// Who else holds the body of a hand that holds on. A stand is nobody.
Company InputGate::company(const Hand& hand, std::int64_t clock_ns) const {
  const auto fresh = [&](const Hand& of) {
    return of.good.engaged && clock_ns - of.received_ns <= to_nanoseconds(kYieldAfter);
  };
  Company found = Company::kAlone;
  for (const Hand& other : hands_) {
    if (&other == &hand || other.body != hand.body || !other.has_good || !other.good.engaged ||
        other.good.stand)
      continue;
    if (fresh(other) && !fresh(hand)) return Company::kSilent;
    found = Company::kShared;
  }
  return found;
}

void InputGate::begin_fade(Hand& hand, double scale, double seconds) const {
  hand.lost_at = time_;
  hand.lost_scale = scale;
  hand.lost_fade = seconds;
}

/// Simulated s that a hand which was lost goes on holding, as a share of what it has for that.
double InputGate::left_to_fade(const Hand& hand) const {
  if (hand.good.engaged || hand.lost_scale <= 0.0) return 0.0;
  return std::max(1.0 - (time_ - hand.lost_at) / hand.lost_fade, 0.0);
}

void InputGate::fill_input(Hand& hand, std::size_t grip, const BodySnapshot& now, std::int64_t clock_ns) {
  HandleInput& input = inputs_[grip];
  // The pose was read a little before or after the moment that this step starts from.
  const double late = std::clamp(now.time - hand.good.time, -kMaxCarried, kMaxCarried);
  Pose pose = extrapolate(hand.good.pose, hand.good.twist, late);
  const double since = to_seconds(clock_ns - hand.received_ns);
  if (since > kStaleTwist) {
    // From here on it goes with the world's time. At once at rest, it would stop a body that swings with a
    // blow.
    hand.good.pose = pose;
    hand.good.time = now.time;
    const double left = std::exp(-step_ / kRunOut);
    hand.good.twist = {left * hand.good.twist.linear, left * hand.good.twist.angular};
  }
  const double fading = left_to_fade(hand);
  const bool engaged = hand.has_good && hand.good.engaged;
  if (fading > 0.0) {
    // The coupling weakens where the hand was last, at rest; hands whose updates come do not pull against it.
    pose = hand.last_pose;
    hand.good.twist = Twist{};
  }
  const GripState nowhere{pose, hand.good.twist, pose, {}, 0.0};
  const GripState& state = grip < now.grips.size() ? now.grips[grip] : nowhere;
  // Who holds what is away takes hold of it when it comes, where it is by then.
  if (is_away(state.pose)) {
    (void)hand.engagement.update(false, now.time, pose, hand.good.twist, hand.gains, state);
    hand.lost_scale = 0.0;
    input = {pose, {}, false, 0.0};
    return;
  }
  const Company others = company(hand, clock_ns);
  if (engaged && (since <= kCarriedAfter || (since > kYieldAfter && others != Company::kSilent)))
    hand.engagement.carries(state.on_hand);
  const CouplingGains gains = state.stiffness > 0.0 ? stiffened(hand.gains, state.stiffness) : hand.gains;
  Engagement::Held held{hand.last_held, {}};
  if (fading <= 0.0 || others == Company::kSilent)
    held = hand.engagement.update(engaged || fading > 0.0, now.time, pose, hand.good.twist, gains, state,
                                  others);
  input = {held.pose, held.twist, engaged || fading > 0.0, engaged ? 1.0 : fading * hand.lost_scale};
  if (input.engaged) hand.last_held = held.pose;
  if (engaged) hand.last_pose = pose;
  if (engaged || fading <= 0.0) hand.scale = input.scale;
}

void InputGate::note_interval(std::int64_t clock_ns) {
  const double interval = to_seconds(clock_ns - taken_ns_);
  const bool first = taken_ns_ == 0;
  taken_ns_ = clock_ns;
  if (first) return;
  if (usual_interval_ > 0.0 && interval > kStoodStill + kStoodIntervals * usual_interval_)
    return stood_still();
  usual_interval_ += (usual_interval_ > 0.0 ? kIntervalShare : 1.0) * (interval - usual_interval_);
}

std::span<const HandleInput> InputGate::take(Channel& channel, const BodySnapshot& now,
                                             std::int64_t clock_ns) {
  step_ = std::clamp(now.time - time_, 0.0, kMaxCarried);
  time_ = now.time;
  std::fill(refused_.begin(), refused_.end(), PoseFault::kNone);
  note_interval(clock_ns);
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    if (i < channel.devices() && channel.pose(i).update())
      accept(channel.pose(i).front(), clock_ns);
    else if (clock_ns - hands_[i].received_ns > to_nanoseconds(kHoldAnew))
      hands_[i].silent = true;
    fill_input(hands_[i], i, now, clock_ns);
  }
  return inputs_;
}

}  // namespace slosh
