// A person's arm on a handle: mass, damper and spring about where the person wants the hand.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace slosh {

/// One of both: m, N, N/m, N·s/m, kg; or rad, N·m, N·m/rad, N·m·s/rad, kg·m². All > 0.
struct ArmImpedance {
  double mass = 1.0;
  double damping = 1.0;
  double stiffness = 1.0;
};

struct ArmState {
  glm::dvec3 place{0.0};     ///< off where it is wanted
  glm::dvec3 velocity{0.0};  ///< against the wanted place's
};

/// The arm `seconds` later under a constant force: the closed form of m·ẍ + b·ẋ + k·x = f, so that no step is
/// too long to be stable.
inline ArmState arm_after(const ArmImpedance& arm, const ArmState& now, const glm::dvec3& force,
                          double seconds) {
  const double decay = arm.damping / (2.0 * arm.mass);
  const double square = decay * decay - arm.stiffness / arm.mass;
  const double pace = std::sqrt(std::abs(square));
  // Of the two solutions, even and odd in time; where they fall together both have a limit.
  double even = 1.0;
  double odd = seconds;
  if (pace * seconds > 1e-6) {
    even = square < 0.0 ? std::cos(pace * seconds) : std::cosh(pace * seconds);
    odd = (square < 0.0 ? std::sin(pace * seconds) : std::sinh(pace * seconds)) / pace;
  }
  const double fade = std::exp(-decay * seconds);
  const glm::dvec3 rest = force / arm.stiffness;
  const glm::dvec3 off = now.place - rest;
  return {rest + fade * ((even + decay * odd) * off + odd * now.velocity),
          fade * ((even - decay * odd) * now.velocity - (arm.stiffness / arm.mass) * odd * off)};
}

/// The angular velocity of a rotation vector `turn` (rad) that changes by `rate` (rad/s): the left Jacobian
/// of SO(3).
inline glm::dvec3 angular_velocity_of(const glm::dvec3& turn, const glm::dvec3& rate) {
  const double angle = glm::length(turn);
  const glm::dvec3 across = glm::cross(turn, rate);
  if (angle < 1e-6) return rate + 0.5 * across;
  const double square = angle * angle;
  return rate + (1.0 - std::cos(angle)) / square * across +
         (angle - std::sin(angle)) / (square * angle) * glm::cross(turn, across);
}

}  // namespace slosh
