// What a headset's controllers need to become hands: the controllers themselves, and where their room lies.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <optional>

#include "render/headset_hands.h"
#include "render/room_in_world.h"

namespace slosh {

/// A haptic device that was calibrated to the headset: where its tip is, and the hand that it moves.
struct LeadingHand {
  glm::dvec3 in_room{0.0};   ///< m
  glm::dvec3 in_world{0.0};  ///< m
};

/// Between the thread that draws, which places the room, and the controllers' threads. Any thread; the lock
/// is held for a copy, and the device loop does not come here.
class HeadsetLink {
 public:
  /// `world_scale`: RoomInWorld::scale of the room that will be placed.
  explicit HeadsetLink(std::shared_ptr<HeadsetHands> controllers, double world_scale = 1.0)
      : hands(std::move(controllers)), scale(world_scale) {}

  const std::shared_ptr<HeadsetHands> hands;  ///< never null
  const double scale;                         ///< m of the world a m of the room

  /// Before the room is placed; the last one counts.
  void lead(const LeadingHand& hand) {
    const std::lock_guard lock(mutex_);
    leading_ = hand;
  }
  std::optional<LeadingHand> leading() const {
    const std::lock_guard lock(mutex_);
    return leading_;
  }

  void place(const RoomInWorld& room) {
    const std::lock_guard lock(mutex_);
    room_ = room;
  }
  /// Nothing before anybody was seen to wear the headset.
  std::optional<RoomInWorld> room() const {
    const std::lock_guard lock(mutex_);
    return room_;
  }

 private:
  mutable std::mutex mutex_;
  std::optional<RoomInWorld> room_;
  std::optional<LeadingHand> leading_;
};

}  // namespace slosh
