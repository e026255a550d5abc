// What acts on a held body besides its couplings, as a local linear model that is safe to integrate.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "peer/haptics/replica/slosh_mode.h"
#include "sim/math/dense.h"
#include "sim/math/pose.h"

namespace slosh {

constexpr double kGoesOnTaken = 0.01;  ///< s over which a change of FluidLoad::goes_on is taken over

/// W = wrench + d_pose·δx + d_velocity·δv about a reference state: what acts on a body besides its couplings.
/// Order of the six: linear x, y, z, angular x, y, z; world axes; torque about the centre of mass. All zero:
/// nothing acts.
struct FluidLoad {
  Pose reference;                   ///< of the centre of mass and the body's axes
  Twist twist;                      ///< there
  Vector6 wrench{};                 ///< N, N·m
  glm::dvec3 late{0.0};             ///< N: of `wrench`, what is foreseen …
  glm::dvec3 goes_on{0.0};          ///< N: … which is this by now: followed at once
  double foreseen = 0.0;            ///< 0–1: how far it takes the place of `late`
  Matrix6 d_pose{};                 ///< N/m, N/rad, N·m/m, N·m/rad
  Matrix6 d_velocity{};             ///< N·s/m …
  Matrix6 added_mass{};             ///< kg, kg·m, kg·m²: symmetric, positive semidefinite
  double trust_distance = 0.01;     ///< m of δx beyond which the model goes on as at that distance
  double trust_angle = 0.1;         ///< rad, the same
  std::array<SloshMode, 3> swings;  ///< along x, y, z: what swings besides, whose force `wrench` is without
  glm::dvec3 bowl{0.0};  ///< s²/m, down, 1/g long: what swings rises by it (bowl_force); 0: it does not
};

/// 0.5·(a + aᵀ)·sign.
inline Matrix6 symmetric_part(const Matrix6& a, double sign) {
  Matrix6 s{};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) s[i][j] = sign * 0.5 * (a[i][j] + a[j][i]);
  return s;
}

/// Whether `a` (symmetric) gives no energy: all eigenvalues ≥ −slack, in units of its own.
inline bool is_positive(Matrix6 a, double slack) {
  for (std::size_t i = 0; i < 6; ++i) a[i][i] += slack;
  Matrix6 factor;
  return cholesky(a, factor);
}

/// What a host says may be anything. Not finite: nothing is left of it. A damper that would drive, a spring
/// that would push away, or a mass that would pull is left out; the rest stays.
inline FluidLoad made_safe(FluidLoad load) noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    sum += load.wrench[i];
    for (std::size_t j = 0; j < 6; ++j)
      sum += load.d_pose[i][j] + load.d_velocity[i][j] + load.added_mass[i][j];
  }
  const glm::dvec3& p = load.reference.position;
  sum += p.x + p.y + p.z + load.trust_distance + load.trust_angle + load.late.x + load.late.y + load.late.z +
         load.goes_on.x + load.goes_on.y + load.goes_on.z + load.foreseen +
         glm::dot(load.twist.linear, load.twist.linear) + glm::dot(load.twist.angular, load.twist.angular);
  if (!std::isfinite(sum) || !std::isfinite(glm::dot(load.reference.orientation, load.reference.orientation)))
    return FluidLoad{};
  constexpr double kSlack = 1e-6;
  if (!is_positive(symmetric_part(load.d_velocity, -1.0), kSlack)) load.d_velocity = Matrix6{};
  if (!is_positive(symmetric_part(load.d_pose, -1.0), kSlack)) load.d_pose = Matrix6{};
  if (!is_positive(symmetric_part(load.added_mass, 1.0), kSlack)) load.added_mass = Matrix6{};
  return load;
}

}  // namespace slosh
