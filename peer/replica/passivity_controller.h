// The energy that a person puts in at a device, and no more force than what is left of it covers.
#pragma once

#include <algorithm>
#include <cmath>

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
  /// kg that a hand on a device moves at least: with less, a tick's force gives more than it is counted for.
  static constexpr double kMinMass = 0.3;
  /// s for which what is left of the energy is made to last where it was out within the last kWary s: so the
  /// force goes down before it is out, and not all at once each time that a packet's worth is used up.
  static constexpr double kLasts = 0.1;
  static constexpr double kWary = 1.0;
  /// N/s, of a torque at kArm: so gently a force goes before what is left is out.
  static constexpr double kGently = 1000.0;
  /// s over which it is seen how fast others use up what there is: some of a host's updates.
  static constexpr double kDrain = 0.02;
  static constexpr double kMaxDrain = 20.0;  ///< W: more at once is another way of counting
  /// s over which a force that was cut comes back, and over which a damper for what is owed comes and goes.
  static constexpr double kReturns = 0.2;
  static constexpr double kDamps = 0.05;

  /// Nothing was sent yet; the hand is here. What was counted stays: others have it.
  void restart(const Pose& hand) noexcept {
    sent_ = Wrench{};
    before_ = hand;
    wary_ = damping_ = drain_ = 0.0;
    counts_ = false;
    open_ = 1.0;
  }

  /// Counts what was sent until now, and gives the wrench for the hand: of `wanted` what `credit` (J that
  /// others, weight and fluid put in) and this person's own energy cover until the next sending, and where
  /// more came out than there was a damper on `twist` of at most `most` N·s/m, what the device holds. A share
  /// that was cut grows back over kReturns; meanwhile a damper, of `most` too, stands for what it would take
  /// from the hand's motion. `dt` s > 0 to the next sending.
  Wrench limit(const Wrench& wanted, const Pose& hand, const Twist& twist, double dt, double credit,
               double most) noexcept {
    energy_ -= glm::dot(sent_.force, hand.position - before_.position) +
               glm::dot(sent_.torque, rotation_between(before_.orientation, hand.orientation));
    before_ = hand;
    fires_ = false;
    const double left = energy_ + credit + kSlack;
    // What it is about to give: over the hand's way at its speed, and over what the force itself adds to that
    // way. So a hand that stands is not pushed off for a tick, each tick.
    const double turned = kArm * kArm;
    const double gives = dt * (glm::dot(wanted.force, twist.linear) + glm::dot(wanted.torque, twist.angular));
    const double pushes =
        0.5 * dt * dt / kMinMass *
        (glm::dot(wanted.force, wanted.force) + glm::dot(wanted.torque, wanted.torque) / turned);
    fires_ = pushes > 0.0 && gives + pushes > left;
    double share = 1.0, damping = 0.0;
    if (fires_) {
      // The most of it that is covered; what takes energy in from the hand, as much as takes in the most.
      share = std::min(-0.5 * gives / pushes, 1.0);
      if (left > 0.0)
        share = std::min((std::sqrt(gives * gives + 4.0 * pushes * left) - gives) / (2.0 * pushes), 1.0);
      // What is owed from before, by a damper that the device holds.
      const double pace =
          glm::dot(twist.linear, twist.linear) + turned * glm::dot(twist.angular, twist.angular);
      const double owed = std::max(-left, 0.0);
      if (gives > 0.0 && pace > 0.0) damping = std::min(owed / (dt * pace), most);
    }
    // Where it was out lately, only so much that what is left lasts for a while.
    wary_ = fires_ ? 1.0 : wary_ * std::exp(-dt / kWary);
    const double lasts = wary_ * kLasts * gives / dt;
    const double lasting = lasts > 0.0 ? std::min(share, std::max(left, 0.0) / lasts) : share;
    note_drain(credit, dt);
    const double size =
        std::sqrt(glm::dot(wanted.force, wanted.force) + glm::dot(wanted.torque, wanted.torque) / turned);
    if (size > 0.0) {
      const double gentle = open_ - kGently * dt / size;
      double lets = covered(size, gives / dt, left);
      // A force that takes energy in need not go at once.
      if (!(gives > 0.0)) lets = std::max(lets, gentle);
      share = std::min({share, lets, std::max(lasting, gentle)});
    }
    open_ = std::clamp(share, 0.0, std::min(open_ + dt / kReturns, 1.0));
    const double change = most * dt / kDamps;
    damping_ += std::clamp(damping - damping_, -change, change);
    // What is cut of a force that goes against the hand's motion is a damper at once: it can only take energy
    // in, and where a hand felt nothing of what it does it could never pay for what its body is given at the
    // host.
    const double shut = 1.0 - open_;
    const double resists = damping_ + shut * against(wanted.force, twist.linear, most);
    const double resists_turning =
        turned * damping_ + shut * against(wanted.torque, twist.angular, turned * most);
    return {open_ * wanted.force - resists * twist.linear,
            open_ * wanted.torque - resists_turning * twist.angular};
  }
  /// What the device was really sent. `ramp_work`: J that the coupling was given on the hand's side by no
  /// motion of the hand (ForceRendering::ramp_work): the body has it, and without it what is left would be
  /// too little for ever.
  void sent(const Wrench& wrench, double ramp_work = 0.0) noexcept {
    sent_ = wrench;
    energy_ += ramp_work;
  }

  double energy() const noexcept { return energy_; }  ///< J that the person and the hold put in so far
  bool fires() const noexcept { return fires_; }      ///< in the last limit()

 private:
  /// What others put in and used up, on balance.
  void note_drain(double credit, double dt) noexcept {
    const double used = counts_ ? std::clamp((credit_ - credit) / dt, -kMaxDrain, kMaxDrain) : 0.0;
    drain_ += (1.0 - std::exp(-dt / kDrain)) * (used - drain_);
    credit_ = credit;
    counts_ = true;
  }
  /// The share of a force of `size` N that gives `power` W that can go down to none by kGently before `left`
  /// J are out, with what others use up meanwhile: it is not cut off when they are.
  double covered(double size, double power, double left) const noexcept {
    const double time = size / kGently;  // s, for the whole of it
    const double gives = 0.5 * time * std::max(power, 0.0);
    const double goes = time * std::max(drain_ + std::min(power, 0.0), 0.0);
    if (!(gives + goes > left)) return 1.0;
    const double root = std::sqrt(goes * goes + 4.0 * gives * std::max(left, 0.0));
    return 2.0 * std::max(left, 0.0) / (goes + root);
  }

  /// The damper, of at most `most`, that takes as much as `force` does of a hand that moves; 0 where it
  /// gives.
  static double against(const glm::dvec3& force, const glm::dvec3& velocity, double most) noexcept {
    const double pace = glm::dot(velocity, velocity);
    return pace > 0.0 ? std::clamp(-glm::dot(force, velocity) / pace, 0.0, most) : 0.0;
  }

  Pose before_;
  Wrench sent_;
  double energy_ = 0.0;
  bool fires_ = false;
  double wary_ = 0.0;     // 0–1: 1 where it was out just now
  double credit_ = 0.0;   // J, at the call before
  bool counts_ = false;   // there was one
  double drain_ = 0.0;    // W
  double open_ = 1.0;     // share of the force that is let through
  double damping_ = 0.0;  // N·s/m
};

}  // namespace slosh
