// A haptic device's part in a room that it shares with a headset.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "peer/devices/headset_link.h"
#include "peer/devices/shared_space.h"

namespace slosh {

/// Between a device, which tells where it is, and who calibrates or places the room. Where the two were
/// calibrated the device moves its hand as it moves in the room, a metre for a metre, so that the hand stays
/// where the person's own is; the room is placed so that it begins there (HeadsetLink::lead).
class RoomTie {
 public:
  /// `link`: null where there is no headset, or none to be tied to: then only where the device is is told.
  explicit RoomTie(std::shared_ptr<HeadsetLink> link) : link_(std::move(link)) {}

  /// By the device, at open(). `name` as of its settings. Errors: mistakes in what was kept.
  Result<bool> begin(const std::string& name);
  /// The device's way is the room's: it is to take `scale()` for its own, and no camera's axes.
  bool shared() const { return link_ && space_; }
  /// m of the world a m of the device.
  double scale() const { return link_->scale; }
  /// By the device, at each sound reading: its pose in its own frame, and its hand's in the world. Once, when
  /// the room is placed: the device's axes to the world's.
  std::optional<glm::dquat> follow(const Pose& at_device, const Pose& hand);

  /// In the device's own frame, as it last was. Any thread.
  std::optional<Pose> tip() const;
  const std::string& name() const { return name_; }

 private:
  const std::shared_ptr<HeadsetLink> link_;
  std::string name_;
  std::optional<SharedSpace> space_;
  bool placed_ = false;
  mutable std::mutex mutex_;
  std::optional<Pose> tip_;
};

}  // namespace slosh
