// From `--device SPEC` to devices, one a grip.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "peer/devices/headset_link.h"
#include "peer/haptics/device.h"
#include "peer/haptics/mouse_device.h"
#include "peer/haptics/shared_handle.h"
#include "scenes/scene.h"

namespace slosh {

/// One hand's device; `mouse` where it is one, `lent` where it is a script that a window may take over.
struct HandDevice {
  std::unique_ptr<Device> device;
  std::shared_ptr<MouseTarget> mouse;
  std::shared_ptr<SharedHandle> lent;
};
/// The device that `spec` asks for, for grip `grip`; a mouse starts at `start`, and so does a script without
/// a motion. With a window a script is lent. `headset` is what a controller needs, null without one. Errors:
/// as make_devices.
Result<HandDevice> make_device(const Scene& scene, std::size_t grip, const std::string& spec,
                               const Pose& start, bool has_window,
                               const std::shared_ptr<HeadsetLink>& headset = nullptr);

/// Whether a device that `spec` asks for gives a force that moves the hand (Device::gives_way), as far as its
/// kind tells; what is no kind at all does not.
bool is_felt(const std::string& spec);

struct DeviceSet {
  std::vector<std::unique_ptr<Device>> devices;             ///< one a grip
  std::vector<std::shared_ptr<MouseTarget>> mouse_targets;  ///< one a grip, null where it is not a mouse
  std::vector<std::shared_ptr<SharedHandle>> lent;          ///< one a grip, null where no window may take it
  std::vector<std::string> specs;                           ///< one a grip
  /// A device as `spec` asks for, not open, for `grip`, whose handle is at `start`: make_device.
  std::function<Result<HandDevice>(std::size_t grip, const std::string& spec, const Pose& start)> another;
};

/// `specs`: none (all `script`), one for all, or one a grip. `has_window` is what a mouse needs. Errors: an
/// unknown kind, more specs than grips, a mouse without a window, a controller without a headset or for two
/// grips, a replay file that cannot be used. `scene` must outlive what is returned.
Result<DeviceSet> make_devices(const Scene& scene, const std::vector<std::string>& specs, bool has_window,
                               const std::shared_ptr<HeadsetLink>& headset = nullptr);

}  // namespace slosh
