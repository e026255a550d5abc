#include "peer/devices/spacemouse_motion.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

constexpr double kMaxMouseElapsed = 0.05;  // s: a machine that stood still does not throw the hand
constexpr double kStep = 0.001;            // s, of the filters

}  // namespace

SpaceMouseMotion::SpaceMouseMotion(const SpaceMouseSettings& settings, const Pose& start,
                                   const glm::dquat& camera)
    : settings_(settings),
      camera_(settings.by_camera ? camera : glm::dquat(1.0, 0.0, 0.0, 0.0)),
      pose_(start),
      center_(start),
      engaged_(settings.deadman_button == 0) {}

void SpaceMouseMotion::look_from(const glm::dquat& camera) noexcept {
  if (settings_.by_camera) camera_ = camera;
}

Twist SpaceMouseMotion::deflection(const SpaceMouseState& state) const noexcept {
  std::array<double, 6> along{};
  const double full = kSpaceMouseFull - settings_.deadzone;
  for (std::size_t i = 0; i < 6; ++i) {
    const SpaceMouseSettings::Source& source = settings_.axes[i];
    const int counts = state.axes[static_cast<std::size_t>(source.axis)];
    // From 0 at the edge of the dead zone: no step there.
    const double beyond = std::max(std::abs(counts) - settings_.deadzone, 0) / full;
    along[i] = settings_.gains[i] * source.sign * std::copysign(beyond, counts);
  }
  return {camera_ * glm::dvec3(along[0], along[1], along[2]),
          camera_ * glm::dvec3(along[3], along[4], along[5])};
}

void SpaceMouseMotion::follow_rate(const Twist& deflection, double dt) noexcept {
  const double share = 1.0 - std::exp(-kFollow * dt);
  twist_.linear += share * (settings_.speed * deflection.linear - twist_.linear);
  twist_.angular += share * (settings_.turn_rate * deflection.angular - twist_.angular);
}

void SpaceMouseMotion::follow_place(const Twist& deflection, double dt) noexcept {
  const Pose wanted{center_.position + settings_.reach * deflection.linear,
                    rotate_by(center_.orientation, settings_.turn * deflection.angular)};
  const glm::dvec3 gap = wanted.position - pose_.position;
  const glm::dvec3 turn = rotation_between(pose_.orientation, wanted.orientation);
  twist_.linear += dt * (kFollow * kFollow * gap - 2.0 * kFollow * twist_.linear);
  twist_.angular += dt * (kFollow * kFollow * turn - 2.0 * kFollow * twist_.angular);
}

void SpaceMouseMotion::advance(const SpaceMouseState& state, double seconds) noexcept {
  const bool clutched = button_down(state.buttons, settings_.clutch_button);
  engaged_ = settings_.deadman_button == 0 || button_down(state.buttons, settings_.deadman_button);
  const Twist wanted = clutched ? Twist{} : deflection(state);
  if (clutched_ && !clutched) {
    // The place that the cap stands for by now is where the hand is.
    center_.position = pose_.position - settings_.reach * wanted.linear;
    center_.orientation = rotate_by(pose_.orientation, -settings_.turn * wanted.angular);
  }
  clutched_ = clutched;
  double left = std::clamp(seconds, 0.0, kMaxMouseElapsed);
  while (left > 0.0) {
    const double dt = std::min(left, kStep);
    left -= dt;
    if (settings_.rate || clutched) {
      follow_rate(wanted, dt);
    } else {
      follow_place(wanted, dt);
    }
    pose_.position += dt * twist_.linear;
    pose_.orientation = rotate_by(pose_.orientation, dt * twist_.angular);
  }
}

}  // namespace slosh
