#include "peer/devices/admittance_motion.h"

namespace slosh {
namespace {

glm::dvec3 at_most(const glm::dvec3& v, double most) {
  const double length = glm::length(v);
  return length > most ? v * (most / length) : v;
}

/// A velocity without the part that leads farther out along `off`.
glm::dvec3 not_outward(const glm::dvec3& velocity, const glm::dvec3& off) {
  const double square = glm::dot(off, off);
  const double outward = glm::dot(velocity, off);
  return square > 0.0 && outward > 0.0 ? velocity - (outward / square) * off : velocity;
}

}  // namespace

void AdmittanceMotion::begin(const Pose& at) noexcept {
  measured_ = pose_ = at;
  twist_ = Twist{};
  by_hand_ = Wrench{};
}

void AdmittanceMotion::sense(const Pose& at, const Wrench& by_hand) noexcept {
  measured_ = at;
  by_hand_ = by_hand;
}

void AdmittanceMotion::stand() noexcept {
  twist_ = Twist{};
  by_hand_ = Wrench{};
}

void AdmittanceMotion::advance(const Wrench& on_hand, double seconds) noexcept {
  const AdmittanceSettings& s = settings_;
  const glm::dvec3 force = by_hand_.force + on_hand.force;
  const glm::dvec3 torque = by_hand_.torque + on_hand.torque;
  twist_.linear = (twist_.linear + seconds / s.mass * force) / (1.0 + seconds * s.damping / s.mass);
  twist_.angular =
      (twist_.angular + seconds / s.inertia * torque) / (1.0 + seconds * s.rotational_damping / s.inertia);
  twist_.linear = at_most(twist_.linear, s.max_speed);
  twist_.angular = at_most(twist_.angular, s.max_turning);
  pose_.position += seconds * twist_.linear;
  pose_.orientation = rotate_by(pose_.orientation, seconds * twist_.angular);

  const glm::dvec3 off = pose_.position - measured_.position;
  if (glm::length(off) > leash()) {
    pose_.position = measured_.position + at_most(off, leash());
    twist_.linear = not_outward(twist_.linear, off);
  }
  const glm::dvec3 turned = rotation_between(measured_.orientation, pose_.orientation);
  if (glm::length(turned) > turning_leash()) {
    pose_.orientation = rotate_by(measured_.orientation, at_most(turned, turning_leash()));
    twist_.angular = not_outward(twist_.angular, turned);
  }
}

}  // namespace slosh
