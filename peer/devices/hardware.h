// From the words after --device to a device that is hardware, a plug-in or a simulated person.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "peer/haptics/device.h"
#include "peer/haptics/pose_track.h"

namespace slosh {

class RoomTie;

/// Where a hand begins, and what it would do by itself.
struct HandPlace {
  Pose start;
  glm::dquat camera{1.0, 0.0, 0.0, 0.0};  ///< the camera's axes (right, up, towards the eye) to the world's
  std::vector<PoseKey> motion;            ///< the scene's, for the simulated operator; may be empty
  std::shared_ptr<RoomTie> tie =
      nullptr;  ///< to a headset's room, of a device that tells its place; null: none
};

/// The orientation of a camera that looks from `eye` at `target`, y up.
glm::dquat camera_axes(const glm::dvec3& eye, const glm::dvec3& target);

/// The device that `spec` names, not open yet; nothing where it names none of these kinds. Errors: what
/// stands after the kind cannot be used.
std::optional<Result<std::unique_ptr<Device>>> make_hardware(const std::string& spec, const HandPlace& place);

/// Whether a device of `spec` tells a place of its own, and so may share a room with a headset.
bool is_tied(const std::string& spec);

/// How a spec of these kinds is written, for errors and help.
constexpr const char* kHardwareSpecs =
    "spacemouse[:SERIAL|PATH], gamepad[:SERIAL|NAME|PATH], falcon[:SERIAL], osc[:[HOST:]PORT][,...], "
    "plugin:FILE[:OPTIONS] or operator[:tight|loose,...]";

/// Something that is plugged in, or why it cannot be used.
struct FoundDevice {
  std::string spec;     ///< what to give to --device
  std::string name;     ///< "SpaceMouse Compact"
  std::string where;    ///< "/dev/hidraw3, serial 12345"
  std::string problem;  ///< empty: it can be used
  std::string mend;
  bool denied = false;  ///< it is there and this user may not open it: what udev_rule() mends
};
std::vector<FoundDevice> find_hardware();

/// What lets every user who sits at the machine open these devices: the text of a udev rule, and where it
/// goes.
std::string udev_rule();
constexpr const char* kUdevRuleFile = "/etc/udev/rules.d/70-slosh.rules";

}  // namespace slosh
