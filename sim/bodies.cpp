#include "sim/bodies.h"

#include <algorithm>
#include <cmath>

namespace slosh {

namespace {

glm::dmat3 cross_matrix(const glm::dvec3& r) {
  // glm is column-major: this is the matrix X with X·v = r × v.
  return {0.0, r.z, -r.y, -r.z, 0.0, r.x, r.y, -r.x, 0.0};
}

void add_block(Matrix6& matrix, int row, int column, const glm::dmat3& block) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix[row + i][column + j] += block[j][i];
  }
}

void add_vector(Vector6& vector, int row, const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) vector[row + i] += v[i];
}

// The coupling's force at the step's start and the gain on the velocity at its end, F = at_rest − gain · v⁺.
struct Linearised {
  Wrench at_rest;
  double gain = 0.0;
  double rotational_gain = 0.0;
};

Linearised linearise(const ActiveCoupling& c, double dt) {
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

glm::dvec3 linear_part(const Vector6& v) {
  return {v[0], v[1], v[2]};
}
glm::dvec3 angular_part(const Vector6& v) {
  return {v[3], v[4], v[5]};
}

}  // namespace

glm::dmat3 RigidBody::world_inertia() const {
  const glm::dmat3 r = glm::mat3_cast(orientation);
  return r * inertia * glm::transpose(r);
}

RigidBody make_rigid_body(const Body& source) {
  RigidBody body;
  body.free = source.motion == BodyMotion::kFree;
  body.point = source.point_probe;
  body.local_center = body.free ? source.mass.center_of_mass : glm::dvec3(0.0);
  body.orientation = source.pose.orientation;
  body.position = transform_point(source.pose, body.local_center);
  if (body.free) {
    body.mass = source.mass.mass;
    body.inertia = body.point ? glm::dmat3(1.0) : source.mass.inertia;
    body.inverse_inertia = glm::inverse(body.inertia);
    body.velocity = source.twist.linear;
    body.angular_velocity = body.point ? glm::dvec3(0.0) : source.twist.angular;
    body.angular_momentum = body.world_inertia() * body.angular_velocity;
  }
  return body;
}

bool solve_body(const RigidBody& body, const Wrench& external, std::span<const ActiveCoupling> couplings,
                double dt, BodySolve& solve) {
  Matrix6 matrix{};
  Vector6 rhs{};
  add_block(matrix, 0, 0, glm::dmat3(body.mass));
  add_block(matrix, 3, 3, body.world_inertia());
  add_vector(rhs, 0, body.mass * body.velocity + dt * external.force);
  if (!body.point) add_vector(rhs, 3, body.angular_momentum + dt * external.torque);
  for (const ActiveCoupling& c : couplings) {
    const Linearised f = linearise(c, dt);
    const glm::dvec3 arm = body.point ? glm::dvec3(0.0) : c.arm;
    const glm::dmat3 lever = cross_matrix(arm);
    const double d = dt * f.gain;
    add_block(matrix, 0, 0, glm::dmat3(d));
    add_block(matrix, 0, 3, -d * lever);
    add_block(matrix, 3, 0, d * lever);
    add_block(matrix, 3, 3, -d * (lever * lever));
    add_vector(rhs, 0, dt * f.at_rest.force);
    if (!body.point) {
      add_block(matrix, 3, 3, glm::dmat3(dt * f.rotational_gain));
      add_vector(rhs, 3, dt * (glm::cross(arm, f.at_rest.force) + f.at_rest.torque));
    }
  }
  solve.moves = false;
  if (!cholesky(matrix, solve.factor)) return false;
  solve.velocity = cholesky_solve(solve.factor, rhs);
  solve.moves =
      std::all_of(solve.velocity.begin(), solve.velocity.end(), [](double v) { return std::isfinite(v); });
  return solve.moves;
}

void advance_body(RigidBody& body, const BodySolve& solve, double dt) {
  body.velocity = linear_part(solve.velocity);
  body.position += dt * body.velocity;
  if (body.point) return;
  body.angular_momentum = body.world_inertia() * angular_part(solve.velocity);
  // The momentum stays where it is while the body turns under it: ω at the half step, by two fixed-point
  // iterations of the midpoint rule.
  glm::dvec3 omega = angular_part(solve.velocity);
  for (int i = 0; i < 2; ++i) {
    RigidBody half = body;
    half.orientation = rotate_by(body.orientation, 0.5 * dt * omega);
    const glm::dmat3 r = glm::mat3_cast(half.orientation);
    omega = r * body.inverse_inertia * glm::transpose(r) * body.angular_momentum;
  }
  body.orientation = rotate_by(body.orientation, dt * omega);
  const glm::dmat3 r = glm::mat3_cast(body.orientation);
  body.angular_velocity = r * body.inverse_inertia * glm::transpose(r) * body.angular_momentum;
}

Wrench coupling_wrench(const ActiveCoupling& c, const BodySolve& solve, double dt) {
  const Linearised f = linearise(c, dt);
  const glm::dvec3 velocity = linear_part(solve.velocity) + glm::cross(angular_part(solve.velocity), c.arm);
  return {f.at_rest.force - f.gain * velocity,
          f.at_rest.torque - f.rotational_gain * angular_part(solve.velocity)};
}

}  // namespace slosh
