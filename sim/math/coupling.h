// The virtual coupling (paper, section 4.4; Colgate et al.): a spring and a damper between a haptic handle
// and the grip frame on a body. The device loop evaluates it at 1 kHz; the host integrates it implicitly.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/math/pose.h"

namespace slosh {

struct CouplingGains {
  double stiffness = 0.0;             ///< N/m
  double damping = 0.0;               ///< N·s/m
  double rotational_stiffness = 0.0;  ///< N·m/rad
  double rotational_damping = 0.0;    ///< N·m·s/rad
};

/// The wrench on the hand: it pulls the handle towards the grip. The torque is about the handle's origin.
/// What acts on the body at the grip is its opposite.
SLOSH_HD inline Wrench coupling_wrench_on_hand(const CouplingGains& gains, const Pose& handle,
                                               const Twist& handle_twist, const Pose& grip,
                                               const Twist& grip_twist) {
  Wrench wrench;
  wrench.force = gains.stiffness * (grip.position - handle.position) +
                 gains.damping * (grip_twist.linear - handle_twist.linear);
  wrench.torque = gains.rotational_stiffness * rotation_between(handle.orientation, grip.orientation) +
                  gains.rotational_damping * (grip_twist.angular - handle_twist.angular);
  return wrench;
}

/// The gains with springs `scale` times as stiff.
inline CouplingGains stiffened(CouplingGains gains, double scale) {
  gains.stiffness *= scale;
  gains.rotational_stiffness *= scale;
  return gains;
}

/// 1/s: by how much the logarithm of a stiffness that is changed live goes on. From the scene's to four times
/// that takes 0.3 s.
constexpr double kGripStiffnessPace = 5.0;

/// What acts `seconds` after `acting` did, on the way to `wanted`; both > 0.
inline double toward_stiffness(double acting, double wanted, double seconds) {
  if (acting == wanted) return wanted;
  const double most = std::exp(kGripStiffnessPace * seconds);
  return std::clamp(wanted, acting / most, acting * most);
}

/// Where a handle that moves on with its twist is after `seconds`.
SLOSH_HD inline Pose extrapolate(const Pose& pose, const Twist& twist, double seconds) {
  return {pose.position + twist.linear * seconds, rotate_by(pose.orientation, twist.angular * seconds)};
}

}  // namespace slosh
