// How a grip's coupling is let in when a hand takes hold. Both ends of a channel run the same rule on the
// same times, so the force a hand feels and the force the body gets ramp together.
#pragma once

#include <algorithm>

namespace slosh {

/// Time over which a coupling that would start with a jolt is let in, s of simulated time.
constexpr double kEngageRamp = 0.5;
/// A coupling that changes the force on the body by less than this when the hand takes hold starts at full
/// strength: there is nothing to ramp, and a body that was settled into a hand before the run does not sag.
constexpr double kQuietForce = 2.0;    ///< N
constexpr double kQuietTorque = 0.05;  ///< N·m

/// The state of one grip's ramp. Pure; owned by one thread.
class Engagement {
 public:
  /// Call once a tick. `time` in simulated s; `force` (N) and `torque` (N·m) are the jolt: by how much
  /// the coupling at full strength differs from the one that acts already (GripState::on_hand, 0 when none).
  /// Returns the coupling's scale, 0–1; 0 while not engaged.
  double update(bool engaged, double time, double force, double torque) {
    if (!engaged) {
      engaged_ = false;
      return 0.0;
    }
    if (!engaged_) {
      engaged_ = true;
      const bool quiet = force <= kQuietForce && torque <= kQuietTorque;
      start_ = quiet ? time - kEngageRamp : time;
    }
    return std::clamp((time - start_) / kEngageRamp, 0.0, 1.0);
  }

  bool engaged() const { return engaged_; }

 private:
  bool engaged_ = false;
  double start_ = 0.0;
};

}  // namespace slosh
