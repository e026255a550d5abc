#include "sim/bodies/blades.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slosh {
namespace {

// Spacings: how near the surface an edge is that enters.
constexpr double kEntersFrom = 0.25;
// Of what is left before the edge: a body that lies on a table is through when the edge is on the table.
constexpr double kNothingLeft = 0.1;
// Cosine between the way of the edge and the surface's inward normal: flatter, a blade lies on the body.
constexpr double kSteepEnough = 0.3;

constexpr Extent kNothing{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

void include(double value, Extent& extent) {
  extent.least = std::min(extent.least, value);
  extent.most = std::max(extent.most, value);
}

// What of a line across a convex outline is inside it: `at` along `way`, in terms of `side`.
Extent chord(const std::vector<glm::dvec3>& outline, const glm::dvec3& way, const glm::dvec3& side,
             double at) {
  Extent inside = kNothing;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    const double before = glm::dot(way, a) - at, after = glm::dot(way, b) - at;
    if (before == 0.0) include(glm::dot(side, a), inside);
    if ((before < 0.0) == (after < 0.0) || before == after) continue;
    include(glm::dot(side, glm::mix(a, b, before / (before - after))), inside);
  }
  return inside;
}

Extent range_of(const std::vector<glm::dvec3>& points, const glm::dvec3& direction) {
  Extent range = kNothing;
  for (const glm::dvec3& p : points) include(glm::dot(direction, p), range);
  return range;
}

glm::dvec3 velocity_of(const RigidBody& body, const BodySolve& solve, const glm::dvec3& where) {
  if (!solve.moves && !solve.driven) return glm::dvec3(0.0);
  return body_solve::linear_part(solve.velocity) +
         glm::cross(body_solve::angular_part(solve.velocity), where - body.position);
}

std::pair<int, int> in_order(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

// Of a sub-step in which an edge at `now` goes by `way` (m): how much of it what is still to be cut resists.
// A fast one enters or leaves within it.
double share_inside(double now, double way, const Extent& uncut) {
  if (!(way > 0.0)) return 1.0;
  return std::clamp((std::min(now + way, uncut.most) - std::max(now, uncut.least)) / way, 0.0, 1.0);
}

bool same_pair(const Incision& incision, int blade, int body) {
  return incision.blade == blade && incision.body == body;
}

}  // namespace

// An edge as an incision has it, in the body's mesh frame.
struct Blades::Seen {
  Extent section;         // of the body along the way, m
  glm::dvec3 side{0.0};   // unit, along the edge as it entered
  Extent inside;          // of the edge, along the side, m
  glm::dvec3 start, end;  // of the same, m
  double now = 0.0;       // m along the way, of its middle
  bool spans = false;     // the edge reaches over all that the plane meets of the body
};

Blades::Blades(const Scene& scene, double spacing) : spacing_(spacing) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (!body.blade || body.mesh < 0) continue;
    const TriangleMesh& mesh = scene.meshes[static_cast<std::size_t>(body.mesh)];
    if (mesh.positions.empty()) continue;
    glm::vec3 lower = mesh.positions.front(), upper = lower;
    for (const glm::vec3& p : mesh.positions) {
      lower = glm::min(lower, p);
      upper = glm::max(upper, p);
    }
    // A handle may be longer than the edge.
    const float on_edge = lower.y + 1e-3f * (upper.y - lower.y);
    float first = upper.x, last = lower.x;
    for (const glm::vec3& p : mesh.positions) {
      if (p.y > on_edge) continue;
      first = std::min(first, p.x);
      last = std::max(last, p.x);
    }
    blades_.push_back({static_cast<int>(b),
                       {{first, lower.y, 0.0}, {last, lower.y, 0.0}},
                       static_cast<double>(upper.y - lower.y)});
  }
}

std::optional<Blades::Seen> Blades::see(const Blade& blade, const Incision& incision,
                                        const std::vector<RigidBody>& bodies, const CutBodies& cuts) const {
  const std::vector<glm::dvec3> outline = section(cuts.solid(incision.body), incision.plane);
  if (outline.empty()) return std::nullopt;
  Seen seen;
  seen.section = range_of(outline, incision.way);
  seen.side = glm::cross(incision.plane.normal, incision.way);
  const Pose to_body = compose(inverse(bodies[static_cast<std::size_t>(incision.body)].mesh_pose()),
                               bodies[static_cast<std::size_t>(blade.body)].mesh_pose());
  glm::dvec3 start = transform_point(to_body, blade.ends[0]), end = transform_point(to_body, blade.ends[1]);
  if (glm::dot(seen.side, end - start) < 0.0) std::swap(start, end);
  const double first = glm::dot(seen.side, start), last = glm::dot(seen.side, end);
  const auto at = [&](double side) {
    return last > first ? glm::mix(start, end, (side - first) / (last - first)) : start;
  };
  const Extent whole = range_of(outline, seen.side);
  seen.spans = first <= whole.least + kEntersFrom * spacing_ && last >= whole.most - kEntersFrom * spacing_;
  const double middle = glm::dot(incision.way, at(std::clamp(0.5 * (whole.least + whole.most), first, last)));
  // Just inside: on the outline's own edge a line would be of any length.
  const double tiny = 1e-9 * seen.section.length();
  seen.inside = chord(outline, incision.way, seen.side,
                      std::clamp(middle, seen.section.least + tiny, seen.section.most - tiny));
  seen.inside.least = std::max(seen.inside.least, first);
  seen.inside.most = std::min(seen.inside.most, last);
  if (!(seen.inside.length() > 0.0)) return std::nullopt;
  seen.start = at(seen.inside.least);
  seen.end = at(seen.inside.most);
  seen.now = 0.5 * glm::dot(incision.way, seen.start + seen.end);
  return seen;
}

std::optional<Incision> Blades::enter(const Blade& blade, int body, const std::vector<RigidBody>& bodies,
                                      const std::vector<BodySolve>& solves, const CutBodies& cuts,
                                      double dt) const {
  const RigidBody& of_blade = bodies[static_cast<std::size_t>(blade.body)];
  const RigidBody& of_body = bodies[static_cast<std::size_t>(body)];
  const Pose to_body = compose(inverse(of_body.mesh_pose()), of_blade.mesh_pose());
  const glm::dvec3 start = transform_point(to_body, blade.ends[0]);
  const glm::dvec3 end = transform_point(to_body, blade.ends[1]);
  const glm::dvec3 middle = transform_point(of_blade.mesh_pose(), 0.5 * (blade.ends[0] + blade.ends[1]));
  const glm::dvec3 speed = velocity_of(of_blade, solves[static_cast<std::size_t>(blade.body)], middle) -
                           velocity_of(of_body, solves[static_cast<std::size_t>(body)], middle);
  const double reach = kEntersFrom * spacing_ + dt * glm::length(speed);
  // The part of the edge that is within reach of the solid, by all of its faces, and the face that it is
  // least deep behind.
  double first = 0.0, last = 1.0;
  for (const ConvexSolid::Face& face : cuts.solid(body).faces) {
    const double height = glm::dot(face.normal, face.corners.front()) + reach;
    const double at_start = glm::dot(face.normal, start) - height,
                 at_end = glm::dot(face.normal, end) - height;
    if (at_start > 0.0 && at_end > 0.0) return std::nullopt;
    if ((at_start > 0.0) == (at_end > 0.0)) continue;
    const double share = at_start / (at_start - at_end);
    (at_start > 0.0 ? first : last) = at_start > 0.0 ? std::max(first, share) : std::min(last, share);
  }
  if (!(first < last)) return std::nullopt;
  Incision incision;
  incision.blade = blade.body;
  incision.body = body;
  incision.plane.normal = to_body.orientation * glm::dvec3(0, 0, 1);
  incision.way = to_body.orientation * glm::dvec3(0, -1, 0);
  const glm::dvec3 place = glm::mix(start, end, 0.5 * (first + last));
  incision.plane.offset = glm::dot(incision.plane.normal, place);
  const glm::dvec3* entered = nullptr;
  double shallowest = -std::numeric_limits<double>::infinity();
  for (const ConvexSolid::Face& face : cuts.solid(body).faces) {
    const double off = glm::dot(face.normal, place - face.corners.front());
    if (off > shallowest) shallowest = off, entered = &face.normal;
  }
  if (!entered || -glm::dot(*entered, incision.way) < kSteepEnough) return std::nullopt;
  // What would be thinner than particles are apart cannot be cut off: a blade stands on it.
  const Extent across = extent_along(cuts.solid(body), incision.plane.normal);
  if (incision.plane.offset - across.least < spacing_ || across.most - incision.plane.offset < spacing_)
    return std::nullopt;
  incision.front = -std::numeric_limits<double>::max();
  return incision;
}

void Blades::resist(const Blade& blade, const Incision& incision, const Seen& seen,
                    const std::vector<RigidBody>& bodies, double resistance, double dt,
                    std::vector<Contact>& contacts) const {
  const Pose pose = bodies[static_cast<std::size_t>(incision.body)].mesh_pose();
  const auto add = [&](const glm::dvec3& at, const glm::dvec3& normal, double distance, double most) {
    contacts.push_back({incision.blade, incision.body, transform_point(pose, at), pose.orientation * normal,
                        distance, most, true});
  };
  // Past the far side there is nothing left that resists.
  const double length = seen.now < seen.section.most ? seen.inside.length() : 0.0;
  // At the two Gauss points of the length, so that it also resists being turned in the plane.
  const double off = 0.5 / std::sqrt(3.0);
  for (const double share : {0.5 - off, 0.5 + off}) {
    const glm::dvec3 at = glm::mix(seen.start, seen.end, share);
    add(at, -incision.way, std::max(0.0, incision.front - glm::dot(incision.way, at)),
        0.5 * resistance * length * dt);
  }
  // The cut's two faces keep the blade in its plane, at its edge and where it entered.
  const double depth = std::min(seen.now - seen.section.least, blade.height);
  if (depth <= 0.0) return;
  for (const glm::dvec3& edge : {seen.start, seen.end}) {
    for (const glm::dvec3& at : {edge, edge - depth * incision.way}) {
      const double aside = incision.plane.distance(at);
      add(at, incision.plane.normal, aside, std::numeric_limits<double>::infinity());
      add(at, -incision.plane.normal, -aside, std::numeric_limits<double>::infinity());
    }
  }
}

void Blades::find(const std::vector<RigidBody>& bodies, const std::vector<BodySolve>& solves,
                  const CutBodies& cuts, double dt, std::vector<Contact>& contacts) {
  std::vector<Incision> before;
  std::swap(before, incisions_);
  pairs_.clear();
  if (!cuts.any()) return;
  for (const Blade& blade : blades_) {
    if (bodies[static_cast<std::size_t>(blade.body)].gone) continue;
    for (int body = 0; body < static_cast<int>(bodies.size()); ++body) {
      if (!cuts.has(body) || bodies[static_cast<std::size_t>(body)].gone) continue;
      const auto known = std::ranges::find_if(
          before, [&](const Incision& incision) { return same_pair(incision, blade.body, body); });
      std::optional<Incision> incision;
      if (known != before.end()) {
        incision = *known;
      } else {
        const bool room =
            cuts.planes(body).size() < kMaxCutPlanes &&
            std::ranges::any_of(
                cuts.family(body),
                [&](int member) { return is_away(bodies[static_cast<std::size_t>(member)].mesh_pose()); });
        if (room) incision = enter(blade, body, bodies, solves, cuts, dt);
      }
      if (!incision) continue;
      if (incision->stage == CutStage::kParting) {
        incisions_.push_back(*incision);
        continue;
      }
      const std::optional<Seen> seen = see(blade, *incision, bodies, cuts);
      // Drawn back, slid out along its edge or all of it gone past, it is out, and the body whole.
      if (!seen) continue;
      const RigidBody& on = bodies[static_cast<std::size_t>(body)];
      const glm::dvec3 middle = transform_point(on.mesh_pose(), 0.5 * (seen->start + seen->end));
      const glm::dvec3 speed = velocity_of(bodies[static_cast<std::size_t>(blade.body)],
                                           solves[static_cast<std::size_t>(blade.body)], middle) -
                               velocity_of(on, solves[static_cast<std::size_t>(body)], middle);
      if (seen->now < seen->section.least - kEntersFrom * spacing_ - dt * glm::length(speed)) continue;
      if (seen->now > seen->section.most + blade.height) continue;
      incision->front = std::max({incision->front, seen->now, seen->section.least});
      pairs_.insert(in_order(blade.body, body));
      const double share = share_inside(seen->now, dt * glm::dot(speed, on.orientation * incision->way),
                                        {incision->front, seen->section.most});
      resist(blade, *incision, *seen, bodies, share * cuts.resistance(body), dt, contacts);
      incisions_.push_back(*incision);
    }
  }
}

std::optional<Incision> Blades::through(const std::vector<RigidBody>& bodies, const CutBodies& cuts) const {
  for (const Incision& incision : incisions_) {
    if (incision.stage != CutStage::kCutting) continue;
    const auto blade = std::ranges::find(blades_, incision.blade, &Blade::body);
    if (blade == blades_.end()) continue;
    const std::optional<Seen> seen = see(*blade, incision, bodies, cuts);
    if (seen && seen->spans &&
        std::max(seen->now, incision.front) >= seen->section.most - kNothingLeft * spacing_)
      return incision;
  }
  return std::nullopt;
}

void Blades::forget(int body) {
  std::erase_if(incisions_, [&](const Incision& incision) { return incision.body == body; });
}

void Blades::refuse(const Incision& incision) {
  for (Incision& kept : incisions_)
    if (same_pair(kept, incision.blade, incision.body)) kept.stage = CutStage::kRefused;
}

void Blades::part(const Incision& through, int body, int piece) {
  for (const int each : {body, piece}) {
    incisions_.push_back(through);
    incisions_.back().body = each;
    incisions_.back().stage = CutStage::kParting;
  }
}

void Blades::push_aside(const std::vector<RigidBody>& bodies, std::vector<Contact>& contacts) {
  constexpr double kAside = 0.7;  // cosine
  std::erase_if(incisions_, [&](const Incision& incision) {
    if (incision.stage != CutStage::kParting) return false;
    const glm::dvec3 across =
        bodies[static_cast<std::size_t>(incision.body)].orientation * incision.plane.normal;
    const std::pair<int, int> pair = in_order(incision.blade, incision.body);
    bool near = false;
    std::erase_if(contacts, [&](Contact& c) {
      if (in_order(c.a, c.b) != pair) return false;
      near = true;
      const double aside = glm::dot(c.normal, across);
      c.normal = aside > 0.0 ? across : -across;
      c.of_blade = true;
      return std::abs(aside) < kAside;
    });
    return !near;
  });
}

}  // namespace slosh
