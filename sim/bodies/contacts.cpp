#include "sim/bodies/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slosh {

namespace {

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

}  // namespace slosh
