#include "peer/haptics/make_device.h"

#include <algorithm>

#include "net/grip_start.h"
#include "peer/devices/controller_device.h"
#include "peer/devices/hardware.h"
#include "peer/devices/room_tie.h"
#include "peer/haptics/script_device.h"

namespace slosh {
namespace {

constexpr const char* kReplay = "replay:";
constexpr const char* kLeft = "xr-left";
constexpr const char* kRight = "xr-right";

}  // namespace

Result<HandDevice> make_device(const Scene& scene, std::size_t grip, const std::string& spec,
                               const Pose& start, bool has_window,
                               const std::shared_ptr<HeadsetLink>& headset) {
  HandDevice hand;
  if (spec == "script") {
    hand.device = std::make_unique<TrackDevice>(PoseTrack(scene.grips[grip].hand_motion, start), spec);
    if (has_window) {
      hand.lent = std::make_shared<SharedHandle>(start);
      hand.device = std::make_unique<SharedHandleDevice>(std::move(hand.device), hand.lent);
    }
  } else if (spec == "mouse") {
    if (!has_window) {
      return Error{"--device mouse", "there is no window to move the mouse in",
                   "Run with a display and without --headless, or use script"};
    }
    hand.mouse = std::make_shared<MouseTarget>(start);
    hand.device = std::make_unique<MouseDevice>(hand.mouse, start);
  } else if (spec == kLeft || spec == kRight) {
    if (!headset) {
      return Error{"--device " + spec, "no headset is in use, and its controllers come with it",
                   "Give --vr (what it found is said above), or another device"};
    }
    hand.device = std::make_unique<ControllerDevice>(
        headset, spec == kLeft ? HandSide::kLeft : HandSide::kRight, start);
  } else if (spec.rfind(kReplay, 0) == 0) {
    const std::string file = spec.substr(std::char_traits<char>::length(kReplay));
    if (file.empty())
      return Error{"--device", "'replay:' names no file",
                   "Give the path of a poses.csv that `play --out` wrote"};
    Result<std::vector<PoseKey>> keys = read_poses(file, static_cast<int>(grip));
    if (!keys) return keys.error();
    hand.device = std::make_unique<TrackDevice>(PoseTrack(keys.value(), start), "replay");
  } else {
    HandPlace place{start, camera_axes(scene.camera.eye, scene.camera.target), scene.grips[grip].hand_motion};
    if (headset && is_tied(spec)) place.tie = std::make_shared<RoomTie>(headset);
    std::optional<Result<std::unique_ptr<Device>>> made = make_hardware(spec, place);
    if (!made) {
      return Error{"--device", "'" + spec + "' is no device",
                   std::string("Use script, mouse, xr-left, xr-right, replay:FILE, ") + kHardwareSpecs};
    }
    if (!*made) return made->error();
    hand.device = std::move(made->value());
  }
  return hand;
}

bool is_felt(const std::string& spec) {
  const std::string kind = spec.substr(0, spec.find(':'));
  return kind == "falcon" || kind == "plugin" || kind == "operator";
}

Result<DeviceSet> make_devices(const Scene& scene, const std::vector<std::string>& specs, bool has_window,
                               const std::shared_ptr<HeadsetLink>& headset) {
  const std::size_t grips = scene.grips.size();
  if (specs.size() > 1 && specs.size() != grips) {
    return Error{"--device",
                 std::to_string(specs.size()) + " devices given, and the scene has " + std::to_string(grips) +
                     (grips == 1 ? " grip" : " grips"),
                 "Give one for all of them, or one a grip"};
  }
  for (const char* side : {kLeft, kRight}) {
    const auto given = std::ranges::count(specs, side);
    if (given > 1 || (given == 1 && specs.size() == 1 && grips > 1)) {
      return Error{std::string("--device ") + side, "one controller cannot hold two handles",
                   "Give one device a grip, for example --device xr-left --device xr-right"};
    }
  }
  DeviceSet set;
  for (std::size_t i = 0; i < grips; ++i) {
    const std::string spec = specs.empty() ? "script" : specs.size() == 1 ? specs[0] : specs[i];
    Result<HandDevice> hand = make_device(scene, i, spec, grip_start(scene, i), has_window, headset);
    if (!hand) return hand.error();
    set.devices.push_back(std::move(hand.value().device));
    set.mouse_targets.push_back(std::move(hand.value().mouse));
    set.lent.push_back(std::move(hand.value().lent));
    set.specs.push_back(spec);
  }
  set.another = [&scene, has_window, headset](std::size_t grip, const std::string& spec, const Pose& start) {
    return make_device(scene, grip, spec, start, has_window, headset);
  };
  return set;
}

}  // namespace slosh
