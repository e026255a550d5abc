// The newest state that a device loop has, for threads that ask less often.
#pragma once

#include "net/channel.h"

namespace slosh {

/// Copies a state only where it says something new: a loop looks at its channel far more often than states
/// come. One thread, or one lock.
class KeptState {
 public:
  /// `newest`: what the channel has now, the same as before or another.
  void note(const BodyMessage& newest) {
    // A world that was paused says so with the step that was told while it ran.
    const bool same =
        newest.bodies.tick == state_.bodies.tick && newest.run == state_.run && newest.rate == state_.rate;
    if (!same || !any_) state_ = newest;
    any_ = true;
  }
  const BodyMessage& state() const { return state_; }

 private:
  BodyMessage state_;
  bool any_ = false;
};

}  // namespace slosh
