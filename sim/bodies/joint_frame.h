// Where a joint's two frames are to each other, and along what its rows act.
#pragma once

#include <array>
#include <span>

#include "scenes/scene.h"
#include "sim/bodies/body_solve.h"

namespace slosh {

/// Either side of a joint in a body's axes, about its centre of mass; the world's where there is no body.
struct JointSide {
  int body = -1;
  glm::dvec3 point{0.0};
  glm::dquat turn{1.0, 0.0, 0.0, 0.0};  ///< joint axes to the body's
};

/// One of the six components between the two frames: along or about x, y or z of the second.
struct JointRow {
  bool turning = false;
  int axis = 0;
};

/// What each kind holds, and what a hinge or a slider leaves free.
inline constexpr std::size_t kMaxRowsPerJoint = 6;
std::span<const JointRow> held_rows(JointKind kind);
inline JointRow free_row(JointKind kind) {
  return {kind == JointKind::kHinge, 1};
}

/// A joint's frames in the world, from the poses of its two bodies.
struct JointFrames {
  Pose first, second;

  glm::dvec3 axis(int i) const { return glm::mat3_cast(second.orientation)[i]; }
  /// Where both bodies get an impulse: one point, so that it exerts no net torque.
  const glm::dvec3& point() const { return first.position; }
  /// The first in the second's axes.
  Pose relative() const { return compose(inverse(second), first); }
  /// m or rad by which the first is off the second, by the rows that the kind holds. `rest`: where a fixed
  /// one holds the first, in the second's axes.
  std::array<double, kMaxRowsPerJoint> off(JointKind kind, const Pose& rest) const;
  /// m, or rad from −π to π, of the row that it leaves free; of a fixed one m between the two.
  double coordinate(JointKind kind) const;
};

}  // namespace slosh
