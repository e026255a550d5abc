// The fluid's wrench on a body, as a line through what it is now: what a device loop between two states of
// the world computes with.
#pragma once

#include <algorithm>
#include <cstdint>

#include "sim/math/dense.h"
#include "sim/math/host_device.h"
#include "sim/math/pose.h"

namespace slosh {

/// The wrench W that fluid puts on one body, near one state of it, about its centre of mass, world axes, SI:
///
///   W = wrench + rate · age + d_pose · δx + d_velocity · δv,    M · dV/dt = W + …,  M = inertia + added_mass
///
/// δx = (position, rotation vector) and δv = (linear, angular) of the body less those of the reference. In
/// 6-vectors and 6×6 matrices force and linear come first, torque and angular after. Whoever uses it moves
/// the body with added_mass in its inertia: `wrench` is without what the fluid gave for being accelerated.
///
/// d_pose and d_velocity are symmetric and negative semidefinite: the spring and the damper that the model
/// adds can store and take energy, not make any. `wrench` and `rate` are what the world's fluid does by
/// itself, and may. sim/bodies/README.md says where each comes from.
struct FluidWrenchModel {
  std::uint32_t body = 0;  ///< index into Scene::bodies
  std::uint64_t tick = 0;  ///< BodySnapshot::tick that it goes with
  double time = 0.0;       ///< simulated s of the reference
  Pose reference;          ///< of the centre of mass, m; axes as the mesh frame's
  Twist twist;             ///< of the centre of mass, m/s, rad/s

  Wrench wrench;            ///< N, N·m, at the reference
  Wrench rate;              ///< N/s, N·m/s: how it goes on by itself, whatever the body does
  double rate_span = 0.0;   ///< s that `rate` may be carried on for; later the wrench stays. >= 0
  Matrix6 d_pose{};         ///< N/m, N/rad, N·m/m, N·m/rad
  Matrix6 d_velocity{};     ///< N·s/m, N·s/rad, N·m·s/m, N·m·s/rad
  Matrix6 added_mass{};     ///< kg, kg·m, kg·m²; symmetric, positive semidefinite
  double trust_radius = 0;  ///< m from the reference up to which the line is to be trusted, >= 0
  double trust_angle = 0;   ///< rad, likewise
};

namespace fluid_wrench_detail {

SLOSH_HD inline glm::dvec3 at_most(const glm::dvec3& v, double limit) {
  const double length = glm::length(v);
  return length > limit ? v * (limit / length) : v;
}

/// 1 up to `limit`, 0 from twice that on.
SLOSH_HD inline double trust(double distance, double limit) {
  if (distance <= limit) return 1.0;
  return limit > 0.0 ? std::max(0.0, 2.0 - distance / limit) : 0.0;
}

}  // namespace fluid_wrench_detail

/// The wrench that fluid puts on the body at this pose of its centre of mass and this twist, `age` s of
/// simulated time after the reference (below 0 counts as 0). Continuous; beyond the trust radius the spring's
/// deflection stays at it and the damping fades, to nothing at twice the radius. The fading of an old model
/// as a whole is the caller's. Finite for finite arguments.
SLOSH_HD inline Wrench fluid_wrench(const FluidWrenchModel& model, const Pose& center, const Twist& twist,
                                    double age) {
  namespace detail = fluid_wrench_detail;
  const glm::dvec3 moved = center.position - model.reference.position;
  const glm::dvec3 turned = rotation_between(model.reference.orientation, center.orientation);
  const double trust = std::min(detail::trust(glm::length(moved), model.trust_radius),
                                detail::trust(glm::length(turned), model.trust_angle));
  const glm::dvec3 near = detail::at_most(moved, model.trust_radius);
  const glm::dvec3 near_turn = detail::at_most(turned, model.trust_angle);
  const glm::dvec3 faster = trust * (twist.linear - model.twist.linear);
  const glm::dvec3 faster_turn = trust * (twist.angular - model.twist.angular);
  const double carried = std::clamp(age, 0.0, model.rate_span);
  const Vector6 dx{near.x, near.y, near.z, near_turn.x, near_turn.y, near_turn.z};
  const Vector6 dv{faster.x, faster.y, faster.z, faster_turn.x, faster_turn.y, faster_turn.z};
  Vector6 sum{};
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) sum[i] += model.d_pose[i][j] * dx[j] + model.d_velocity[i][j] * dv[j];
  }
  return {model.wrench.force + carried * model.rate.force + glm::dvec3(sum[0], sum[1], sum[2]),
          model.wrench.torque + carried * model.rate.torque + glm::dvec3(sum[3], sum[4], sum[5])};
}

}  // namespace slosh
