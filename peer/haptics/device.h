// A haptic device as the device loop sees it.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "peer/haptics/device_limits.h"
#include "sim/math/pose.h"
#include "sim/math/result.h"

namespace slosh {

/// One reading.
struct DeviceReport {
  Pose pose;    ///< handle, world
  Twist twist;  ///< handle, world
  std::uint32_t buttons = 0;
  bool engaged = true;  ///< the hand holds on
  /// False: the device said nothing (its cable is out). The rest counts for nothing then, and the hand is
  /// taken for silent: its force fades, and it re-engages when it is back.
  bool heard = true;
  /// The handle as the device itself has it, in its own frame, before scale, clutch and camera. Nothing where
  /// `pose` is that, or the device has no place of its own.
  std::optional<Pose> at_device = std::nullopt;
  /// What its last write() made of the wrench that it was handed, at the device and in its own frame, after
  /// scale and filter. Nothing before there was one, and where that is what it was handed.
  std::optional<Wrench> rendered = std::nullopt;
};

/// The moment a device is read at.
struct DeviceMoment {
  double time = 0.0;      ///< simulated s
  double period = 0.001;  ///< wall s since the reading before, nominal
  bool stands = false;    ///< the world does: it is paused, or its states stopped coming
};

/// open() and limits() on any thread before the device is handed over; read() and write() by one thread after
/// that, read() first, in turn; close() when both are over. What a device throws from read() or write() ends
/// its part: it is sent a wrench of zero and not asked again.
class Device {
 public:
  virtual ~Device() = default;
  /// Errors: the device is not there, its file cannot be used.
  virtual Result<bool> open() { return true; }
  virtual DeviceReport read(const DeviceMoment& moment) = 0;
  /// The wrench on the hand, within limits().
  virtual void write(const Wrench& on_hand) { (void)on_hand; }
  /// In place of write(), last: no wrench, and no motion either where it is one that is told where to go.
  /// Also by whoever ends the process.
  virtual void rest() { write(Wrench{}); }
  /// Constant while the device is open. Checked by check_limits before anything is written.
  virtual DeviceLimits limits() const = 0;
  /// The viewer's camera turned: `axes` takes its right, up and towards-the-eye to the world's. For devices
  /// whose motion goes by the picture; one thread, any but the device's, and without waiting for it.
  virtual void look_from(const glm::dquat& axes) { (void)axes; }
  /// True when read() and write() only look at memory: they neither wait, allocate, lock nor log, and are
  /// called from the device loop itself. All others get a thread of their own (DevicePort), so that hardware
  /// that does not answer stops no other hand.
  virtual bool immediate() const { return false; }
  /// Whether the force moves the hand. Where it does not (a script, a recording, a mouse), what counts as
  /// felt is the wrench that the world itself put on the hand: nothing is to be kept stable by a spring of
  /// this end.
  virtual bool gives_way() const { return true; }
  /// True when it moves by simulated time (DeviceMoment::time): its velocities are m per simulated s. False
  /// for all that goes by the clock on the wall, as hardware and who holds it do: what passes between it and
  /// a world that is slower is converted.
  virtual bool goes_with_world() const { return false; }
  /// May be called more than once.
  virtual void close() {}
  virtual std::string kind() const = 0;
  /// What keeps it from working for now, in words for who holds it; empty while it works. Any thread; not
  /// from the device loop.
  virtual std::string trouble() const { return {}; }
  /// What its user should know before holding it: gains beyond what it holds safely. Once it is open.
  virtual std::vector<std::string> warnings() const { return {}; }
  /// A line for people about what it says lately: raw values, battery. Empty where there is nothing to say.
  /// As trouble().
  virtual std::string status() const { return {}; }
};

/// Opens a device and checks what it says of itself. Errors: those of open() and of check_limits().
inline Result<bool> open_device(Device& device) {
  Result<bool> opened = device.open();
  if (opened) opened = check_limits(device.limits(), device.kind());
  return opened;
}

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
