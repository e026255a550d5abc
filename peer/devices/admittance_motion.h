// A handle that is told where to go, moved as a mass and a damper that hand and world push.
#pragma once

#include "sim/math/pose.h"

namespace slosh {

/// Every number > 0 and finite.
struct AdmittanceSettings {
  double mass = 1.0;                 ///< kg
  double damping = 5.0;              ///< N·s/m
  double inertia = 0.005;            ///< kg·m²
  double rotational_damping = 0.02;  ///< N·m·s/rad
  double max_speed = 0.5;            ///< m/s, by the device's data sheet
  double max_turning = 3.0;          ///< rad/s
  double following = 0.005;          ///< s by which the device is behind what it is told
};

/// M·dv/dt + D·v = (the hand on the device) + (the world on the hand), six axes, implicit in D: what a
/// coupling sees is a device of that mass and damping that takes a force, so that all that guards such a
/// device guards this one. The place that it is told stays within what the device can be behind by (leash()):
/// one that is held back, by an end stop or a limit of its motors, does not leap when it comes free. Passive
/// by itself: the step gives no energy. With a hand it is stable while D + b > lag·k for a hand of stiffness
/// k and damping b (third order by Routh; a massless hand without damping: D/lag·(1 + D·lag/M) > k). Pure;
/// one thread; no allocation.
class AdmittanceMotion {
 public:
  explicit AdmittanceMotion(const AdmittanceSettings& settings) : settings_(settings) {}

  /// Where the device is, standing still. Before anything else.
  void begin(const Pose& at) noexcept;
  /// The device's pose and the wrench of the hand on it about the handle, tared.
  void sense(const Pose& at, const Wrench& by_hand) noexcept;
  /// On by `seconds` under the hand's wrench and the world's on the hand.
  void advance(const Wrench& on_hand, double seconds) noexcept;
  /// Nothing is known of the hand, or nobody is to move it: it stands where it is told to be now.
  void stand() noexcept;

  const Pose& pose() const noexcept { return pose_; }  ///< as the device is told
  const Twist& twist() const noexcept { return twist_; }
  const Wrench& by_hand() const noexcept { return by_hand_; }
  /// m and rad that what is told may be ahead of the device: what it is behind by at twice its greatest
  /// speed.
  double leash() const noexcept { return 2.0 * settings_.max_speed * settings_.following; }
  double turning_leash() const noexcept { return 2.0 * settings_.max_turning * settings_.following; }

 private:
  AdmittanceSettings settings_;
  Pose measured_;
  Pose pose_;
  Twist twist_;
  Wrench by_hand_;
};

}  // namespace slosh
