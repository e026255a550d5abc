// A haptic device as the device loop sees it.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "sim/math/pose.h"
#include "sim/math/result.h"

namespace slosh {

/// What may be sent to a device. The rates limit how fast the wrench may change.
struct DeviceLimits {
  double max_force = 1000.0;       ///< N
  double max_torque = 100.0;       ///< N·m
  double max_force_rate = 2.0e5;   ///< N/s
  double max_torque_rate = 2.0e4;  ///< N·m/s
};

/// One reading.
struct DeviceReport {
  Pose pose;    ///< handle, world
  Twist twist;  ///< handle, world
  std::uint32_t buttons = 0;
  bool engaged = true;  ///< the hand holds on
};

/// The moment a device is read at.
struct DeviceMoment {
  double time = 0.0;      ///< simulated s
  double period = 0.001;  ///< wall s since the reading before, nominal
};

/// open() and close() on any thread; read() and write() on the device loop only: they must not allocate,
/// lock, log or wait.
class Device {
 public:
  virtual ~Device() = default;
  /// Errors: the device is not there, its file cannot be used.
  virtual Result<bool> open() { return true; }
  virtual DeviceReport read(const DeviceMoment& moment) noexcept = 0;
  /// The wrench on the hand, within limits().
  virtual void write(const Wrench& on_hand) noexcept { (void)on_hand; }
  virtual DeviceLimits limits() const { return {}; }
  /// May be called more than once.
  virtual void close() {}
  virtual std::string kind() const = 0;
};

/// Every number finite and the quaternion within 1 % of unit length.
inline bool is_sound(const DeviceReport& report) {
  const auto finite = [](const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  const glm::dquat& q = report.pose.orientation;
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return finite(report.pose.position) && finite(report.twist.linear) && finite(report.twist.angular) &&
         std::abs(length - 1.0) <= 0.01;  // false for a NaN too
}

}  // namespace slosh
