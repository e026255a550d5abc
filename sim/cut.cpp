// Bodies that are cut while a world runs.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <system_error>

#include "sim/math/format.h"
#include "sim/world_parts.h"

namespace slosh {
namespace {

bool usable(const CutPlane& plane) {
  return glm::length(plane.normal) > 1e-6 && glm::length(plane.normal) < 1e6 && std::abs(plane.offset) < 1e6;
}

}  // namespace

Result<std::size_t> World::cut(std::size_t body, const CutPlane& plane) {
  if (body >= impl_->scene.bodies.size()) return Error{"the world", "has no such body", ""};
  if (!usable(plane)) return Error{"the plane of the cut", "is none", "Give it a direction"};
  const double length = glm::length(plane.normal);
  return impl_->cut_body(body, {plane.normal / length, plane.offset / length});
}

Result<CutPlane> World::Impl::side_that_stays(std::size_t body, const CutPlane& plane) const {
  bool inner = false, outer = false;
  const auto is_on = [&](const glm::dvec3& at) { (plane.distance(at) > 0.0 ? outer : inner) = true; };
  const auto index = static_cast<int>(body);
  for (const Grip& grip : scene.grips)
    if (grip.body == index) is_on(grip.pose.position);
  for (const Joint& joint : scene.joints) {
    if (joint.body == index) is_on(joint.pose.position);
    if (joint.other != index) continue;
    const Pose meets = joint.meets.value_or(
        compose(inverse(scene.bodies[body].pose),
                compose(scene.bodies[static_cast<std::size_t>(joint.body)].pose, joint.pose)));
    is_on(meets.position);
  }
  if (inner && outer)
    return Error{"'" + scene.bodies[body].name + "'", "has grips or joints on both sides of the cut",
                 "Cut beside them"};
  return outer ? plane.reversed() : plane;
}

namespace {

/// Fills the room that there is for a body's particles. Error: they are more.
std::optional<Error> fit(const std::string& name, std::size_t room, std::size_t body,
                         std::vector<SurfaceParticle>& particles) {
  if (particles.size() > room)
    return Error{
        "'" + name + "'",
        format("would have %zu particles in one piece, and there is room for %zu", particles.size(), room),
        "Cut elsewhere"};
  particles.resize(room, nobody(body));
  return std::nullopt;
}

}  // namespace

Result<std::vector<SurfaceParticle>> World::Impl::particles_of(std::size_t body,
                                                               const PieceShape& shape) const {
  std::vector<SurfaceParticle> particles =
      particles_of_piece(scene, plan(), drags_from, body, shape.surface, shape.field.view());
  if (auto error = fit(scene.bodies[body].name, piece_slots[body].count, body, particles)) return *error;
  return particles;
}

void World::Impl::reshape(std::size_t body, const PieceShape& shape,
                          std::span<const SurfaceParticle> particles, const glm::dvec3& recentred) {
  if (plan().has_fluid())
    engine->reshape({body, piece_slots[body].first, particles, &shape.field, recentred});
}

World::Impl::CutOrder World::Impl::order(std::size_t body, const CutPlane& plane) const {
  const auto index = static_cast<int>(body);
  CutOrder order;
  order.body = body;
  order.plane = plane;
  order.planes = bodies.cuts().planes(index);
  order.scene.bodies = scene.bodies;
  order.scene.support_ratio = scene.support_ratio;
  order.plan = plan();
  order.drags = drags_from;
  order.held = std::ranges::any_of(scene.grips, [&](const Grip& grip) { return grip.body == index; }) ||
               std::ranges::any_of(scene.joints, [&](const Joint& joint) {
                 return joint.body == index || joint.other == index;
               });
  return order;
}

Result<World::Impl::Parts> World::Impl::parts(const CutBodies& cuts, const CutOrder& order) {
  const auto within = [&](const CutPlane& side) {
    std::vector<CutPlane> planes = order.planes;
    planes.push_back(side);
    return cuts.shape(static_cast<int>(order.body), std::move(planes));
  };
  Result<PieceShape> rest = within(order.plane), off = within(order.plane.reversed());
  if (!rest) return rest.error();
  if (!off) return off.error();
  Parts parts{std::move(rest.value()), std::move(off.value()), {}, {}};
  if (!order.held && parts.off.mass.mass > parts.rest.mass.mass) std::swap(parts.rest, parts.off);
  const auto particles = [&](const PieceShape& shape) {
    return particles_of_piece(order.scene, order.plan, order.drags, order.body, shape.surface,
                              shape.field.view());
  };
  parts.of_rest = particles(parts.rest);
  parts.of_off = particles(parts.off);
  return parts;
}

Result<std::size_t> World::Impl::cut_body(std::size_t body, CutPlane plane) {
  const auto index = static_cast<int>(body);
  const std::string where = "'" + scene.bodies[body].name + "'";
  const CutBodies& cuts = bodies.cuts();
  if (!cuts.has(index)) return Error{where, "cannot be cut", "Give it pieces = 2 or more in the scene"};
  const RigidBody& whole = bodies.bodies()[body];
  if (whole.gone) return Error{where, "is not there", ""};
  const Extent extent = extent_along(cuts.solid(index), plane.normal);
  if (!(extent.least < plane.offset && plane.offset < extent.most))
    return Error{where, "is missed by the plane", ""};
  const auto& family = cuts.family(index);
  const auto free = std::ranges::find_if(family, [&](int member) {
    return member != index && is_away(bodies.bodies()[static_cast<std::size_t>(member)].mesh_pose());
  });
  if (free == family.end())
    return Error{where, format("has all its %zu pieces in the world", family.size()),
                 "Give it more pieces in the scene"};
  const auto piece = static_cast<std::size_t>(*free);
  const Result<CutPlane> stays = side_that_stays(body, plane);
  if (!stays) return stays.error();
  plane = stays.value();
  const bool known = cut_ahead && cut_ahead->body == body && cut_ahead->plane == plane &&
                     cut_ahead->planes == cuts.planes(index);
  Result<Parts> made = known ? cut_ahead->parts.get() : parts(cuts, order(body, plane));
  if (known) cut_ahead.reset();
  if (!made) return made.error();
  Parts& two = made.value();
  for (const auto& [each, particles] : {std::pair(body, &two.of_rest), std::pair(piece, &two.of_off)}) {
    if (auto error = fit(scene.bodies[body].name, piece_slots[each].count, each, *particles)) return *error;
    for (SurfaceParticle& particle : *particles) particle.body = static_cast<std::uint16_t>(each);
  }
  // Its own side, whichever way the plane came.
  const CutPlane outer = two.rest.planes.back();
  const glm::dvec3 center = whole.position;
  bodies.part(index, two.rest, *free, two.off, outer);
  reshape(body, two.rest, two.of_rest, center - bodies.bodies()[body].position);
  reshape(piece, two.off, two.of_off, glm::dvec3(0.0));
  wrenches[piece] = {};
  cuts_told = cuts.told(tick);
  return piece;
}

Result<std::vector<World::Impl::Reshaping>> World::Impl::shapes_of(SavedState& state) const {
  std::vector<Reshaping> all;
  const CutBodies& cuts = bodies.cuts();
  for (const Incision& i : state.incisions)
    if (!scene.bodies[static_cast<std::size_t>(i.blade)].blade || !cuts.has(i.body))
      return Error{"saved world", "a blade in it cuts what cannot be cut", ""};
  state.planes.resize(cuts.any() ? scene.bodies.size() : 0);  // of an older one: nothing was cut
  for (std::size_t b = 0; b < state.planes.size(); ++b) {
    const auto index = static_cast<int>(b);
    if (!cuts.has(index)) {
      if (state.planes[b].empty()) continue;
      return Error{"saved world", "a body in it is cut that cannot be cut", ""};
    }
    if (state.planes[b] == cuts.planes(index)) continue;
    Result<PieceShape> shape = cuts.shape(index, state.planes[b]);
    if (!shape) return shape.error();
    Result<std::vector<SurfaceParticle>> particles = particles_of(b, shape.value());
    if (!particles) return particles.error();
    take_mass(state.bodies[b], shape.value().mass);
    all.push_back({b, std::move(shape.value()), std::move(particles.value())});
  }
  return all;
}

void World::Impl::make_whole(std::size_t body) {
  const auto index = static_cast<int>(body);
  if (bodies.cuts().planes(index).empty()) return;
  const Result<PieceShape> whole = bodies.cuts().shape(index, {});
  const Result<std::vector<SurfaceParticle>> particles = particles_of(body, whole.value());
  bodies.reshape(index, whole.value());
  reshape(body, whole.value(), particles.value(), glm::dvec3(0.0));
  cuts_told = bodies.cuts().told(tick);
}

void World::Impl::cut_through() {
  while (const std::optional<Incision> incision = bodies.blades().through(bodies.bodies(), bodies.cuts())) {
    const Result<std::size_t> piece = cut_body(static_cast<std::size_t>(incision->body), incision->plane);
    if (piece)
      bodies.end_cut(*incision, static_cast<int>(piece.value()));
    else
      bodies.refuse(*incision);
  }
  plan_cut();
}

void World::Impl::plan_cut() {
  const std::vector<Incision>& incisions = bodies.blades().kept();
  const auto is_planned = [&](const Incision& incision) {
    return incision.stage == CutStage::kCutting &&
           static_cast<std::size_t>(incision.body) == cut_ahead->body &&
           (incision.plane == cut_ahead->plane || incision.plane.reversed() == cut_ahead->plane) &&
           bodies.cuts().planes(incision.body) == cut_ahead->planes;
  };
  if (cut_ahead) {
    const bool over = cut_ahead->parts.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    if (!over || std::ranges::any_of(incisions, is_planned)) return;
    cut_ahead.reset();  // its blade was drawn back
  }
  for (const Incision& incision : incisions) {
    const auto body = static_cast<std::size_t>(incision.body);
    if (incision.stage != CutStage::kCutting) continue;
    const Result<CutPlane> stays = side_that_stays(body, incision.plane);
    if (!stays) continue;
    CutOrder ordered = order(body, stays.value());
    Ahead next{body, ordered.plane, ordered.planes, {}};
    try {
      next.parts = std::async(std::launch::async, [&cuts = bodies.cuts(), ordered = std::move(ordered)] {
        return parts(cuts, ordered);
      });
    } catch (const std::system_error&) {
      return;  // no thread is to be had: it is found when it is needed
    }
    cut_ahead = std::move(next);
    return;
  }
}

}  // namespace slosh
