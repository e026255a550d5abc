#include "host/input_gate.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

// s of simulated time over which a pose is carried on by its own twist to the start of a step.
constexpr double kMostCarried = 0.01;

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool finite(const PoseMessage& m) {
  const glm::dquat& q = m.pose.orientation;
  return finite(m.pose.position) && finite(m.twist.linear) && finite(m.twist.angular) && std::isfinite(q.w) &&
         std::isfinite(m.time) && finite(glm::dvec3(q.x, q.y, q.z));
}

}  // namespace

InputGate::InputGate(const Scene& scene)
    : reach_min_(scene.domain_min - kHandleReach), reach_max_(scene.domain_max + kHandleReach) {
  for (const Grip& grip : scene.grips) {
    Hand hand;
    hand.gains = {grip.stiffness, grip.damping, grip.rotational_stiffness, grip.rotational_damping};
    hands_.push_back(hand);
  }
  inputs_.resize(hands_.size());
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
  if (hand.has_good && hand.good.engaged && message.engaged) {
    // The longer the last good pose is ago, the farther the hand may honestly be: a jump is not refused for
    // ever.
    const double elapsed = std::max(to_seconds(message.stamp_ns - hand.good.stamp_ns), 0.001);
    if (glm::length(p - hand.good.pose.position) > kHandleSpeed * elapsed + 0.01) return PoseFault::kTooFast;
  }
  return PoseFault::kNone;
}

bool InputGate::accept(const PoseMessage& message) {
  if (message.device >= hands_.size()) {
    rejected_ += 1;
    return false;
  }
  Hand& hand = hands_[message.device];
  const PoseFault fault = check(message, hand);
  if (fault != PoseFault::kNone) {
    last_fault_ = fault;
    rejected_ += 1;
    hand.good.twist = Twist{};  // a pose that is no longer known to move must not be carried on
    return false;
  }
  hand.good = message;
  hand.good.pose.orientation = glm::normalize(message.pose.orientation);
  hand.has_good = true;
  return true;
}

std::span<const HandleInput> InputGate::take(Channel& channel, const BodySnapshot& now) {
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    Hand& hand = hands_[i];
    if (i < channel.devices() && channel.pose(i).update()) accept(channel.pose(i).front());
    HandleInput& input = inputs_[i];
    // The pose was read a little before or after the moment that this step starts from.
    const double late = std::clamp(now.time - hand.good.time, -kMostCarried, kMostCarried);
    input.pose = extrapolate(hand.good.pose, hand.good.twist, late);
    input.twist = hand.good.twist;
    input.engaged = hand.has_good && hand.good.engaged;
    double force = 0.0;
    double torque = 0.0;
    if (input.engaged && !hand.engagement.engaged() && i < now.grips.size()) {
      const Wrench full =
          coupling_wrench_on_hand(hand.gains, input.pose, input.twist, now.grips[i].pose, now.grips[i].twist);
      force = glm::length(full.force - now.grips[i].on_hand.force);
      torque = glm::length(full.torque - now.grips[i].on_hand.torque);
    }
    input.scale = hand.engagement.update(input.engaged, now.time, force, torque);
  }
  return inputs_;
}

}  // namespace slosh
