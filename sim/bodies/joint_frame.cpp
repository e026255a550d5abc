#include "sim/bodies/joint_frame.h"

#include <cmath>
#include <numbers>

namespace slosh {
namespace {

constexpr std::array<JointRow, 5> kHinge{{{false, 0}, {false, 1}, {false, 2}, {true, 0}, {true, 2}}};
constexpr std::array<JointRow, 5> kSlider{{{false, 0}, {false, 2}, {true, 0}, {true, 1}, {true, 2}}};
constexpr std::array<JointRow, 6> kFixed{
    {{false, 0}, {false, 1}, {false, 2}, {true, 0}, {true, 1}, {true, 2}}};

}  // namespace

std::span<const JointRow> held_rows(JointKind kind) {
  if (kind == JointKind::kFixed) return kFixed;
  return kind == JointKind::kHinge ? kHinge : kSlider;
}

std::array<double, kMaxRowsPerJoint> JointFrames::off(JointKind kind, const Pose& rest) const {
  const glm::dquat into = glm::conjugate(second.orientation);
  glm::dvec3 apart = into * (first.position - second.position);
  glm::dvec3 turned;
  if (kind == JointKind::kHinge) {
    // Its axes are apart by the sine of the angle between them.
    turned = glm::cross(glm::dvec3(0, 1, 0), into * (first.orientation * glm::dvec3(0, 1, 0)));
  } else if (kind == JointKind::kSlider) {
    turned = into * rotation_between(second.orientation, first.orientation);
  } else {
    apart -= rest.position;
    turned = into * rotation_between(second.orientation * rest.orientation, first.orientation);
  }
  std::array<double, kMaxRowsPerJoint> values{};
  const auto rows = held_rows(kind);
  for (std::size_t r = 0; r < rows.size(); ++r) values[r] = (rows[r].turning ? turned : apart)[rows[r].axis];
  return values;
}

double JointFrames::coordinate(JointKind kind) const {
  if (kind == JointKind::kFixed) return glm::distance(first.position, second.position);
  const glm::dquat into = glm::conjugate(second.orientation);
  if (kind == JointKind::kSlider) return (into * (first.position - second.position)).y;
  const glm::dquat turn = into * first.orientation;
  return std::remainder(2.0 * std::atan2(turn.y, turn.w), 2.0 * std::numbers::pi);
}

}  // namespace slosh
