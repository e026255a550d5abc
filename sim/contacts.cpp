#include "sim/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slosh {

namespace {

constexpr int kIterations = 30;
constexpr double kOverlapRate = 0.2;   // share of the overlap undone a step
constexpr double kOverlapSpeed = 0.5;  // m/s at most while undoing it
constexpr double kBounceSpeed = 0.3;   // m/s below which nothing bounces: resting contacts stay at rest

struct Bounds {
  glm::dvec3 lower, upper;
};

Bounds world_bounds(const Pose& pose, const glm::vec3& lower, const glm::vec3& upper) {
  const glm::dvec3 center = transform_point(pose, 0.5 * glm::dvec3(lower + upper));
  const glm::dvec3 half = 0.5 * glm::dvec3(upper - lower);
  const glm::dmat3 r = glm::mat3_cast(pose.orientation);
  const glm::dvec3 reach = glm::abs(r[0]) * half.x + glm::abs(r[1]) * half.y + glm::abs(r[2]) * half.z;
  return {center - reach, center + reach};
}

bool apart(const Bounds& a, const Bounds& b, double margin) {
  return glm::any(glm::greaterThan(a.lower - margin, b.upper)) ||
         glm::any(glm::greaterThan(b.lower - margin, a.upper));
}

// A unit impulse along `direction` at `arm` as a generalised force, and what it does to the body's velocity.
struct Row {
  Vector6 force{};
  Vector6 response{};
};

Row make_row(const RigidBody& body, const BodySolve& solve, const glm::dvec3& arm,
             const glm::dvec3& direction) {
  Row row;
  if (!solve.moves) return row;
  const glm::dvec3 moment = body.point ? glm::dvec3(0.0) : glm::cross(arm, direction);
  row.force = {direction.x, direction.y, direction.z, moment.x, moment.y, moment.z};
  row.response = cholesky_solve(solve.factor, row.force);
  return row;
}

double dot(const Vector6& a, const Vector6& b) {
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

Constraint make_constraint(const Contact& c, const glm::dvec3& direction,
                           const std::vector<RigidBody>& bodies, const std::vector<BodySolve>& solves) {
  Constraint k;
  k.on_a = make_row(bodies[c.a], solves[c.a], c.point - bodies[c.a].position, direction);
  k.on_b = make_row(bodies[c.b], solves[c.b], c.point - bodies[c.b].position, -direction);
  const double give = dot(k.on_a.force, k.on_a.response) + dot(k.on_b.force, k.on_b.response);
  k.effective_mass = give > 0.0 ? 1.0 / give : 0.0;
  return k;
}

double speed_along(const Constraint& k, const Vector6& a, const Vector6& b) {
  return dot(k.on_a.force, a) + dot(k.on_b.force, b);
}

void apply(Constraint& k, double impulse, Vector6& a, Vector6& b) {
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

ContactRows make_rows(const Contact& c, const Scene& scene, const std::vector<RigidBody>& bodies, double dt,
                      const std::vector<BodySolve>& solves) {
  ContactRows rows;
  const glm::dvec3 u = glm::normalize(std::abs(c.normal.y) < 0.9 ? glm::cross(c.normal, glm::dvec3(0, 1, 0))
                                                                 : glm::cross(c.normal, glm::dvec3(1, 0, 0)));
  rows.normal = make_constraint(c, c.normal, bodies, solves);
  rows.tangent_u = make_constraint(c, u, bodies, solves);
  rows.tangent_v = make_constraint(c, glm::cross(c.normal, u), bodies, solves);
  // A gap may close within the step; an overlap opens at a bounded rate.
  rows.target =
      c.distance > 0.0 ? -c.distance / dt : std::min(-c.distance * kOverlapRate / dt, kOverlapSpeed);
  const double approach =
      -glm::dot(c.normal, bodies[c.a].velocity_at(c.point) - bodies[c.b].velocity_at(c.point));
  const double restitution = std::max(scene.bodies[c.a].restitution, scene.bodies[c.b].restitution);
  if (c.distance <= 0.0 && approach > kBounceSpeed)
    rows.target = std::max(rows.target, restitution * approach);
  rows.friction = std::min(scene.bodies[c.a].friction, scene.bodies[c.b].friction);
  return rows;
}

void solve_tangent(Constraint& k, double limit, Vector6& a, Vector6& b) {
  const double wanted = k.impulse - k.effective_mass * speed_along(k, a, b);
  apply(k, std::clamp(wanted, -limit, limit) - k.impulse, a, b);
}

}  // namespace

ContactFinder::ContactFinder(const Scene& scene, const SampledScene& sampled) : spacing_(sampled.spacing) {
  shapes_.resize(scene.bodies.size());
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    if (scene.bodies[i].point_probe) continue;
    Shape& shape = shapes_[i];
    shape.points = sampled.surfaces[i].positions;
    shape.normals = sampled.surfaces[i].normals;
    shape.field = sampled.distance_fields[i];
    if (shape.points.empty()) continue;
    shape.lower = shape.upper = shape.points.front();
    for (const glm::vec3& p : shape.points) {
      shape.lower = glm::min(shape.lower, p);
      shape.upper = glm::max(shape.upper, p);
    }
  }
}

void ContactFinder::points_against_field(const std::vector<RigidBody>& bodies, int points_of, int field_of,
                                         double margin) {
  const Shape& points = shapes_[points_of];
  const Shape& solid = shapes_[field_of];
  if (solid.field.distance.empty()) return;
  const Pose solid_pose = bodies[field_of].mesh_pose();
  const Pose to_solid = compose(inverse(solid_pose), bodies[points_of].mesh_pose());
  const glm::mat3 turn(glm::mat3_cast(to_solid.orientation));
  const glm::vec3 shift(to_solid.position);
  const glm::vec3 lower = solid.lower - static_cast<float>(margin);
  const glm::vec3 upper = solid.upper + static_cast<float>(margin);
  const DistanceFieldView field = solid.field.view();
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const glm::vec3 p = turn * points.points[i] + shift;
    if (glm::any(glm::lessThan(p, lower)) || glm::any(glm::greaterThan(p, upper))) continue;
    const DistanceSample s = sample_distance(field, p);
    if (!(s.distance < margin)) continue;
    const float length = glm::length(s.gradient);
    if (!(length > 1e-3f)) continue;  // the middle of a solid: other points have the direction
    const glm::dvec3 outward = solid_pose.orientation * glm::dvec3(s.gradient / length);
    found_.push_back({points_of, field_of, transform_point(solid_pose, glm::dvec3(p)), outward, s.distance});
    facing_.push_back(-glm::dot(turn * points.normals[i], s.gradient / length));
  }
}

// A table's point just ahead of a box that slides on it lies beside the box: the way out of the box is along
// the table, and the box would run into it. Where points this close disagree about the direction, the one
// whose two surfaces face each other knows better.
void ContactFinder::drop_misleading() {
  constexpr double kClearly = 0.1;
  if (found_.empty()) return;
  const double reach = 1.5 * spacing_;
  const double best = *std::max_element(facing_.begin(), facing_.end());
  std::size_t kept = 0;
  std::vector<char> misleading(found_.size(), 0);
  for (std::size_t i = 0; i < found_.size(); ++i) {
    if (facing_[i] > best - kClearly) continue;
    for (std::size_t j = 0; j < found_.size() && !misleading[i]; ++j) {
      misleading[i] =
          facing_[j] > facing_[i] + kClearly && glm::distance(found_[i].point, found_[j].point) < reach;
    }
  }
  for (std::size_t i = 0; i < found_.size(); ++i) {
    if (!misleading[i]) found_[kept++] = found_[i];
  }
  found_.resize(kept);
}

// The deepest point, then again and again the point furthest from those kept: few points that span the patch,
// so that a flat bottom rests on its rim and not on a corner of it.
void ContactFinder::keep_spread(std::vector<Contact>& contacts) {
  if (found_.empty()) return;
  std::vector<double> gap(found_.size(), std::numeric_limits<double>::infinity());
  auto next = std::min_element(found_.begin(), found_.end(),
                               [](const Contact& a, const Contact& b) { return a.distance < b.distance; }) -
              found_.begin();
  for (int kept = 0; kept < kMaxContactsPerPair; ++kept) {
    const Contact chosen = found_[next];
    contacts.push_back(chosen);
    for (std::size_t i = 0; i < found_.size(); ++i) {
      gap[i] = std::min(gap[i], glm::distance(found_[i].point, chosen.point));
    }
    next = std::max_element(gap.begin(), gap.end()) - gap.begin();
    if (gap[next] < spacing_) return;
  }
}

void ContactFinder::find(const std::vector<RigidBody>& bodies, double margin,
                         std::vector<Contact>& contacts) {
  contacts.clear();
  const int count = static_cast<int>(bodies.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      if (!bodies[i].free && !bodies[j].free) continue;
      if (shapes_[i].points.empty() || shapes_[j].points.empty()) continue;
      if (apart(world_bounds(bodies[i].mesh_pose(), shapes_[i].lower, shapes_[i].upper),
                world_bounds(bodies[j].mesh_pose(), shapes_[j].lower, shapes_[j].upper), margin)) {
        continue;
      }
      found_.clear();
      facing_.clear();
      points_against_field(bodies, i, j, margin);
      points_against_field(bodies, j, i, margin);
      drop_misleading();
      keep_spread(contacts);
    }
  }
}

void solve_contacts(const std::vector<Contact>& contacts, const Scene& scene,
                    const std::vector<RigidBody>& bodies, double dt, std::vector<BodySolve>& solves) {
  std::vector<ContactRows> rows;
  rows.reserve(contacts.size());
  for (const Contact& c : contacts) rows.push_back(make_rows(c, scene, bodies, dt, solves));
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      Vector6& a = solves[contacts[i].a].velocity;
      Vector6& b = solves[contacts[i].b].velocity;
      Constraint& n = rows[i].normal;
      const double wanted = n.impulse + n.effective_mass * (rows[i].target - speed_along(n, a, b));
      apply(n, std::max(wanted, 0.0) - n.impulse, a, b);
      const double limit = rows[i].friction * n.impulse;
      solve_tangent(rows[i].tangent_u, limit, a, b);
      solve_tangent(rows[i].tangent_v, limit, a, b);
    }
  }
}

}  // namespace slosh
