#include "peer/devices/room_tie.h"

namespace slosh {

Result<bool> RoomTie::begin(const std::string& name) {
  name_ = name;
  if (!link_) return true;
  Result<std::optional<SharedSpace>> kept = kept_shared_space(shared_space_file(name));
  if (!kept) return kept.error();
  space_ = kept.value();
  return true;
}

std::optional<glm::dquat> RoomTie::follow(const Pose& at_device, const Pose& hand) {
  {
    const std::lock_guard lock(mutex_);
    tip_ = at_device;
  }
  if (!shared() || placed_) return std::nullopt;
  const Pose& device = space_->device_in_room;
  const std::optional<RoomInWorld> room = link_->room();
  if (!room) {
    link_->lead({device.position + device.orientation * at_device.position, hand.position});
    return std::nullopt;
  }
  placed_ = true;
  return glm::normalize(glm::angleAxis(room->turned, glm::dvec3(0.0, 1.0, 0.0)) * device.orientation);
}

std::optional<Pose> RoomTie::tip() const {
  const std::lock_guard lock(mutex_);
  return tip_;
}

}  // namespace slosh
