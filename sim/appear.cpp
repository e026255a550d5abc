// What comes and goes while a world runs: bodies, and fillings of fluid volumes.
#include <algorithm>

#include "sim/math/distance_field.h"
#include "sim/math/format.h"
#include "sim/math/point_grid.h"
#include "sim/world_parts.h"

namespace slosh {
namespace {

// Of a spacing. Bodies that touch may lie so deep in each other, and so near fluid is put to a wall (it lies
// half a spacing off) and to other fluid (a lattice's is a spacing off).
constexpr float kTouches = 0.5f;
constexpr float kOffWalls = 0.4f;
constexpr float kOffFluid = 1.0f;

bool is_in_way(const Pose& pose, std::span<const glm::vec3> points, const Pose& of_field,
               const DistanceFieldView& field, float deeper) {
  if (field.size.x == 0) return false;
  const Pose to_field = compose(inverse(of_field), pose);
  return std::ranges::any_of(points, [&](const glm::vec3& point) {
    const glm::vec3 at(transform_point(to_field, glm::dvec3(point)));
    return sample_distance(field, at).distance < -deeper;
  });
}

std::vector<glm::vec3> places_of(const ParticleState& particles) {
  std::vector<glm::vec3> places;
  for (std::size_t i = 0; i < particles.size(); ++i)
    places.emplace_back(particles.x[i], particles.y[i], particles.z[i]);
  return places;
}

/// Those that are in the world and that `keeps` keeps, by place in the list; the others are gone from it.
template <class Keeps>
void keep_only(ParticleState& particles, std::uint32_t retired, Keeps&& keeps) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles.key[i] == retired || !keeps(i)) continue;
    for_each_column(
        [&](auto, auto& values) {
          if (!values.empty()) values[kept] = values[i];
        },
        particles);
    ++kept;
  }
  particles.resize(kept);
}

Error in_its_place(const std::string& name, const std::string& what) {
  return {"'" + name + "'", "has no room to appear: " + what + " is in its place", "Clear the place first"};
}

Error no_such_region() {
  return {"the world", "has no such region", ""};
}
Error no_such_thing() {
  return {"the world", "has no such body or fluid", ""};
}

}  // namespace

Result<bool> World::appear(std::size_t thing) {
  const std::size_t bodies = impl_->scene.bodies.size();
  if (thing >= thing_count(impl_->scene)) return no_such_thing();
  return thing < bodies ? impl_->bring_body(thing) : impl_->fill_volume(thing - bodies);
}

Result<bool> World::take_away(std::size_t thing, int region) {
  Impl& w = *impl_;
  const std::size_t bodies = w.scene.bodies.size();
  if (thing >= thing_count(w.scene)) return no_such_thing();
  if (thing >= bodies) return w.empty_volume(thing - bodies, region);
  const Body& body = w.scene.bodies[thing];
  if (!moves(body.motion) || body.point_probe)
    return Error{"'" + body.name + "'", "stands for good and cannot be taken away",
                 "Give it motion = \"free\" in the scene"};
  if (is_away(w.bodies.bodies()[thing].mesh_pose()))
    return Error{"'" + body.name + "'", "is away already", ""};
  w.bodies.take_away(static_cast<int>(thing));
  return true;
}

Result<bool> World::Impl::bring_body(std::size_t body) {
  Body as = scene.bodies[body];
  if (!moves(as.motion) || as.point_probe)
    return Error{"'" + as.name + "'", "stands for good: it is there", ""};
  if (!is_away(bodies.bodies()[body].mesh_pose())) return Error{"'" + as.name + "'", "is there already", ""};
  const int index = static_cast<int>(body);
  if (as.piece_of >= 0)
    return Error{"'" + as.name + "'",
                 "comes only when '" + scene.bodies[static_cast<std::size_t>(as.piece_of)].name + "' is cut",
                 ""};
  if (bodies.cuts().has(index)) make_whole(body);
  if (as.motion == BodyMotion::kDriven)
    as.pose = bodies.driven().pose_of(index, static_cast<double>(tick) * plan().time_step);
  as.starts_away = false;
  const ContactFinder& shapes = bodies.shapes();
  const float deeper = kTouches * static_cast<float>(plan().spacing);
  for (std::size_t other = 0; other < scene.bodies.size(); ++other) {
    const int o = static_cast<int>(other);
    const RigidBody& there = bodies.bodies()[other];
    if (other == body || is_away(there.mesh_pose())) continue;
    if (is_in_way(as.pose, shapes.points(index), there.mesh_pose(), shapes.field(o), deeper) ||
        is_in_way(there.mesh_pose(), shapes.points(o), as.pose, shapes.field(index), deeper))
      return in_its_place(as.name, "'" + scene.bodies[other].name + "'");
  }
  ParticleState particles;
  ImpulseSums walls;
  if (plan().has_fluid() && engine->save(particles, walls)) {
    keep_only(particles, constants.grid.retired_key(), [](std::size_t) { return true; });
    if (is_in_way({}, places_of(particles), as.pose, shapes.field(index), deeper))
      return in_its_place(as.name, "fluid");
  }
  bodies.bring(index, make_rigid_body(as));
  return true;
}

/// Where a filling finds neither bodies nor one of `others`.
std::vector<glm::vec3> World::Impl::free_places(const FillingIds& ids, const Pose& to_now,
                                                const std::vector<glm::vec3>& others) const {
  const float spacing = static_cast<float>(plan().spacing);
  const PointGrid around(others, kOffFluid * spacing);
  std::vector<glm::vec3> places;
  for (std::uint32_t i = 0; i < ids.count; ++i) {
    const glm::vec3 at(transform_point(to_now, glm::dvec3(filling_places[ids.first + i])));
    bool free = constants.grid.contains(at.x, at.y, at.z);
    around.each_near(at, [&](std::uint32_t other) {
      free = free && glm::distance(others[other], at) >= kOffFluid * spacing;
    });
    for (std::size_t b = 0; b < scene.bodies.size() && free; ++b) {
      const RigidBody& body = bodies.bodies()[b];
      const DistanceFieldView field = bodies.shapes().field(static_cast<int>(b));
      if (body.gone || field.size.x == 0) continue;
      const glm::vec3 in_body(transform_point(inverse(body.mesh_pose()), glm::dvec3(at)));
      free = sample_distance(field, in_body).distance >= kOffWalls * spacing;
    }
    if (free) places.push_back(at);
  }
  return places;
}

/// As at the start of a run.
void World::Impl::add_particle(std::uint32_t id, const glm::vec3& at, const glm::vec3& velocity,
                               ParticleState& particles) const {
  const std::size_t i = particles.size();
  particles.resize(i + 1);
  particles.x[i] = at.x, particles.y[i] = at.y, particles.z[i] = at.z;
  particles.vx[i] = velocity.x, particles.vy[i] = velocity.y, particles.vz[i] = velocity.z;
  particles.volume[i] = constants.rest_volume;
  particles.id[i] = id;
  particles.key[i] = constants.grid.cell_of(at.x, at.y, at.z);
  if (constants.heat.kinds.empty()) return;
  const std::uint8_t kind = fluid_of[id];
  const HeatKind& heat = constants.heat.kinds[kind];
  particles.temperature[i] = heat.temperature;
  particles.cure[i] = heat.cure;
  particles.thickness[i] = thickness_of(heat, constants.kinds[kind].viscosity, heat.temperature, heat.cure);
}

Result<bool> World::Impl::fill_volume(std::size_t volume) {
  const FluidVolume& filled = scene.fluid_volumes[volume];
  const std::string where = "'" + filled.name + "'";
  if (volume >= fillings.size() || fillings[volume].first + fillings[volume].count > filling_places.size())
    return Error{where, "cannot be filled in this world", ""};
  Pose to_now;
  if (filled.body >= 0) {
    const Body& as = scene.bodies[static_cast<std::size_t>(filled.body)];
    const RigidBody& carrier = bodies.bodies()[static_cast<std::size_t>(filled.body)];
    if (carrier.gone) return Error{where, "is filled in '" + as.name + "', which is not there", ""};
    to_now = compose(carrier.mesh_pose(), inverse(as.pose));
  }
  ParticleState particles;
  ImpulseSums walls;
  if (!engine->save(particles, walls)) return Error{where, "cannot be filled: " + engine->failure(), ""};
  keep_only(particles, constants.grid.retired_key(), [](std::size_t) { return true; });
  const FillingIds& ids = fillings[volume];
  std::vector<char> there(fluid_count, 0);
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (particles.id[i] < fluid_count) there[particles.id[i]] = 1;
  const std::vector<glm::vec3> places = free_places(ids, to_now, places_of(particles));
  if (places.empty())
    return Error{where, "has no room: bodies or fluid are everywhere in its place", "Clear the place first"};
  std::vector<std::uint32_t> coming;
  for (const auto& [first, count] : {std::pair(ids.first, ids.count), {ids.spare_first, ids.spare_count}})
    for (std::uint32_t id = first; id < first + count && coming.size() < places.size(); ++id)
      if (!there[id]) coming.push_back(id);
  if (coming.size() < places.size())
    return Error{
        where,
        format("needs %zu particles to be filled, and %zu are left of it", places.size(), coming.size()),
        "Take some away first, or give it more fillings in the scene"};
  for (std::size_t i = 0; i < coming.size(); ++i) {
    glm::dvec3 velocity = to_now.orientation * filled.velocity;
    if (filled.body >= 0)
      velocity += bodies.bodies()[static_cast<std::size_t>(filled.body)].velocity_at(glm::dvec3(places[i]));
    add_particle(coming[i], places[i], glm::vec3(velocity), particles);
  }
  waiting -= static_cast<std::int64_t>(coming.size());
  put(particles, walls, coming);
  return true;
}

Result<bool> World::Impl::empty_volume(std::size_t volume, int region) {
  const std::string where = "'" + scene.fluid_volumes[volume].name + "'";
  ParticleState particles;
  ImpulseSums walls;
  if (volume >= fillings.size() || !engine->save(particles, walls))
    return Error{where, "cannot be taken away: " + engine->failure(), ""};
  if (region >= static_cast<int>(region_fields.size())) return no_such_region();
  DistanceFieldView within;
  Pose to_region;
  if (region >= 0) {
    const Region& of = scene.regions[static_cast<std::size_t>(region)];
    within = region_fields[static_cast<std::size_t>(region)].view();
    to_region = inverse(
        of.body < 0 ? of.pose
                    : compose(bodies.bodies()[static_cast<std::size_t>(of.body)].mesh_pose(), of.pose));
  }
  const auto is_within = [&](std::size_t i) {
    const glm::dvec3 at(particles.x[i], particles.y[i], particles.z[i]);
    return region < 0 || sample_distance(within, glm::vec3(transform_point(to_region, at))).distance < 0.0f;
  };
  std::vector<std::uint32_t> going;
  keep_only(particles, constants.grid.retired_key(), [&](std::size_t i) {
    const bool goes = fillings[volume].has(particles.id[i]) && is_within(i);
    if (goes) going.push_back(particles.id[i]);
    return !goes;
  });
  if (going.empty()) return Error{where, "has nothing in the world that could be taken away", ""};
  waiting += static_cast<std::int64_t>(going.size());
  std::ranges::sort(going);
  put(particles, walls, going);
  return true;
}

void World::Impl::put(const ParticleState& particles, const ImpulseSums& walls,
                      const std::vector<std::uint32_t>& changed) {
  BondTable bonds;
  const bool bound = plan().has(PassId::kBonds) && engine->save_bonds(bonds);
  status |= engine->take_status();
  engine->restore(particles, walls);
  if (!bound) return;
  const auto is_changed = [&](std::uint32_t id) { return std::ranges::binary_search(changed, id); };
  for (std::uint32_t id = 0; id < bonds.count.size(); ++id) {
    if (is_changed(id)) bonds.count[id] = bonds.set[id] = 0;
    Bond* const row = bonds.row(id);
    Bond* const end =
        std::remove_if(row, row + bonds.count[id], [&](const Bond& bond) { return is_changed(bond.other); });
    bonds.count[id] = static_cast<std::uint8_t>(end - row);
  }
  engine->restore_bonds(bonds);
}

}  // namespace slosh
