// One contact as rows of a velocity solve: along the normal, and along two tangents for friction.
#pragma once

#include "sim/bodies/body_solve.h"

namespace slosh {

/// One touching point. The normal points from `b` to `a`, world.
struct Contact {
  int a = 0, b = 0;
  glm::dvec3 point{0.0};   ///< world
  glm::dvec3 normal{0.0};  ///< unit
  double distance = 0.0;   ///< m, negative when the bodies overlap
};

struct ContactMaterial {
  double friction = 0.0;     ///< Coulomb
  double restitution = 0.0;  ///< 0–1
};

inline constexpr double kOverlapRate = 0.2;   ///< share of the overlap undone a step
inline constexpr double kOverlapSpeed = 0.5;  ///< m/s at most while undoing it
inline constexpr double kBounceSpeed =
    0.3;  ///< m/s below which nothing bounces: resting contacts stay at rest

namespace rows {

// A unit impulse along `direction` at `arm` as a generalised force, and what it does to the body's velocity.
struct Row {
  Vector6 force{};
  Vector6 response{};
};

SLOSH_HD inline Row make_row(const RigidBody& body, const BodySolve& solve, const glm::dvec3& arm,
                             const glm::dvec3& direction) {
  Row row;
  if (!solve.moves) return row;
  const glm::dvec3 moment = body.point ? glm::dvec3(0.0) : glm::cross(arm, direction);
  row.force = {direction.x, direction.y, direction.z, moment.x, moment.y, moment.z};
  row.response = cholesky_solve(solve.factor, row.force);
  return row;
}

SLOSH_HD inline double dot(const Vector6& a, const Vector6& b) {
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

// One direction of one contact: relative velocity is a's minus b's.
struct Constraint {
  Row on_a, on_b;
  double effective_mass = 0.0;
  double impulse = 0.0;
};

SLOSH_HD inline Constraint make_constraint(const Contact& c, const glm::dvec3& direction,
                                           const RigidBody* bodies, const BodySolve* solves) {
  Constraint k;
  k.on_a = make_row(bodies[c.a], solves[c.a], c.point - bodies[c.a].position, direction);
  k.on_b = make_row(bodies[c.b], solves[c.b], c.point - bodies[c.b].position, -direction);
  const double give = dot(k.on_a.force, k.on_a.response) + dot(k.on_b.force, k.on_b.response);
  k.effective_mass = give > 0.0 ? 1.0 / give : 0.0;
  return k;
}

SLOSH_HD inline double speed_along(const Constraint& k, const Vector6& a, const Vector6& b) {
  return dot(k.on_a.force, a) + dot(k.on_b.force, b);
}

SLOSH_HD inline void apply(Constraint& k, double impulse, Vector6& a, Vector6& b) {
  k.impulse += impulse;
  for (int i = 0; i < 6; ++i) {
    a[i] += impulse * k.on_a.response[i];
    b[i] += impulse * k.on_b.response[i];
  }
}

struct ContactRows {
  Constraint normal, tangent_u, tangent_v;
  double target = 0.0;  // least speed along the normal, m/s
  double friction = 0.0;
};

SLOSH_HD inline ContactRows make_rows(const Contact& c, const ContactMaterial& material,
                                      const RigidBody* bodies, double dt, const BodySolve* solves) {
  ContactRows rows;
  const glm::dvec3 u = glm::normalize(std::abs(c.normal.y) < 0.9 ? glm::cross(c.normal, glm::dvec3(0, 1, 0))
                                                                 : glm::cross(c.normal, glm::dvec3(1, 0, 0)));
  rows.normal = make_constraint(c, c.normal, bodies, solves);
  rows.tangent_u = make_constraint(c, u, bodies, solves);
  rows.tangent_v = make_constraint(c, glm::cross(c.normal, u), bodies, solves);
  // A gap may close within the step; an overlap opens at a bounded rate.
  rows.target =
      c.distance > 0.0 ? -c.distance / dt : glm::min(-c.distance * kOverlapRate / dt, kOverlapSpeed);
  const double approach =
      -glm::dot(c.normal, bodies[c.a].velocity_at(c.point) - bodies[c.b].velocity_at(c.point));
  if (c.distance <= 0.0 && approach > kBounceSpeed)
    rows.target = glm::max(rows.target, material.restitution * approach);
  rows.friction = material.friction;
  return rows;
}

SLOSH_HD inline void solve_tangent(Constraint& k, double limit, Vector6& a, Vector6& b) {
  const double wanted = k.impulse - k.effective_mass * speed_along(k, a, b);
  apply(k, glm::clamp(wanted, -limit, limit) - k.impulse, a, b);
}

/// One turn of Gauss–Seidel on one contact.
SLOSH_HD inline void solve_once(ContactRows& rows, Vector6& a, Vector6& b) {
  Constraint& n = rows.normal;
  const double wanted = n.impulse + n.effective_mass * (rows.target - speed_along(n, a, b));
  apply(n, glm::max(wanted, 0.0) - n.impulse, a, b);
  const double limit = rows.friction * n.impulse;
  solve_tangent(rows.tangent_u, limit, a, b);
  solve_tangent(rows.tangent_v, limit, a, b);
}

}  // namespace rows

}  // namespace slosh
