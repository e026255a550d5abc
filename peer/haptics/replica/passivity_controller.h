// The energy that a person puts in at a device, and a damper that acts when more would come out than there
// is.
#pragma once

#include <algorithm>

#include "sim/math/pose.h"

namespace slosh {

/// Passivity observer and controller (Hannaford & Ryu, 2002), with the time that a force is held counted
/// exactly: what was sent acts over the way that the hand goes until the next sending. One thread; no
/// allocation.
class PassivityController {
 public:
  /// J that may come out unanswered: what rounding and a sampled spring make.
  static constexpr double kSlack = 5e-4;
  /// m: a turning hand counts as one that moves on a circle of this radius.
  static constexpr double kArm = 0.1;

  /// Nothing was sent yet; the hand is here. What was counted stays: others have it.
  void restart(const Pose& hand) noexcept {
    sent_ = Wrench{};
    before_ = hand;
  }

  /// Counts what was sent until now, and gives the wrench for the hand: `wanted`, and a damper on `twist`
  /// where `credit` (J that others, weight and fluid put in) and what this person put in do not cover what
  /// came out. `most`: N·s/m that the device holds. `dt` s > 0 to the next sending.
  Wrench guard(const Wrench& wanted, const Pose& hand, const Twist& twist, double dt, double credit,
               double most) noexcept {
    energy_ -= glm::dot(sent_.force, hand.position - before_.position) +
               glm::dot(sent_.torque, rotation_between(before_.orientation, hand.orientation));
    before_ = hand;
    fires_ = false;
    const double left = energy_ + credit + kSlack;
    // What this wrench is about to give counts too: so that the balance does not first go wrong.
    const double gives = dt * (glm::dot(wanted.force, twist.linear) + glm::dot(wanted.torque, twist.angular));
    const double pace =
        glm::dot(twist.linear, twist.linear) + kArm * kArm * glm::dot(twist.angular, twist.angular);
    if (gives <= left || gives <= 0.0 || pace <= 0.0) return wanted;
    fires_ = true;
    // As much as takes away what is too much of it, never harder than the force itself; and what is owed from
    // before by a damper that the device holds.
    const double damping =
        (gives - std::max(left, 0.0)) / (dt * pace) + std::min(std::max(-left, 0.0) / (dt * pace), most);
    return {wanted.force - damping * twist.linear, wanted.torque - kArm * kArm * damping * twist.angular};
  }
  /// What the device was really sent.
  void sent(const Wrench& wrench) noexcept { sent_ = wrench; }

  double energy() const noexcept { return energy_; }  ///< J that the person put in so far
  bool fires() const noexcept { return fires_; }      ///< in the last guard()

 private:
  Pose before_;
  Wrench sent_;
  double energy_ = 0.0;
  bool fires_ = false;
};

}  // namespace slosh
