#include "host/input_gate.h"

#include <algorithm>
#include <cmath>

#include "net/leap.h"

namespace slosh {
namespace {

// s of simulated time over which a pose is carried on by its own twist to the start of a step.
constexpr double kMostCarried = kYieldAfter;
// s of wall time for which what a hand carries is what it carried in its last step: poses come each 2 ms.
constexpr double kCarriedAfter = 0.005;

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
    hand.gains =
        hand.of_scene = {grip.stiffness, grip.damping, grip.rotational_stiffness, grip.rotational_damping};
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
    if (hand.has_good && hand.good.engaged) {
      hand.lost_at = time_;
      hand.lost_scale = hand.scale;
      hand.lost_fade = shared(hand) ? kHandOver : kLostFade;
    }
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
  if (hand.anew || hand.silent || leap || hand.good.hold != message.hold) hand.engagement = Engagement{};
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
    hand.anew = true;
  }
}

void InputGate::stood_still() {
  for (Hand& hand : hands_) hand.engagement = Engagement{};
}

// The coupling weakens where the hand was last, at rest; whoever is heard does not pull against it.
void InputGate::fade(Hand& hand, HandleInput& input, const GripState& grip, double time,
                     std::int64_t clock_ns) {
  const double left = 1.0 - (time - hand.lost_at) / hand.lost_fade;
  input.engaged = left > 0.0;
  input.scale = input.engaged ? hand.lost_scale * left : 0.0;
  input.pose = hand.last_held;
  input.twist = Twist{};
  if (!input.engaged) {
    hand.lost_scale = 0.0;
  } else if (another_holds(hand, clock_ns)) {
    give_way(hand, input, grip);
    hand.last_held = input.pose;
  }
}

/// Whether somebody who is heard holds the same body.
bool InputGate::another_holds(const Hand& hand, std::int64_t clock_ns) const {
  return std::any_of(hands_.begin(), hands_.end(), [&](const Hand& other) {
    return &other != &hand && other.body == hand.body && other.has_good && other.good.engaged &&
           clock_ns - other.received_ns <= to_nanoseconds(kYieldAfter);
  });
}

/// Whether somebody else holds the same body, heard or not.
bool InputGate::shared(const Hand& hand) const {
  return std::any_of(hands_.begin(), hands_.end(), [&](const Hand& other) {
    return &other != &hand && other.body == hand.body && other.has_good && other.good.engaged;
  });
}

/// Moves the place where a silent hand holds, with the grip and so far that the springs give no more than
/// kYield… besides what the hand carried.
void InputGate::give_way(Hand& hand, HandleInput& input, const GripState& grip) const {
  const CouplingGains& gains = hand.gains;
  input.twist = grip.twist;  // the dampers drag at nobody
  if (gains.stiffness > 0.0) {
    const glm::dvec3 more = gains.stiffness * (grip.pose.position - input.pose.position) - hand.carried.force;
    const double length = glm::length(more);
    if (length > kYieldForce) {
      const glm::dvec3 way = more * ((length - kYieldForce) / (length * gains.stiffness));
      input.pose.position += way;
      hand.good.pose.position += way;
    }
  }
  if (gains.rotational_stiffness > 0.0) {
    const glm::dvec3 more =
        gains.rotational_stiffness * rotation_between(input.pose.orientation, grip.pose.orientation) -
        hand.carried.torque;
    const double length = glm::length(more);
    if (length > kYieldTorque) {
      const glm::dvec3 way = more * ((length - kYieldTorque) / (length * gains.rotational_stiffness));
      input.pose.orientation = rotate_by(input.pose.orientation, way);
      hand.good.pose.orientation = rotate_by(hand.good.pose.orientation, way);
    }
  }
}

void InputGate::fill_input(Hand& hand, std::size_t grip, const BodySnapshot& now, std::int64_t clock_ns) {
  HandleInput& input = inputs_[grip];
  // The pose was read a little before or after the moment that this step starts from.
  const double late = std::clamp(now.time - hand.good.time, -kMostCarried, kMostCarried);
  input.pose = extrapolate(hand.good.pose, hand.good.twist, late);
  if (clock_ns - hand.received_ns > to_nanoseconds(kStaleTwist)) {
    // From here on it goes with the world's time. At once at rest, it would stop a body that swings with a
    // blow.
    hand.good.pose = input.pose;
    hand.good.time = now.time;
    const double left = std::exp(-step_ / kRunOut);
    hand.good.twist = {left * hand.good.twist.linear, left * hand.good.twist.angular};
  }
  input.engaged = hand.has_good && hand.good.engaged;
  const GripState nowhere{input.pose, hand.good.twist, input.pose, {}};
  const Engagement::Held held =
      hand.engagement.update(input.engaged, now.time, input.pose, hand.good.twist, hand.gains,
                             grip < now.grips.size() ? now.grips[grip] : nowhere, shared(hand));
  input.pose = held.pose;
  input.twist = held.twist;
  input.scale = input.engaged ? 1.0 : 0.0;
  if (grip < now.grips.size() && input.engaged) {
    const double since = to_seconds(clock_ns - hand.received_ns);
    if (since <= kCarriedAfter) hand.carried = now.grips[grip].on_hand;
    if (since > kYieldAfter && another_holds(hand, clock_ns)) {
      give_way(hand, input, now.grips[grip]);
    }
  }
  if (input.engaged) hand.last_held = input.pose;
  if (!input.engaged && hand.lost_scale > 0.0) {
    fade(hand, input, grip < now.grips.size() ? now.grips[grip] : nowhere, now.time, clock_ns);
  }
  hand.scale = input.scale;
}

std::span<const HandleInput> InputGate::take(Channel& channel, const BodySnapshot& now,
                                             std::int64_t clock_ns) {
  step_ = std::clamp(now.time - time_, 0.0, kMostCarried);
  time_ = now.time;
  std::fill(refused_.begin(), refused_.end(), PoseFault::kNone);
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
