// Couplings integrated implicitly, and the leap-frog of a rigid body (paper, section 4.2 and 4.3).
#pragma once

#include <cmath>
#include <span>

#include "sim/bodies/rigid_body.h"
#include "sim/math/coupling.h"
#include "sim/math/dense.h"

namespace slosh {

/// A coupling for one step, with its lever arm on the body.
struct ActiveCoupling {
  int grip = 0;
  int body = 0;
  CouplingGains gains;  ///< ramped
  Pose handle;
  Twist handle_twist;
  glm::dvec3 arm{0.0};  ///< grip − centre of mass, world
  Pose grip_pose;       ///< world, at the start of the step
};

/// One body's velocity solve: M v⁺ = rhs with the couplings' stiffness and damping implicit in M, so that no
/// stiffness can blow the step up. Contacts then act on v⁺ through M⁻¹.
struct BodySolve {
  bool moves = false;   ///< false: nothing changes the body's velocity this step
  bool driven = false;  ///< it does not move by itself but goes by `velocity`; else it stands
  Matrix6 factor{};     ///< Cholesky of M (linear first, angular after)
  Vector6 velocity{};   ///< v⁺, ω⁺
  Vector6
      travel{};  ///< by which the pose moves on: v⁺ unless a contact has to put it elsewhere than v⁺ would
};

namespace body_solve {

SLOSH_HD inline glm::dmat3 cross_matrix(const glm::dvec3& r) {
  // glm is column-major: this is the matrix X with X·v = r × v.
  return {0.0, r.z, -r.y, -r.z, 0.0, r.x, r.y, -r.x, 0.0};
}

SLOSH_HD inline void add_block(Matrix6& matrix, int row, int column, const glm::dmat3& block) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix[row + i][column + j] += block[j][i];
  }
}

SLOSH_HD inline void add_vector(Vector6& vector, int row, const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) vector[row + i] += v[i];
}

// The coupling's force at the step's start and the gain on the velocity at its end, F = at_rest − gain · v⁺.
struct Linearised {
  Wrench at_rest;
  double gain = 0.0;
  double rotational_gain = 0.0;
};

SLOSH_HD inline Linearised linearise(const ActiveCoupling& c, double dt) {
  Linearised result;
  result.gain = c.gains.damping + c.gains.stiffness * dt;
  result.rotational_gain = c.gains.rotational_damping + c.gains.rotational_stiffness * dt;
  result.at_rest.force =
      c.gains.stiffness * (c.handle.position - c.grip_pose.position) + result.gain * c.handle_twist.linear;
  result.at_rest.torque =
      c.gains.rotational_stiffness * rotation_between(c.grip_pose.orientation, c.handle.orientation) +
      result.rotational_gain * c.handle_twist.angular;
  return result;
}

SLOSH_HD inline Vector6 twist_of(const RigidBody& body) {
  const glm::dvec3& v = body.velocity;
  const glm::dvec3& w = body.angular_velocity;
  return {v.x, v.y, v.z, w.x, w.y, w.z};
}

SLOSH_HD inline glm::dvec3 linear_part(const Vector6& v) {
  return {v[0], v[1], v[2]};
}
SLOSH_HD inline glm::dvec3 angular_part(const Vector6& v) {
  return {v[3], v[4], v[5]};
}

}  // namespace body_solve

/// The system of one step, matrix · (v⁺, ω⁺) = rhs, for solve_body().
// Always inline: what the compiler fuses in it must not depend on how many callers it has, or a run's hash
// would.
SLOSH_HD __attribute__((always_inline)) inline void assemble_body(const RigidBody& body,
                                                                  const Wrench& external,
                                                                  std::span<const ActiveCoupling> couplings,
                                                                  double dt, Matrix6& matrix, Vector6& rhs,
                                                                  const Matrix6* drag = nullptr) {
  body_solve::add_block(matrix, 0, 0, glm::dmat3(body.mass));
  body_solve::add_block(matrix, 3, 3, body.world_inertia());
  body_solve::add_vector(rhs, 0, body.mass * body.velocity + dt * external.force);
  if (!body.point) body_solve::add_vector(rhs, 3, body.angular_momentum + dt * external.torque);
  if (drag) {
    const Vector6 twist = body_solve::twist_of(body);
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        matrix[i][j] += dt * (*drag)[i][j];
        rhs[i] += dt * (*drag)[i][j] * twist[j];
      }
    }
  }
  for (const ActiveCoupling& c : couplings) {
    const body_solve::Linearised f = body_solve::linearise(c, dt);
    const glm::dvec3 arm = body.point ? glm::dvec3(0.0) : c.arm;
    const glm::dmat3 lever = body_solve::cross_matrix(arm);
    const double d = dt * f.gain;
    body_solve::add_block(matrix, 0, 0, glm::dmat3(d));
    body_solve::add_block(matrix, 0, 3, -d * lever);
    body_solve::add_block(matrix, 3, 0, d * lever);
    body_solve::add_block(matrix, 3, 3, -d * (lever * lever));
    body_solve::add_vector(rhs, 0, dt * f.at_rest.force);
    if (!body.point) {
      body_solve::add_block(matrix, 3, 3, glm::dmat3(dt * f.rotational_gain));
      body_solve::add_vector(rhs, 3, dt * (glm::cross(arm, f.at_rest.force) + f.at_rest.torque));
    }
  }
}

/// Sets up and solves the implicit step of a free body under `external` (fluid + gravity, about the centre of
/// mass, at the velocity that the body has now) and its couplings, all solved together. `drag`: what
/// `external` loses for each unit of twist, implicit too; null: nothing. False when the system is not finite.
SLOSH_HD inline bool solve_body(const RigidBody& body, const Wrench& external,
                                std::span<const ActiveCoupling> couplings, double dt, BodySolve& solve,
                                const Matrix6* drag = nullptr) {
  Matrix6 matrix{};
  Vector6 rhs{};
  assemble_body(body, external, couplings, dt, matrix, rhs, drag);
  solve.moves = false;
  if (!cholesky(matrix, solve.factor)) return false;
  solve.velocity = cholesky_solve(solve.factor, rhs);
  solve.travel = solve.velocity;
  solve.moves = true;
  for (const double v : solve.velocity) solve.moves = solve.moves && std::isfinite(v);
  return solve.moves;
}

/// By how much the twist about the centre of mass changes in the step; nothing for one that stands still.
SLOSH_HD inline Twist twist_change(const RigidBody& body, const BodySolve& solve) {
  if (!solve.moves) return {};
  return {body_solve::linear_part(solve.velocity) - body.velocity,
          body_solve::angular_part(solve.velocity) - body.angular_velocity};
}

/// The wrench that `drag` gives for that change.
SLOSH_HD inline Wrench drag_of(const Matrix6& drag, const Twist& change) {
  const Vector6 twist{change.linear.x,  change.linear.y,  change.linear.z,
                      change.angular.x, change.angular.y, change.angular.z};
  Vector6 lost{};
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) lost[i] -= drag[i][j] * twist[j];
  }
  return {body_solve::linear_part(lost), body_solve::angular_part(lost)};
}

/// Takes over the solved velocity and moves the body on by one step of its travel.
SLOSH_HD inline void advance_body(RigidBody& body, const BodySolve& solve, double dt) {
  body.velocity = body_solve::linear_part(solve.velocity);
  body.position += dt * body_solve::linear_part(solve.travel);
  if (body.point) return;
  body.angular_momentum = body.world_inertia() * body_solve::angular_part(solve.velocity);
  // The momentum stays where it is while the body turns under it: ω at the half step, by two fixed-point
  // iterations of the midpoint rule.
  glm::dvec3 omega = body_solve::angular_part(solve.velocity);
  for (int i = 0; i < 2; ++i) {
    RigidBody half = body;
    half.orientation = rotate_by(body.orientation, 0.5 * dt * omega);
    const glm::dmat3 r = glm::mat3_cast(half.orientation);
    omega = r * body.inverse_inertia * glm::transpose(r) * body.angular_momentum;
  }
  omega += body_solve::angular_part(solve.travel) - body_solve::angular_part(solve.velocity);
  body.orientation = rotate_by(body.orientation, dt * omega);
  const glm::dmat3 r = glm::mat3_cast(body.orientation);
  body.angular_velocity = r * body.inverse_inertia * glm::transpose(r) * body.angular_momentum;
}

/// The wrench that the coupling put on the body during the step, at the grip, from the solved velocity.
SLOSH_HD inline Wrench coupling_wrench(const ActiveCoupling& c, const BodySolve& solve, double dt) {
  const body_solve::Linearised f = body_solve::linearise(c, dt);
  const glm::dvec3 velocity =
      body_solve::linear_part(solve.velocity) + glm::cross(body_solve::angular_part(solve.velocity), c.arm);
  return {f.at_rest.force - f.gain * velocity,
          f.at_rest.torque - f.rotational_gain * body_solve::angular_part(solve.velocity)};
}

}  // namespace slosh
