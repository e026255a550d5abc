#include "sim/walls/wall_particles.h"

#include <cmath>

#include "sim/viscosity/wall_drag.h"
#include "sim/walls/joined_walls.h"
#include "sim/walls/own_layer.h"
#include "sim/walls/particle_layer.h"

namespace slosh {

namespace {

// The particles of the fixed bodies that touch others, and what each stands for, body by body; empty for all
// other bodies.
struct JoinedWalls {
  std::vector<std::vector<LayerParticle>> layers;  // mesh frame
  std::vector<std::vector<float>> shares;
};

JoinedWalls joined_walls(const Scene& scene, const SampledScene& sampled, const Plan& plan, DragLayer drags) {
  JoinedWalls walls{std::vector<std::vector<LayerParticle>>(scene.bodies.size()),
                    std::vector<std::vector<float>>(scene.bodies.size())};
  if (!corrects_gradients(plan.model)) return walls;
  const float spacing = static_cast<float>(plan.spacing);
  auto [solids, body_of] = fixed_solids(scene, sampled);
  for (FixedSolid& solid : solids)
    solid.depth = depths_of(scene, plan, solid.surface->apart, drags).flat * spacing;
  std::vector<std::vector<LayerParticle>> layers = joined_layers(solids, spacing);
  std::vector<LayerParticle> all;
  for (std::size_t n = 0; n < layers.size(); ++n)
    for (const LayerParticle& p : layers[n]) all.push_back(moved(solids[n].pose, p));
  const std::vector<float> shares = layer_shares(all, plan);
  auto next = shares.begin();
  for (std::size_t n = 0; n < layers.size(); ++n) {
    const auto end = next + static_cast<std::ptrdiff_t>(layers[n].size());
    walls.shares[body_of[n]].assign(next, end);
    walls.layers[body_of[n]] = std::move(layers[n]);
    next = end;
  }
  return walls;
}

// Samples of a body's surface, in its mesh frame.
struct DraggingLayer {
  std::vector<glm::vec3> positions, normals;
};

// Where the bodies whose motion is `motion` exert viscous forces, body by body: the samples of their surfaces
// but for those that another fixed body hides.
std::vector<DraggingLayer> dragging_layers(const Scene& scene, const SampledScene& sampled, const Plan& plan,
                                           BodyMotion motion) {
  std::vector<DraggingLayer> layers(scene.bodies.size());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (moves(body.motion) == moves(motion) && !body.point_probe)
      layers[b] = {sampled.surfaces[b].positions, sampled.surfaces[b].normals};
  }
  if (moves(motion)) return layers;
  const auto [solids, body_of] = fixed_solids(scene, sampled);
  const std::vector<std::vector<std::uint32_t>> exposed =
      exposed_samples(solids, static_cast<float>(plan.spacing));
  for (std::size_t n = 0; n < exposed.size(); ++n) {
    const SurfaceSamples& all = *solids[n].surface;
    DraggingLayer& layer = layers[body_of[n]] = {};
    for (const std::uint32_t i : exposed[n]) {
      layer.positions.push_back(all.positions[i]);
      layer.normals.push_back(all.normals[i]);
    }
  }
  return layers;
}

// The planes in which a body mirrors the fluid, one a particle of its layer: where it is fixed and free-slip.
// A moving one only lets fluid slide. None with particle stresses: beyond a free-slip wall, as beyond a free
// surface, no particle takes a stress up.
std::vector<MirrorPlane> mirrors_of(const Body& body, const DraggingLayer& layer, const Plan& plan) {
  if (plan.passes_stress || body.motion != BodyMotion::kFixed || body.dynamic_viscosity != kFreeSlip)
    return {};
  const glm::mat3 turn(glm::mat3_cast(body.pose.orientation));
  std::vector<glm::vec3> normals;
  normals.reserve(layer.normals.size());
  std::vector<glm::vec3> positions;
  positions.reserve(layer.positions.size());
  for (const glm::vec3& n : layer.normals) normals.push_back(turn * n);
  for (const glm::vec3& p : layer.positions) positions.push_back(turn * p);
  return mirror_planes(positions, normals, static_cast<float>(plan.support_radius));
}

// Of all bodies of a scene.
struct LayerRules {
  DragLayer layer;
  WallDrag drag;
  float lattice_volume, flat_drag, support;

  LayerRules(const Scene& scene, const Plan& plan, DragLayer drags)
      : layer(drags),
        drag(wall_drag(plan.model, scene.support_ratio, layer)),
        lattice_volume(static_cast<float>(std::pow(plan.spacing, 3))),
        flat_drag(static_cast<float>(drag.factor(0.0))),
        support(static_cast<float>(plan.support_radius)) {}
  // Pressure and viscosity act from different layers.
  bool apart() const { return layer == DragLayer::kSurface; }
};

struct PressingLayer {
  std::vector<LayerParticle> particles;  // mesh frame
  std::vector<float> pressures;
};

PressingLayer pressing_layer(const Scene& scene, const Plan& plan, const LayerRules& rules, std::size_t body,
                             const SurfaceSamples& surface, const DistanceFieldView& field) {
  PressingLayer pressing;
  pressing.particles = own_layer(surface, field, plan, depths_of(scene, plan, surface.apart, rules.layer));
  pressing.pressures.assign(pressing.particles.size(), static_cast<float>(plan.body_pressure[body]));
  if (plan.model != ParticleModel::kPaper) pressing.pressures = layer_shares(pressing.particles, plan);
  return pressing;
}

void add_particles(const Scene& scene, const Plan& plan, const LayerRules& rules, std::size_t b,
                   const SurfaceSamples& surface, const DistanceFieldView& field,
                   const PressingLayer& pressing, const DraggingLayer& dragging,
                   std::vector<SurfaceParticle>& particles) {
  const Body& body = scene.bodies[b];
  const auto add = [&](const glm::vec3& at, float pressure, float volume, float lacks = 0.0f,
                       const MirrorPlane& mirror = {}) {
    particles.push_back({at, static_cast<std::uint16_t>(b), pressure, volume,
                         static_cast<float>(body.dynamic_viscosity), rules.support - lacks, mirror});
  };
  for (std::size_t i = 0; i < pressing.particles.size(); ++i) {
    const float volume = plan.model == ParticleModel::kPaper
                             ? surface.particle_volume
                             : pressing.pressures[i] / kWallShare * rules.lattice_volume * rules.flat_drag;
    add(pressing.particles[i].position, pressing.pressures[i], rules.apart() ? 0.0f : volume,
        pressing.particles[i].lacks);
  }
  if (!rules.apart()) return;
  const float surface_volume = surface.particle_volume;
  const std::vector<MirrorPlane> mirrors = mirrors_of(body, dragging, plan);
  if (!mirrors.empty()) {
    const double factor = mirror_factor(scene.support_ratio, rules.layer);
    const float volume = static_cast<float>(factor) * surface_volume;
    for (std::size_t i = 0; i < mirrors.size(); ++i)
      add(dragging.positions[i], 0.0f, volume, 0.0f, mirrors[i]);
    return;
  }
  for (const glm::vec3& p : dragging.positions) {
    const float bent = bend(field, p, static_cast<float>(plan.spacing));
    add(p, 0.0f, static_cast<float>(rules.drag.factor(bent)) * surface_volume);
  }
}

// A convex part has less surface than the whole, but grids of samples end in whole numbers.
constexpr std::size_t kPieceRoom = 4;  // so many share room for one more
constexpr std::size_t kMinPieceRoom = 64;

}  // namespace

std::vector<SurfaceParticle> surface_particles(const Scene& scene, const SampledScene& sampled,
                                               const Plan& plan, BodyMotion motion) {
  std::vector<SurfaceParticle> particles;
  if (!plan.has(PassId::kWalls)) return particles;
  const LayerRules rules(scene, plan, drag_layer(scene, plan));
  JoinedWalls joined;
  if (motion == BodyMotion::kFixed) joined = joined_walls(scene, sampled, plan, rules.layer);
  std::vector<DraggingLayer> dragging(scene.bodies.size());
  if (rules.apart()) dragging = dragging_layers(scene, sampled, plan, motion);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (moves(body.motion) != moves(motion) || body.point_probe) continue;
    PressingLayer pressing;
    if (motion == BodyMotion::kFixed && !joined.layers[b].empty())
      pressing = {std::move(joined.layers[b]), std::move(joined.shares[b])};
    else
      pressing =
          pressing_layer(scene, plan, rules, b, sampled.surfaces[b], sampled.distance_fields[b].view());
    const std::size_t first = particles.size();
    add_particles(scene, plan, rules, b, sampled.surfaces[b], sampled.distance_fields[b].view(), pressing,
                  dragging[b], particles);
    if (is_cut(body)) {
      const std::size_t own = particles.size() - first;
      particles.resize(particles.size() + own / kPieceRoom + kMinPieceRoom, nobody(b));
    }
  }
  return particles;
}

std::vector<SurfaceParticle> particles_of_piece(const Scene& scene, const Plan& plan, DragLayer drags,
                                                std::size_t body, const SurfaceSamples& surface,
                                                const DistanceFieldView& field) {
  std::vector<SurfaceParticle> particles;
  if (!plan.has(PassId::kWalls)) return particles;
  const LayerRules rules(scene, plan, drags);
  DraggingLayer dragging;
  if (rules.apart()) dragging = {surface.positions, surface.normals};
  add_particles(scene, plan, rules, body, surface, field,
                pressing_layer(scene, plan, rules, body, surface, field), dragging, particles);
  return particles;
}

SurfaceParticle nobody(std::size_t body) {
  return {glm::vec3(kNobodysPlace), static_cast<std::uint16_t>(body), 0.0f, 0.0f, 0.0f, 0.0f, {}};
}

}  // namespace slosh
