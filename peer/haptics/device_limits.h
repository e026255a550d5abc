// What may be asked of a haptic device, and what a coupling may be made of when it holds that device.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "sim/math/coupling.h"
#include "sim/math/pose.h"
#include "sim/math/result.h"

namespace slosh {

/// What a device can take and hold, by its data sheet. Every number > 0 and finite: a field that a driver
/// forgets is 0 and the device is refused, never driven with a guess. A device that gives no torque says what
/// its sheet would allow and passes over what it is sent. No sheet states the last three: they are about the
/// hand, and have defaults.
struct DeviceLimits {
  double max_force = 0.0;                 ///< N
  double max_torque = 0.0;                ///< N·m
  double max_force_rate = 0.0;            ///< N/s: how fast the force may change
  double max_torque_rate = 0.0;           ///< N·m/s
  double max_stiffness = 0.0;             ///< N/m: the hardest spring that it renders without humming
  double max_damping = 0.0;               ///< N·s/m
  double max_rotational_stiffness = 0.0;  ///< N·m/rad
  double max_rotational_damping = 0.0;    ///< N·m·s/rad
  glm::dvec3 workspace_center{0.0};       ///< m, world, finite
  double workspace_radius = 0.0;          ///< m: handles farther from the centre are taken to be at this edge
  /// N/s²: how fast the rate of the force may change. The default lets a force begin by 0.2 N in its first
  /// millisecond and reach 1000 N/s after five, and passes 5 N at 30 Hz as it is.
  double max_force_jerk = 2.0e5;
  double max_torque_jerk = 4.0e3;  ///< N·m/s²: the same for a handle of 0.02 m
  /// s, ≥ 0: over which a hand gets force that had none (ForceRendering); 0 for what nobody feels.
  double engagement_time = 2.0;
};

/// Errors: a number that is not finite or not above 0, with its name; `device` is for the message.
Result<bool> check_limits(const DeviceLimits& limits, const std::string& device);

/// The limits of a hand that nobody feels: a script, a recording, a mouse. The gains are the largest that a
/// scene may ask for (scenes/FIELDS.md), so that what such a hand "felt" is the coupling of the scene itself.
/// The force limits only keep a world that has blown up out of the tables and plots.
DeviceLimits limits_without_a_hand();

/// A scene's gains, each at most what the device can hold; what is not a number or below 0 becomes 0.
CouplingGains within(const CouplingGains& gains, const DeviceLimits& limits) noexcept;

/// The handle at the nearest place in the workspace. Outside it stands still in the direction that leads
/// away, so that the spring is stretched to the edge and no farther. True when it was outside.
bool keep_in_workspace(Pose& handle, Twist& twist, const DeviceLimits& limits) noexcept;

}  // namespace slosh
