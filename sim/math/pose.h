// Poses, twists and wrenches: the vocabulary shared by every room. SI units, right-handed, y up.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "sim/math/host_device.h"

namespace slosh {

/// Rigid placement of a frame: p_world = position + orientation * p_local. Position in m; unit quaternion.
struct Pose {
  glm::dvec3 position{0.0};
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // w, x, y, z
};

/// m, along each axis: where bodies are kept that are not in the world, as nothing else gets there
/// (kFarthestPlace); whoever has a pose can tell.
inline constexpr double kAway = 9000.0;
inline bool is_away(const Pose& pose) {
  return pose.position.x > 0.8 * kAway && pose.position.y > 0.8 * kAway && pose.position.z > 0.8 * kAway;
}

/// Velocity of a frame: linear (m/s) of its origin, angular (rad/s), both in world axes.
struct Twist {
  glm::dvec3 linear{0.0};
  glm::dvec3 angular{0.0};
};

/// Force (N) and torque (N·m) in world axes. The torque is about the point the field's comment names.
struct Wrench {
  glm::dvec3 force{0.0};
  glm::dvec3 torque{0.0};
};

SLOSH_HD inline Wrench operator+(const Wrench& a, const Wrench& b) {
  return {a.force + b.force, a.torque + b.torque};
}

/// The pose that first applies `inner`, then `outer` (as matrices: outer · inner).
SLOSH_HD inline Pose compose(const Pose& outer, const Pose& inner) {
  return {outer.position + outer.orientation * inner.position, outer.orientation * inner.orientation};
}

SLOSH_HD inline Pose inverse(const Pose& pose) {
  const glm::dquat back = glm::conjugate(pose.orientation);
  return {back * -pose.position, back};
}

SLOSH_HD inline glm::dvec3 transform_point(const Pose& pose, const glm::dvec3& local) {
  return pose.position + pose.orientation * local;
}

/// Rotation vector (axis · angle, rad, angle in [0, π]) that turns `from` into `to`, in world axes.
SLOSH_HD inline glm::dvec3 rotation_between(const glm::dquat& from, const glm::dquat& to) {
  glm::dquat delta = to * glm::conjugate(from);
  if (delta.w < 0.0) delta = -delta;  // the shorter way round
  const glm::dvec3 axis(delta.x, delta.y, delta.z);
  const double sine = glm::length(axis);
  if (sine < 1e-12) return 2.0 * axis;
  return axis * (2.0 * glm::atan(sine, delta.w) / sine);
}

/// Turns `orientation` by the rotation vector `turn` (rad, world axes); the result is normalised.
SLOSH_HD inline glm::dquat rotate_by(const glm::dquat& orientation, const glm::dvec3& turn) {
  const double angle = glm::length(turn);
  const double half_sinc = angle < 1e-9 ? 0.5 : glm::sin(0.5 * angle) / angle;
  const glm::dquat delta(glm::cos(0.5 * angle), half_sinc * turn.x, half_sinc * turn.y, half_sinc * turn.z);
  return glm::normalize(delta * orientation);
}

}  // namespace slosh
