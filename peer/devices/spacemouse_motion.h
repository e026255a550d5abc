// From a SpaceMouse's deflections to a handle that moves smoothly.
#pragma once

#include "peer/devices/spacemouse_reports.h"
#include "peer/devices/spacemouse_settings.h"
#include "sim/math/pose.h"

namespace slosh {

/// Reports come 60 to 125 times a second in steps; the handle gets a pose and a velocity without jumps. Pure;
/// one thread; no allocation.
class SpaceMouseMotion {
 public:
  /// `camera` turns the camera's axes (right, up, towards the eye) into the world's.
  SpaceMouseMotion(const SpaceMouseSettings& settings, const Pose& start, const glm::dquat& camera);

  /// The hand `seconds` later (0–0.05; more counts as that).
  void advance(const SpaceMouseState& state, double seconds) noexcept;
  /// The camera turned; the hand goes on from where it is.
  void look_from(const glm::dquat& camera) noexcept;

  const Pose& pose() const { return pose_; }
  const Twist& twist() const { return twist_; }
  bool engaged() const { return engaged_; }

  /// rad/s of the second-order filter that follows a place, and 1/s of the one that follows a velocity.
  static constexpr double kFollow = 45.0;

 private:
  /// The cap's deflection along the hand's axes, −1 to 1 times the gains, world axes.
  Twist deflection(const SpaceMouseState& state) const noexcept;
  void follow_rate(const Twist& deflection, double dt) noexcept;
  void follow_place(const Twist& deflection, double dt) noexcept;

  SpaceMouseSettings settings_;
  glm::dquat camera_;
  Pose pose_;
  Twist twist_;
  Pose center_;  // position mode: where the hand is while the cap is at rest
  bool clutched_ = false;
  bool engaged_ = true;
};

}  // namespace slosh
