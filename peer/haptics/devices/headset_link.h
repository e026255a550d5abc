// What a headset's controllers need to become hands: the controllers themselves, and where their room lies.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "render/headset_hands.h"
#include "render/room_in_world.h"

namespace slosh {

/// Between the thread that draws, which places the room, and the controllers' threads. Any thread; the lock
/// is held for a copy, and the device loop does not come here.
class HeadsetLink {
 public:
  explicit HeadsetLink(std::shared_ptr<HeadsetHands> controllers) : hands(std::move(controllers)) {}

  const std::shared_ptr<HeadsetHands> hands;  ///< never null

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
};

}  // namespace slosh
