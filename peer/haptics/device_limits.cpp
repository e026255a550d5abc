#include "peer/haptics/device_limits.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace slosh {
namespace {

constexpr double kLongestEngagement = 60.0;  // s

}  // namespace

Result<bool> check_limits(const DeviceLimits& limits, const std::string& device) {
  struct Field {
    const char* name;
    double value;
  };
  const Field fields[] = {{"max_force", limits.max_force},
                          {"max_torque", limits.max_torque},
                          {"max_force_rate", limits.max_force_rate},
                          {"max_torque_rate", limits.max_torque_rate},
                          {"max_stiffness", limits.max_stiffness},
                          {"max_damping", limits.max_damping},
                          {"max_rotational_stiffness", limits.max_rotational_stiffness},
                          {"max_rotational_damping", limits.max_rotational_damping},
                          {"workspace_radius", limits.workspace_radius},
                          {"max_force_jerk", limits.max_force_jerk},
                          {"max_torque_jerk", limits.max_torque_jerk}};
  const std::string where = "device '" + device + "'";
  constexpr const char* kMend =
      "Its driver must state what the device can hold; without that it gets no force";
  for (const Field& field : fields) {
    if (std::isfinite(field.value) && field.value > 0.0) continue;
    char what[120];
    std::snprintf(what, sizeof what, "its limit %s is %g, and not a number above 0", field.name, field.value);
    return Error{where, what, kMend};
  }
  if (!(limits.engagement_time >= 0.0 && limits.engagement_time <= kLongestEngagement)) {
    char what[120];
    std::snprintf(what, sizeof what, "its engagement_time is %g, and not 0 to %g s", limits.engagement_time,
                  kLongestEngagement);
    return Error{where, what, kMend};
  }
  const glm::dvec3& c = limits.workspace_center;
  if (!std::isfinite(c.x + c.y + c.z)) return Error{where, "its workspace_center is not finite", kMend};
  return true;
}

DeviceLimits limits_without_a_hand() {
  DeviceLimits limits;
  limits.max_force = 1000.0;
  limits.max_torque = 100.0;
  limits.max_force_rate = 2.0e5;
  limits.max_torque_rate = 2.0e4;
  limits.max_stiffness = 1e6;
  limits.max_damping = 1e4;
  limits.max_rotational_stiffness = 1e4;
  limits.max_rotational_damping = 1e3;
  limits.workspace_radius = 1e6;
  limits.max_force_jerk = limits.max_torque_jerk = 1e12;
  limits.engagement_time = 0.0;
  return limits;
}

CouplingGains within(const CouplingGains& gains, const DeviceLimits& limits) noexcept {
  const auto at_most = [](double gain, double most) { return gain > 0.0 ? std::min(gain, most) : 0.0; };
  return {at_most(gains.stiffness, limits.max_stiffness), at_most(gains.damping, limits.max_damping),
          at_most(gains.rotational_stiffness, limits.max_rotational_stiffness),
          at_most(gains.rotational_damping, limits.max_rotational_damping)};
}

bool keep_in_workspace(Pose& handle, Twist& twist, const DeviceLimits& limits) noexcept {
  const glm::dvec3 from_center = handle.position - limits.workspace_center;
  const double distance = glm::length(from_center);
  if (distance <= limits.workspace_radius) return false;
  const glm::dvec3 out = from_center / distance;
  handle.position = limits.workspace_center + limits.workspace_radius * out;
  twist.linear -= std::max(glm::dot(twist.linear, out), 0.0) * out;
  return true;
}

}  // namespace slosh
