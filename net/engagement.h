// How a hand takes hold of a grip, wherever the hand is: for the first time, back from a lost connection,
// after a pause, a reset or a host's crash. Both ends of a channel run the same rule, so the force that a
// hand feels and the force that the body gets go together.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/math/coupling.h"
#include "sim/snapshot.h"

namespace slosh {

/// A coupling whose force differs from the one that acts already by less than this when the hand takes hold
/// is held as it is: there is nothing to let go of, and a body that was settled into a hand before the run
/// neither sags nor creeps.
constexpr double kQuietForce = 2.0;    ///< N
constexpr double kQuietTorque = 0.05;  ///< N·m
/// The distance between a hand and where it holds is given up at no more than this speed.
constexpr double kLetInSpeed = 0.15;  ///< m/s
constexpr double kLetInTurn = 1.0;    ///< rad/s
/// s over which that speed rises from 0 ...
constexpr double kLetInRise = 0.5;
/// ... and the time constant, s, with which the last of the distance goes.
constexpr double kLetInEnd = 0.25;
/// s of silence (of a hand, or of body states) after which holding on counts as taking hold anew: the hand
/// may be anywhere by then.
constexpr double kHoldAnew = 0.1;

/// s over which a hand that takes hold of something that moves gives up that motion. Over 0.5 s the hold went
/// on straight where a bucket that hung in one hand swung back: 77 to 158 N on who came back, in place of 25
/// to 27.
constexpr double kSlipRise = 0.15;

/// Where another hand holds the same body, a hold that was taken anew changes the force that acted when it
/// began by no more than this, and by twice that each kHoldDoubles s later; beyond, it slips. Two hands that
/// come back where the body was turned away from both give up their distances each on its own way, and would
/// pull against one another: 100 N of a bucket that weighs 25. A weight that shifts is carried in the end.
constexpr double kHoldForce = 2.0;    ///< N
constexpr double kHoldTorque = 0.1;   ///< N·m
constexpr double kHoldDoubles = 1.0;  ///< s, simulated

/// The state of one grip's hold. The hand takes hold where the force goes on as it is, and as fast as the
/// grip goes: with the pose that it has, less an offset, and with its velocity, less its slip against the
/// grip. The slip is given up over kSlipRise (the offset grows by it meanwhile), the offset slowly after
/// that, until the hand holds where it is; where the hold slips it grows again (kHoldForce). So taking hold
/// never pulls harder than what moving the body at kLetInSpeed takes, however far away the hand is, and a
/// hand that passes by does not snatch the body away. Pure; owned by one thread; no allocation.
class Engagement {
 public:
  /// What the coupling uses in place of the hand.
  struct Held {
    Pose pose;
    Twist twist;
  };

  /// Call once a tick. `time` in simulated s, never falling; `hand`, `twist`: the hand as it is; `grip` as it
  /// is, with the force that acts on the hand already (0 when none does); `shared`: another hand holds the
  /// same body. While not engaged the hand itself comes back.
  Held update(bool engaged, double time, const Pose& hand, const Twist& twist, const CouplingGains& gains,
              const GripState& grip, bool shared = false) {
    if (!engaged) {
      *this = Engagement{};
      return {hand, twist};
    }
    took_hold_ = !engaged_;
    if (took_hold_) {
      take_hold(time, hand, twist, gains, grip);
    } else {
      let_in(time);
    }
    const double slipping = quiet_ ? 0.0 : 1.0 - slip_pace();
    if (offset_ == glm::dvec3(0.0) && turn_ == glm::dvec3(0.0) && slipping == 0.0) return {hand, twist};
    Held held{{hand.position - offset_, rotate_by(hand.orientation, -turn_)},
              {twist.linear - slipping * slip_ + speed_, twist.angular - slipping * slip_turn_ + turning_}};
    if (shared && !quiet_) bound_pull(held, hand, gains, grip);
    return held;
  }

  bool engaged() const { return engaged_; }
  bool took_hold() const { return took_hold_; }  ///< in the last update()
  /// Share of the force that the hand is given, 0–1, rising over kLetInRise where the hold was not a quiet
  /// one: the body goes on being carried as it was, but a hand that takes over a weight must not be struck by
  /// it.
  double felt() const { return !engaged_ ? 0.0 : quiet_ ? 1.0 : pace(); }
  /// m and rad by which the hand is ahead of where it holds.
  double distance() const { return glm::length(offset_); }
  double angle() const { return glm::length(turn_); }

 private:
  void take_hold(double time, const Pose& hand, const Twist& twist, const CouplingGains& gains,
                 const GripState& grip) {
    engaged_ = quiet_ = true;
    began_ = grip.on_hand;
    since_ = last_ = time;
    offset_ = turn_ = speed_ = turning_ = slip_ = slip_turn_ = glm::dvec3(0.0);
    const Wrench full = coupling_wrench_on_hand(gains, hand, twist, grip.pose, grip.twist);
    const glm::dvec3 jolt = full.force - grip.on_hand.force;
    const glm::dvec3 jerk = full.torque - grip.on_hand.torque;
    if (!std::isfinite(glm::length(jolt) + glm::length(jerk))) {
      engaged_ = false;  // a body that is out of this world: tried again with its next state
      return;
    }
    if (glm::length(jolt) <= kQuietForce && glm::length(jerk) <= kQuietTorque) return;
    quiet_ = false;
    // From here on the dampers see the grip's own velocity, and the springs alone give what acts already.
    if (gains.stiffness > 0.0) {
      offset_ = hand.position - grip.pose.position + grip.on_hand.force / gains.stiffness;
      slip_ = twist.linear - grip.twist.linear;
    }
    if (gains.rotational_stiffness <= 0.0) return;
    slip_turn_ = twist.angular - grip.twist.angular;
    // Beyond half a turn the spring of turns would turn round.
    glm::dvec3 strain = grip.on_hand.torque / gains.rotational_stiffness;
    const double angle = glm::length(strain);
    if (angle > kMostStrain) strain *= kMostStrain / angle;
    turn_ = rotation_between(rotate_by(grip.pose.orientation, -strain), hand.orientation);
  }

  /// Slips until what the hold changes of the force that it began with is in bounds.
  void bound_pull(Held& held, const Pose& hand, const CouplingGains& gains, const GripState& grip) {
    const Wrench full = coupling_wrench_on_hand(gains, held.pose, held.twist, grip.pose, grip.twist);
    const double firmness = std::exp2((last_ - since_) / kHoldDoubles);
    const glm::dvec3 pull = full.force - began_.force;
    const double most = firmness * kHoldForce;
    if (glm::length(pull) > most && gains.stiffness > 0.0) {
      const double share = most / glm::length(pull);
      held.twist.linear = grip.twist.linear + share * (held.twist.linear - grip.twist.linear);
      const glm::dvec3 damper = gains.damping * (grip.twist.linear - held.twist.linear);
      held.pose.position = grip.pose.position - (began_.force + share * pull - damper) / gains.stiffness;
      offset_ = hand.position - held.pose.position;
    }
    const glm::dvec3 twisting = full.torque - began_.torque;
    const double most_twisting = firmness * kHoldTorque;
    if (glm::length(twisting) > most_twisting && gains.rotational_stiffness > 0.0) {
      const double share = most_twisting / glm::length(twisting);
      held.twist.angular = grip.twist.angular + share * (held.twist.angular - grip.twist.angular);
      const glm::dvec3 damper = gains.rotational_damping * (grip.twist.angular - held.twist.angular);
      const glm::dvec3 spring = began_.torque + share * twisting - damper;
      held.pose.orientation = rotate_by(grip.pose.orientation, -spring / gains.rotational_stiffness);
      turn_ = rotation_between(held.pose.orientation, hand.orientation);
    }
  }

  void let_in(double time) {
    const double elapsed = std::clamp(time - last_, 0.0, kMostElapsed);
    const double before = slip_pace();
    last_ = std::max(last_, time);
    if (elapsed <= 0.0) return;
    if (!quiet_) {
      const double slipped = (1.0 - 0.5 * (before + slip_pace())) * elapsed;
      offset_ += slipped * slip_;
      turn_ += slipped * slip_turn_;
    }
    speed_ = give_up(offset_, pace() * kLetInSpeed, elapsed);
    turning_ = give_up(turn_, pace() * kLetInTurn, elapsed);
  }

  /// 0–1 over kSlipRise.
  double slip_pace() const { return std::clamp((last_ - since_) / kSlipRise, 0.0, 1.0); }
  /// 0–1 over kLetInRise.
  double pace() const { return std::clamp((last_ - since_) / kLetInRise, 0.0, 1.0); }

  /// Shortens `left`; returns the velocity of that.
  static glm::dvec3 give_up(glm::dvec3& left, double most, double elapsed) {
    const double length = glm::length(left);
    if (length == 0.0) return glm::dvec3(0.0);
    const double step = std::min(most * elapsed, length * (1.0 - std::exp(-elapsed / kLetInEnd)));
    const glm::dvec3 direction = left / length;
    left = length - step < kNothing ? glm::dvec3(0.0) : left * (1.0 - step / length);
    return direction * (step / elapsed);
  }

  static constexpr double kMostStrain = 2.5;   // rad
  static constexpr double kMostElapsed = 0.1;  // s: a world that took a leap does not drag the body after it
  static constexpr double kNothing = 1e-6;     // m, rad

  bool engaged_ = false;
  bool took_hold_ = false;
  bool quiet_ = true;
  Wrench began_;  // what acted on the hand when it took hold
  double since_ = 0.0;
  double last_ = 0.0;
  glm::dvec3 offset_{0.0};     // hand less what it holds with, m
  glm::dvec3 turn_{0.0};       // the same as a rotation vector, rad
  glm::dvec3 slip_{0.0};       // of the hand against the grip when it took hold, m/s
  glm::dvec3 slip_turn_{0.0};  // rad/s
  glm::dvec3 speed_{0.0};      // of what it holds with, towards the hand, m/s
  glm::dvec3 turning_{0.0};    // rad/s
};

}  // namespace slosh
