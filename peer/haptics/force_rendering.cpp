#include "peer/haptics/force_rendering.h"

#include <algorithm>
#include <cmath>

#include "peer/haptics/world_pace.h"

namespace slosh {
namespace {

// A fall of the freshness in one tick that is no fading: the world stopped, or this process was.
constexpr double kSudden = 0.05;

bool is_finite(const Wrench& w) {
  return std::isfinite(w.force.x + w.force.y + w.force.z + w.torque.x + w.torque.y + w.torque.z);
}

}  // namespace

/// While states are late a hand goes on moving and its grip does not: a spring that only silence stretches is
/// not felt.
Wrench ForceRendering::capped(const Wrench& full, bool current) noexcept {
  if (current) {
    most_force_ = glm::length(full.force);
    most_torque_ = glm::length(full.torque);
    return full;
  }
  bool limited = false;
  return {limit_length(full.force, most_force_, limited), limit_length(full.torque, most_torque_, limited)};
}

/// The ramp is for what a hand takes over: what it felt until it re-engaged it goes on feeling.
Wrench ForceRendering::ramped(const Wrench& full) const noexcept {
  const auto part = [&](const glm::dvec3& whole, double kept) {
    const double length = glm::length(whole);
    const double share = length > kept ? kept / length : 1.0;
    return std::max(engagement_.felt(), share) * whole;
  };
  return {part(full.force, kept_force_), part(full.torque, kept_torque_)};
}

double ForceRendering::shaped_share() const noexcept {
  return gentle_ ? share_ * share_ * (3.0 - 2.0 * share_) : share_;
}

Wrench ForceRendering::couple(const StateFreshness& world, const DeviceReport& hand, const GripState& grip,
                              const Moment& now) noexcept {
  double fresh = std::min(world.share, now.device_share);
  bool current = world.current && now.device_share >= 1.0;
  if (world.anew) begun_ = false;
  begun_ = begun_ || (fresh >= 1.0 && current);
  const bool reaches = !gives_way_ || (begun_ && fresh > 0.0);
  // Where the host keeps no stand, its hold begins with the first pose: until then the one here is as if all
  // were well, so that both go together; the force is none.
  if (!begun_) fresh = 1.0, current = true;
  jumps_ = world.anew || world.resumed || fresh < fresh_ - kSudden || (current && !current_);
  current_ = current;
  if (world.anew || now.leapt || (fresh >= 1.0 && hold_anew_)) {
    engagement_.take_hold_anew();
    jumps_ = true;
  }
  if (jumps_) over_ = world.anew ? kFadeStale : kBridge;
  // A host that keeps its stand takes the hand as it is from here on, and the grip as it is then.
  if (now.stands && !(reaches && felt_)) engagement_.take_hold_anew();
  felt_ = reaches;
  // A hand that engages begins without force; a silence took as much of it as it lasted.
  const bool begins = world.anew || now.leapt || (hand.engaged && !held_on_);
  held_on_ = hand.engaged;
  if (gentle_ && begins) share_ = 0.0;
  hold_anew_ = fresh < 1.0;
  fresh_ = fresh;
  // What comes back after a gap comes back as gently as it went.
  share_ = begun_ ? std::min(fresh, share_ + now.period / rise_) : gentle_ ? 0.0 : 1.0;

  CouplingGains gains = gains_;
  gains.damping = std::min(gains.damping, now.pace * most_damping_);
  gains.rotational_damping = std::min(gains.rotational_damping, now.pace * most_turning_);
  const Twist twist = sped_up(hand.twist, now.pace);
  // Engages by the world's coupling, whatever the device bears: else one slips where the other does not.
  held_ = engagement_.update(hand.engaged, now.time, hand.pose, twist, of_world_, grip,
                             now.shared ? Company::kShared : Company::kAlone);
  const Wrench full = gives_way_
                          ? coupling_wrench_on_hand(gains, held_.pose, held_.twist, grip.pose, grip.twist)
                          : grip.on_hand;
  if (engagement_.took_hold()) {
    kept_force_ = glm::length(last_.force);
    kept_torque_ = glm::length(last_.torque);
  }
  if (!engagement_.engaged()) kept_force_ = kept_torque_ = 0.0;
  return gives_way_ || !engagement_.engaged() ? ramped(full) : full;
}

ForceLimiter::Outcome ForceRendering::finish(Wrench wanted, const Twist& twist, const Moment& now) noexcept {
  if (is_finite(wanted)) {
    wanted = begun_ ? capped(wanted, current_) : Wrench{};
    const double share = shaped_share();
    const double damped = begun_ && engagement_.engaged() ? fresh_ * (1.0 - share) : 0.0;
    wanted = {share * wanted.force - damped * damping_ * twist.linear,
              share * wanted.torque - damped * rotational_damping_ * twist.angular};
    if (jumps_) {
      bridge_ = {last_.force - wanted.force, last_.torque - wanted.torque};
      left_ = 1.0;
    }
    wanted = {wanted.force + left_ * bridge_.force, wanted.torque + left_ * bridge_.torque};
    left_ = std::max(left_ - now.period / over_, 0.0);
  }
  const ForceLimiter::Outcome outcome = limiter_.limit(wanted, now.period);
  const bool plain = !gives_way_ && engagement_.engaged() && !outcome.limited && !outcome.non_finite;
  follows_world_ = plain;
  last_ = outcome.wrench;
  return outcome;
}

}  // namespace slosh
