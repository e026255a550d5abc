// How a SpaceMouse moves the hand: what its file may say.
#pragma once

#include <array>

#include "peer/devices/device_file.h"

namespace slosh {

struct SpaceMouseSettings {
  /// What moves one axis of the hand: an axis of the device (0–5: x y z rx ry rz), with its sign.
  struct Source {
    int axis = 0;
    double sign = 1.0;
  };

  bool rate = true;        ///< deflection is a velocity; else it is a place
  int deadzone = 2;        ///< counts of 350 that are no deflection
  double speed = 0.25;     ///< m/s at the stop (rate)
  double turn_rate = 1.5;  ///< rad/s at the stop (rate)
  double reach = 0.10;     ///< m at the stop (position)
  double turn = 0.8;       ///< rad at the stop (position)
  bool by_camera = true;   ///< axes are the camera's: right, up, towards the eye; else the world's
  /// The hand's x y z rx ry rz. The device's z points down and its y towards the user; its turns count
  /// against the right-hand rule.
  std::array<Source, 6> axes{{{0, 1}, {2, -1}, {1, 1}, {3, -1}, {5, 1}, {4, -1}}};
  std::array<double, 6> gains{1, 1, 1, 1, 1, 1};  ///< on the hand's axes
  int clutch_button = 1;                          ///< while it is held the hand stays where it is; 0 = none
  int deadman_button = 0;  ///< the hand holds on only while it is held; 0 = it always does
};

/// What the file leaves out is as `otherwise` has it. Errors: those of the file; with the line.
Result<SpaceMouseSettings> read_spacemouse_settings(DeviceFile file,
                                                    const SpaceMouseSettings& otherwise = {});

}  // namespace slosh
