// From a device's own frame and reach to the world's, and what the user may set about it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "peer/devices/device_file.h"
#include "peer/devices/hardware.h"
#include "peer/devices/low_pass.h"
#include "peer/haptics/device.h"

namespace slosh {

struct HandMapSettings {
  double scale = 1.0;        ///< m of the world a m of the device
  double force_scale = 1.0;  ///< N at the device a N of the world
  bool by_camera = true;     ///< the device's axes are the camera's, else the world's
  int clutch_button = 0;     ///< while it is held the hand stays and the device moves freely; 0 = none
  int deadman_button = 0;    ///< the hand holds on only while it is held; 0 = it always does
  double low_pass_hz = 0.0;  ///< the force's band, −3 dB; 0 = all of it
  /// In place of what the device's damping allows; absent: that.
  std::optional<double> stiffness, damping, rotational_stiffness, rotational_damping;
  std::optional<double> own_damping, own_rotational_damping;
};

/// Takes the keys of every device that gives a force; check() is the caller's.
HandMapSettings read_hand_map(DeviceFile& file, HandMapSettings defaults);

/// A device that shares a room with a headset: its axes and its scale are the room's (RoomTie), a metre a
/// metre.
void tie_to_room(HandMapSettings& settings, double scale);

/// A device's gains: its sheet's, within what its own damping holds (passive_gains.h) unless the file asks
/// for more, which is warned of in words.
struct ChosenGains {
  DeviceLimits limits;  ///< at the device
  std::vector<std::string> warnings;
};
ChosenGains choose_gains(const DeviceLimits& sheet, double own_damping, double own_rotational_damping,
                         double period, const HandMapSettings& settings, const std::string& device);

/// The reference is where the device is at its first reading: the hand begins at its start wherever the
/// handle is. Pure; one thread; no allocation.
class HandMap {
 public:
  /// `period`, s: from one write to the next.
  HandMap(const HandMapSettings& settings, const HandPlace& place, double period = 0.001);

  DeviceReport to_world(const DeviceReport& at_device) noexcept;
  /// The camera turned: from here on the device moves the hand that way, and the hand stays where it is.
  void look_from(const glm::dquat& axes) noexcept;
  Wrench to_device(const Wrench& in_world) const noexcept;
  /// What is written: that, within its band.
  Wrench filtered(const Wrench& in_world) noexcept {
    rendered_ = low_pass_.pass(to_device(in_world));
    return *rendered_;
  }
  /// What the servo may ask of the hand in the world's measure.
  DeviceLimits to_world(const DeviceLimits& at_device) const;

 private:
  Pose mapped(const Pose& at_device) const noexcept;

  HandMapSettings settings_;
  LowPass low_pass_;
  glm::dquat axes_;  // device's to the world's
  Pose start_;
  Pose device_;                     // as it last was
  Pose origin_;                     // of the device, where the hand is at its start
  Pose held_;                       // in the world, while clutched
  std::optional<Wrench> rendered_;  // at the device, last
  bool begun_ = false;
  bool clutched_ = false;
};

}  // namespace slosh
