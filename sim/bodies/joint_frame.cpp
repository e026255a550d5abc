#include "sim/bodies/joint_frame.h"

#include <cmath>
#include <numbers>

namespace slosh {
namespace {

constexpr std::array<JointRow, kRowsPerJoint> kHinge{
    {{false, 0}, {false, 1}, {false, 2}, {true, 0}, {true, 2}}};
constexpr std::array<JointRow, kRowsPerJoint> kSlider{
    {{false, 0}, {false, 2}, {true, 0}, {true, 1}, {true, 2}}};

}  // namespace

std::span<const JointRow, kRowsPerJoint> held_rows(JointKind kind) {
  return kind == JointKind::kHinge ? kHinge : kSlider;
}

std::array<double, kRowsPerJoint> JointFrames::off(JointKind kind) const {
  const glm::dquat into = glm::conjugate(second.orientation);
  const glm::dvec3 apart = into * (first.position - second.position);
  // A hinge's axes are apart by the sine of the angle between them.
  const glm::dvec3 turned =
      kind == JointKind::kHinge
          ? glm::cross(glm::dvec3(0, 1, 0), into * (first.orientation * glm::dvec3(0, 1, 0)))
          : into * rotation_between(second.orientation, first.orientation);
  std::array<double, kRowsPerJoint> values{};
  const auto rows = held_rows(kind);
  for (int r = 0; r < kRowsPerJoint; ++r) values[r] = (rows[r].turning ? turned : apart)[rows[r].axis];
  return values;
}

double JointFrames::coordinate(JointKind kind) const {
  const glm::dquat into = glm::conjugate(second.orientation);
  if (kind == JointKind::kSlider) return (into * (first.position - second.position)).y;
  const glm::dquat turn = into * first.orientation;
  return std::remainder(2.0 * std::atan2(turn.y, turn.w), 2.0 * std::numbers::pi);
}

}  // namespace slosh
