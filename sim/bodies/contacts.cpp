#include "sim/bodies/contacts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

namespace slosh {

namespace {

constexpr float kBentField = 0.02f;  // by which a gradient's length may be off 1

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

glm::dvec3 ContactFinder::Motion::velocity_at(int body, const glm::dvec3& where) const {
  if (!solves[body].moves && !solves[body].driven) return glm::dvec3(0.0);
  const glm::dvec3 turning =
      bodies[body].point ? glm::dvec3(0.0) : body_solve::angular_part(solves[body].velocity);
  return body_solve::linear_part(solves[body].velocity) + glm::cross(turning, where - bodies[body].position);
}

double ContactFinder::Motion::fastest(int body, double radius) const {
  if (!solves[body].moves && !solves[body].driven) return 0.0;
  const double arm = radius + glm::length(bodies[body].local_center);
  return glm::length(body_solve::linear_part(solves[body].velocity)) +
         arm * glm::length(body_solve::angular_part(solves[body].velocity));
}

namespace {

// Where a point that moves by `path` meets the surface, `margin` off it; its start where it is there already.
// By steps of the distance itself, so that no wall is jumped over. Infinity: not on this path.
struct Meeting {
  glm::vec3 at{0.0f};
  DistanceSample sample;
  bool found = false;
};

Meeting meet(const DistanceFieldView& field, const glm::vec3& start, const glm::vec3& path, float margin) {
  constexpr int kMaxSteps = 32;
  const float length = glm::length(path);
  float gone = 0.0f;
  Meeting meeting;
  for (int i = 0; i < kMaxSteps; ++i) {
    meeting.at = length > 0.0f ? start + path * (gone / length) : start;
    meeting.sample = sample_distance(field, meeting.at);
    meeting.found = meeting.sample.distance < margin;
    if (meeting.found) return meeting;
    if (!(gone < length)) return meeting;
    gone = std::min(length, gone + std::max(meeting.sample.distance - 0.5f * margin, 0.1f * margin));
  }
  return meeting;
}

// The gap between two flat faces that lie on each other, along `out`, the reversed normal of the one that the
// point at `at` is of; `there` is what the other's field says at it. Within a cell of an edge, and a cell
// above it, the interpolated distance is bent: too small inside, where its gradient dwindles, and round the
// edge outside. So it is read a cell above the face, where it is straight unless the edge is near, and from
// there further and further in from the edge until it rises straight off the face: bent by ten-thousandths of
// a cell a stack of ten cubes of 2 cm leaned by 0.1 to 0.5 mm, or fell (at 9.9 and 7.5 mm, where its edges do
// not lie on the field's nodes). Where no place is straight the first look still knows better than a field
// that is clearly bent at the point itself. Nothing where faces do not face each other.
std::optional<float> gap_between_faces(const DistanceFieldView& field, const glm::vec3& at,
                                       const DistanceSample& there, const glm::vec3& out) {
  constexpr float kParallel = 1e-3f;  // rad
  constexpr float kStraight = 1e-5f;  // rad: rounding
  constexpr float kStride = 0.7f;     // cells
  constexpr int kStrides = 4;
  constexpr float kFacing = 0.8f;  // cosine: round a corner the other way is 0.86 at most
  const auto along_face = [&](const DistanceSample& s) {
    return s.gradient - glm::dot(s.gradient, out) * out;
  };
  const bool straight = glm::length(along_face(there)) < kStraight;
  const bool bent = std::abs(glm::length(there.gradient) - 1.0f) > kBentField;
  if (straight && !bent) return {};  // as it is
  glm::vec3 above = at + out * field.cell;
  const DistanceSample first = sample_distance(field, above);
  if (!straight) {
    float least = kParallel;
    std::optional<float> gap;
    DistanceSample s = first;
    for (int n = 0;; ++n) {
      const glm::vec3 along = along_face(s);
      const float slope = glm::length(along);
      if (!(glm::dot(s.gradient, out) > 0.5f)) break;
      if (slope < least) {
        least = slope;
        gap = s.distance - glm::dot(above - at, out);
      }
      if (slope < kStraight || n == kStrides) break;
      above -= along * (kStride * field.cell / slope);
      s = sample_distance(field, above);
    }
    if (gap) return gap;
  }
  if (!bent) return {};
  const float length = glm::length(first.gradient);
  if (!(glm::dot(first.gradient, out) > kFacing * length) || !(length > 0.5f)) return {};
  return first.distance - field.cell;
}

// Gaps are differences of floats. Within this share of a spacing two surfaces touch; left as it is, the
// rounding would make bodies at rest tremble, and stacks wander.
constexpr double kTouching = 1e-4;

double beyond(double gap, double slack) {
  return gap > slack ? gap - slack : gap < -slack ? gap + slack : 0.0;
}

}  // namespace

void ContactFinder::points_against_field(const Motion& motion, int points_of, int field_of, double reach) {
  const Shape& points = shapes_[points_of];
  const Shape& solid = shapes_[field_of];
  if (solid.field.distance.empty()) return;
  const Pose solid_pose = motion.bodies[field_of].mesh_pose();
  const Pose to_solid = compose(inverse(solid_pose), motion.bodies[points_of].mesh_pose());
  const glm::mat3 turn(glm::mat3_cast(to_solid.orientation));
  const glm::vec3 shift(to_solid.position);
  const glm::dquat into_solid = glm::conjugate(solid_pose.orientation);
  const glm::vec3 lower = solid.lower - static_cast<float>(reach);
  const glm::vec3 upper = solid.upper + static_cast<float>(reach);
  const float margin = static_cast<float>(motion.margin);
  const bool sweeps = reach > motion.margin;
  const DistanceFieldView field = solid.field.view();
  // By clusters: a tank has thousands of points, and what floats in it comes near few.
  constexpr float kSteepest = 3.0f;  // of a trilinear distance, beyond its grid too
  near_.assign(points.points.size() / 64 + 1, 0);
  for (const Cluster& cluster : points.clusters) {
    const glm::vec3 c = turn * cluster.center + shift;
    if (glm::any(glm::lessThan(c, lower - cluster.radius)) ||
        glm::any(glm::greaterThan(c, upper + cluster.radius)) ||
        sample_distance(field, c).distance > kSteepest * (cluster.radius + static_cast<float>(reach)))
      continue;
    for (const std::uint32_t i : cluster.points) near_[i / 64] |= std::uint64_t{1} << i % 64;
  }
  const auto look_at = [&](std::size_t i) {
    const glm::vec3 p = turn * points.points[i] + shift;
    if (glm::any(glm::lessThan(p, lower)) || glm::any(glm::greaterThan(p, upper))) return;
    const glm::dvec3 where = transform_point(solid_pose, glm::dvec3(p));
    glm::vec3 path(0.0f);
    if (sweeps) {
      path = glm::vec3(into_solid * (motion.dt * (motion.velocity_at(points_of, where) -
                                                  motion.velocity_at(field_of, where))));
    }
    const Meeting met = meet(field, p, path, margin);
    if (!met.found) return;
    const float length = glm::length(met.sample.gradient);
    glm::vec3 normal = length > 0.0f ? met.sample.gradient / length : glm::vec3(0.0f);
    float distance = met.sample.distance;
    const glm::vec3 out = -(turn * points.normals[i]);
    const std::optional<float> faces =
        points.flat[i] ? gap_between_faces(field, met.at, met.sample, out) : std::nullopt;
    if (faces) {
      normal = out;
      distance = *faces;
    } else if (!(length > 1e-3f)) {
      return;  // the middle of a solid: other points have the direction
    }
    // From where the point is now to the plane that it meets.
    const double gap = distance + glm::dot(p - met.at, normal);
    found_.push_back({points_of, field_of, where, solid_pose.orientation * glm::dvec3(normal),
                      beyond(gap, kTouching * spacing_)});
    facing_.push_back(-glm::dot(turn * points.normals[i], normal));
  };
  for (std::size_t word = 0; word < near_.size(); ++word) {  // in the points' order
    for (std::uint64_t bits = near_[word]; bits; bits &= bits - 1)
      look_at(64 * word + static_cast<std::size_t>(std::countr_zero(bits)));
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

// Where the bodies touched before, as long as they do; the deepest point, where none of those is as deep;
// then again and again the point furthest from those kept: few points that span the patch, so that a flat
// bottom rests on its rim and not on a corner of it. Were the deepest always the first, rounding would choose
// the points anew in every step, and no impulse would find its contact again. Of points that lie together the
// deepest stands for all: where two corners meet, one of them is just beside the other's face, and its gap is
// the way round the edge.
void ContactFinder::keep_spread(const std::vector<RigidBody>& bodies, std::span<const KeptImpulse> known,
                                std::vector<Contact>& contacts) {
  if (found_.empty()) return;
  const std::size_t before = contacts.size();
  std::vector<double> gap(found_.size(), std::numeric_limits<double>::infinity());
  // The deepest of those within a quarter of a spacing of a point, and from there on no other near it.
  const auto choose = [&](const glm::dvec3& around) {
    const Contact* deepest = nullptr;
    for (const Contact& c : found_) {
      if (glm::distance(c.point, around) >= 0.25 * spacing_) continue;
      if (!deepest || c.distance < deepest->distance) deepest = &c;
    }
    if (!deepest) return;
    contacts.push_back(*deepest);
    for (std::size_t i = 0; i < found_.size(); ++i)
      gap[i] = std::min(gap[i], glm::distance(found_[i].point, deepest->point));
  };
  const auto full = [&] { return contacts.size() - before >= kMaxContactsPerPair; };
  for (const KeptImpulse& k : known) {
    if (k.impulse != glm::dvec3(0.0) && !full()) choose(k.place(bodies));
  }
  const auto shallower = [](const Contact& a, const Contact& b) { return a.distance < b.distance; };
  const auto deepest = std::min_element(found_.begin(), found_.end(), shallower);
  const bool deeper = std::all_of(contacts.begin() + static_cast<std::ptrdiff_t>(before), contacts.end(),
                                  [&](const Contact& c) { return shallower(*deepest, c); });
  if (deeper && !full()) choose(deepest->point);
  while (!full()) {
    const auto next = std::max_element(gap.begin(), gap.end()) - gap.begin();
    if (gap[next] < spacing_) return;
    choose(found_[static_cast<std::size_t>(next)].point);
  }
}

void ContactFinder::find(const std::vector<RigidBody>& bodies, const std::vector<BodySolve>& solves,
                         double margin, double dt, const ContactMemory& memory,
                         std::vector<Contact>& contacts, const std::set<std::pair<int, int>>& elsewhere) {
  contacts.clear();
  const Motion motion{bodies, solves, margin, dt};
  const int count = static_cast<int>(bodies.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      if (!bodies[i].free && !bodies[j].free) continue;
      if (bodies[i].gone || bodies[j].gone) continue;
      if (!joined_.empty() && joined_.contains({i, j})) continue;
      if (!elsewhere.empty() && elsewhere.contains({i, j})) continue;
      if (shapes_[i].points.empty() || shapes_[j].points.empty()) continue;
      const double reach =
          margin + dt * (motion.fastest(i, shapes_[i].radius) + motion.fastest(j, shapes_[j].radius));
      if (apart(world_bounds(bodies[i].mesh_pose(), shapes_[i].lower, shapes_[i].upper),
                world_bounds(bodies[j].mesh_pose(), shapes_[j].lower, shapes_[j].upper), reach)) {
        continue;
      }
      found_.clear();
      facing_.clear();
      points_against_field(motion, i, j, reach);
      points_against_field(motion, j, i, reach);
      drop_misleading();
      keep_spread(bodies, memory.between(i, j), contacts);
    }
  }
}

}  // namespace slosh
