// One contact as rows of a velocity solve: along the normal, and along two tangents for friction.
#pragma once

#include <limits>

#include "sim/bodies/body_solve.h"

namespace slosh {

/// One touching point. The normal points from `b` to `a`, world.
struct Contact {
  int a = 0, b = 0;
  glm::dvec3 point{0.0};                                 ///< world
  glm::dvec3 normal{0.0};                                ///< unit
  double distance = 0.0;                                 ///< m, negative when the bodies overlap
  double most{std::numeric_limits<double>::infinity()};  ///< N·s: at this it yields
  bool of_blade{};                                       ///< of a cut (blades.h): without friction or bounce
};

struct ContactMaterial {
  double friction = 0.0;     ///< Coulomb
  double restitution = 0.0;  ///< 0–1
};

inline constexpr double kOverlapRate = 0.2;   ///< share of the overlap undone a step
inline constexpr double kOverlapSpeed = 0.5;  ///< m/s at most while undoing it
inline constexpr double kBounceSpeed =
    0.1;  ///< m/s below which nothing bounces: resting contacts stay at rest

namespace rows {

// A unit impulse along `direction` at `arm` as a generalised force, and what it does to the body's velocity.
struct Row {
  Vector6 force{};
  Vector6 response{};
};

SLOSH_HD inline Row make_row(const RigidBody& body, const BodySolve& solve, const glm::dvec3& arm,
                             const glm::dvec3& direction) {
  Row row;
  if (!solve.moves && !solve.driven) return row;
  const glm::dvec3 moment = body.point ? glm::dvec3(0.0) : glm::cross(arm, direction);
  row.force = {direction.x, direction.y, direction.z, moment.x, moment.y, moment.z};
  if (solve.moves) row.response = cholesky_solve(solve.factor, row.force);
  return row;
}

SLOSH_HD inline double dot(const Vector6& a, const Vector6& b) {
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

SLOSH_HD inline void add_scaled(Vector6& to, double by, const Vector6& v) {
  for (int i = 0; i < 6; ++i) to[i] += by * v[i];
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

// Least speeds along the normal, m/s.
struct Targets {
  double velocity = 0.0;  // of the velocities that leave the step
  double travel = 0.0;    // of the mean over the step, which moves the poses
};

// How the gap goes on through the step, from the speeds along the normal before and after what else acts:
// with constant acceleration between the middles of two steps, as the leap-frog has it.
SLOSH_HD inline Targets targets(double gap, double speed_before, double speed_after, double restitution,
                                double dt) {
  const double acceleration = (speed_after - speed_before) / dt;
  const double speed = speed_after - 0.5 * acceleration * dt;  // at the step's beginning
  if (gap > 0.0 && gap + speed_after * dt >= 0.0)
    return {-gap / dt, -gap / dt};  // does not close in this step
  // When and how fast the two meet; at once where they already overlap.
  double impact_time = 0.0;
  double impact_speed = glm::max(-speed, 0.0);
  if (gap > 0.0) {
    impact_speed = std::sqrt(glm::max(speed * speed - 2.0 * acceleration * gap, 0.0));
    impact_time = glm::clamp(2.0 * gap / glm::max(impact_speed - speed, 1e-12), 0.0, dt);
  }
  const double rest = dt - impact_time;
  const double undo = glm::min(glm::max(-gap, 0.0) * kOverlapRate / dt, kOverlapSpeed);
  if (impact_speed < kBounceSpeed || restitution <= 0.0) return {0.0, gap > 0.0 ? -gap / dt : undo};
  const double back = restitution * impact_speed;
  const double height = glm::max(back * rest + 0.5 * acceleration * rest * rest, 0.0);
  return {glm::max(back + acceleration * (0.5 * dt - impact_time), 0.0),
          (height - glm::max(gap, 0.0)) / dt + undo};
}

struct ContactRows {
  Constraint normal, tangent_u, tangent_v;
  glm::dvec3 n{0.0}, u{0.0}, v{0.0};  // their directions
  Targets target;
  double friction = 0.0;
  double most{std::numeric_limits<double>::infinity()};  // N·s along the normal
};

SLOSH_HD inline ContactRows make_rows(const Contact& c, const ContactMaterial& material,
                                      const RigidBody* bodies, double dt, const BodySolve* solves) {
  ContactRows rows;
  const glm::dvec3 u = glm::normalize(std::abs(c.normal.y) < 0.9 ? glm::cross(c.normal, glm::dvec3(0, 1, 0))
                                                                 : glm::cross(c.normal, glm::dvec3(1, 0, 0)));
  rows.n = c.normal;
  rows.u = u;
  rows.v = glm::cross(c.normal, u);
  rows.normal = make_constraint(c, rows.n, bodies, solves);
  rows.tangent_u = make_constraint(c, rows.u, bodies, solves);
  rows.tangent_v = make_constraint(c, rows.v, bodies, solves);
  const double before =
      glm::dot(c.normal, bodies[c.a].velocity_at(c.point) - bodies[c.b].velocity_at(c.point));
  const double after = speed_along(rows.normal, solves[c.a].velocity, solves[c.b].velocity);
  rows.target = targets(c.distance, before, after, material.restitution, dt);
  rows.friction = material.friction;
  rows.most = c.most;
  return rows;
}

/// Begins with an impulse (N·s on a) in place of none, as far as the contact can give it.
SLOSH_HD inline void begin_with(ContactRows& rows, const glm::dvec3& impulse, Vector6& a, Vector6& b) {
  const double normal = glm::min(glm::max(glm::dot(impulse, rows.n), 0.0), rows.most);
  glm::dvec2 along(glm::dot(impulse, rows.u), glm::dot(impulse, rows.v));
  const double limit = rows.friction * normal;
  const double length = glm::length(along);
  if (length > limit) along *= limit / length;
  apply(rows.normal, normal, a, b);
  apply(rows.tangent_u, along.x, a, b);
  apply(rows.tangent_v, along.y, a, b);
}

/// N·s on a, so far.
SLOSH_HD inline glm::dvec3 impulse_on_a(const ContactRows& rows) {
  return rows.normal.impulse * rows.n + rows.tangent_u.impulse * rows.u + rows.tangent_v.impulse * rows.v;
}

/// The most that one iteration changed.
struct Change {
  double impulse = 0.0;  ///< N·s
  double speed = 0.0;    ///< m/s at the contact
};

/// One iteration of Gauss–Seidel on one contact: the normal, then friction in the circle that it allows.
SLOSH_HD inline Change solve_once(ContactRows& rows, double target, Vector6& a, Vector6& b) {
  Constraint& n = rows.normal;
  const double wanted = n.impulse + n.effective_mass * (target - speed_along(n, a, b));
  const double normal_change = glm::min(glm::max(wanted, 0.0), rows.most) - n.impulse;
  apply(n, normal_change, a, b);
  Constraint& u = rows.tangent_u;
  Constraint& v = rows.tangent_v;
  double along_u = u.impulse - u.effective_mass * speed_along(u, a, b);
  double along_v = v.impulse - v.effective_mass * speed_along(v, a, b);
  const double limit = rows.friction * n.impulse;
  const double length = std::sqrt(along_u * along_u + along_v * along_v);
  if (length > limit) {
    along_u *= limit / length;
    along_v *= limit / length;
  }
  const glm::dvec2 slip_change(along_u - u.impulse, along_v - v.impulse);
  apply(u, slip_change.x, a, b);
  apply(v, slip_change.y, a, b);
  const double normal = std::abs(normal_change), slip = glm::length(slip_change);
  const auto speed = [](double impulse, double mass) { return impulse > 0.0 ? impulse / mass : 0.0; };
  return {glm::max(normal, slip), glm::max(speed(normal, n.effective_mass),
                                           speed(slip, glm::min(u.effective_mass, v.effective_mass)))};
}

}  // namespace rows

}  // namespace slosh
