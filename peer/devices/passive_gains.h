// How hard a spring a sampled device holds without feeding energy to the hand (Colgate & Schenkel 1997).
#pragma once

#include <algorithm>

#include "peer/haptics/device_limits.h"

namespace slosh {

/// b > K·T/2 + |B| holds: a device of its own damping `own` (N·s/m or N·m·s/rad), sampled each `period` s,
/// renders this spring and damper passively, whatever the hand does.
inline bool renders_passively(double own, double period, double stiffness, double damping) {
  return own > 0.5 * stiffness * period + damping;
}

/// Half of a device's own damping is for the coupling's damper, the other half for its spring.
constexpr double kDamperShare = 0.5;
/// Short of the bound itself, at which nothing is left.
constexpr double kPassiveMargin = 0.95;

struct PassiveGains {
  double stiffness = 0.0;  ///< N/m or N·m/rad
  double damping = 0.0;    ///< N·s/m or N·m·s/rad
};

/// The largest spring and damper of that share; every pair below them is passive too. `own`, `period` > 0.
inline PassiveGains passive_gains(double own, double period) {
  return {kPassiveMargin * 2.0 * (1.0 - kDamperShare) * own / period, kPassiveMargin * kDamperShare * own};
}

/// `sheet`'s gains cut to what the device's own damping holds each `period` s.
inline DeviceLimits passive_limits(DeviceLimits sheet, double own, double own_turning, double period) {
  const PassiveGains straight = passive_gains(own, period);
  const PassiveGains turning = passive_gains(own_turning, period);
  sheet.max_stiffness = std::min(sheet.max_stiffness, straight.stiffness);
  sheet.max_damping = std::min(sheet.max_damping, straight.damping);
  sheet.max_rotational_stiffness = std::min(sheet.max_rotational_stiffness, turning.stiffness);
  sheet.max_rotational_damping = std::min(sheet.max_rotational_damping, turning.damping);
  return sheet;
}

}  // namespace slosh
