#include "sim/run_constants.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/fluid_extremes.h"
#include "sim/model.h"
#include "sim/pressure/wall_layers.h"
#include "sim/snapshot.h"
#include "sim/step_limits.h"
#include "sim/viscosity/artificial_viscosity.h"
#include "sim/viscosity/drag_shape.h"
#include "sim/viscosity/stability.h"

namespace slosh {

namespace {

// Σ of the density kernel's shape over a cubic lattice, the particle itself included.
template <class Kernel>
double rest_number_density(double spacing, double support_radius) {
  const int reach = static_cast<int>(std::ceil(support_radius / spacing));
  const Support<double> support{support_radius, support_radius * support_radius};
  double sum = 0.0;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        sum += Kernel::shape(spacing * spacing * (x * x + y * y + z * z), support);
      }
    }
  }
  return sum;
}

// Σ x² (−W'/r) over it, without the kernel's constant.
template <class Kernel>
double rest_moment(double spacing, double support_radius) {
  const int reach = static_cast<int>(std::ceil(support_radius / spacing));
  Symmetric<double> sum{};
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const double dx = spacing * x, dy = spacing * y, dz = spacing * z;
        add_moment(dx, dy, dz, Kernel::pair(dx * dx + dy * dy + dz * dz, support_radius, 1.0), sum);
      }
    }
  }
  return trace(sum) / 3.0;
}

struct Box {
  glm::dvec3 lower, upper;
};

// The scene's domain, or room around what there is when it names none.
Box domain_of(const Scene& scene, const SampledScene& sampled, double support_radius) {
  if (glm::all(glm::lessThan(scene.domain_min, scene.domain_max)))
    return {scene.domain_min, scene.domain_max};
  Box box{glm::dvec3(std::numeric_limits<double>::infinity()),
          glm::dvec3(-std::numeric_limits<double>::infinity())};
  const auto include = [&](const glm::dvec3& p) {
    box.lower = glm::min(box.lower, p);
    box.upper = glm::max(box.upper, p);
  };
  for (const glm::vec3& p : sampled.fluid_positions) include(glm::dvec3(p));
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    include(scene.bodies[b].pose.position);
    for (const glm::vec3& p : sampled.surfaces[b].positions) {
      include(transform_point(scene.bodies[b].pose, glm::dvec3(p)));
    }
  }
  const glm::dvec3 room = glm::max(0.5 * (box.upper - box.lower), glm::dvec3(4.0 * support_radius));
  return {box.lower - room, box.upper + room};
}

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

ParticleKind make_kind(const Scene& scene, double rest_density, double viscosity, double spacing,
                       bool probe) {
  return {static_cast<float>(rest_density),
          static_cast<float>(viscosity),
          static_cast<float>(rest_density * std::pow(spacing, 3)),
          static_cast<float>(pressing_density(scene, rest_density)),
          probe,
          static_cast<float>(viscosity)};
}

// `noise`: Pa·s, the artificial viscosity; `thinnest`: Pa·s, of the fluids that there are. The finer layers
// of free-slip walls are right with one layer.
float wall_layer_of(const Scene& scene, float noise, double thinnest) {
  const bool slips = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                 [](const Body& body) { return body.dynamic_viscosity == kFreeSlip; });
  return slips ? 1.0f / kWallShare : wall_layer(noise, static_cast<float>(thinnest), scene.support_ratio);
}

bool comes_later(const Scene& scene, const SampledScene& sampled, std::uint32_t id) {
  for (std::size_t v = 0; v < sampled.fillings.size(); ++v) {
    const FillingIds& ids = sampled.fillings[v];
    if (ids.has(id)) return id - ids.first >= ids.count || scene.fluid_volumes[v].starts_away;
  }
  return false;
}

}  // namespace

std::vector<ParticleKind> particle_kinds(const Scene& scene, double spacing) {
  std::vector<ParticleKind> kinds;
  // A fluid that no volume has is nowhere. Its kind is that of the first that is there, so that where one
  // viscosity serves all it is every kind's.
  const Fluid reference = scene.fluid_volumes.empty()
                              ? (scene.fluids.empty() ? Fluid{} : scene.fluids.front())
                              : scene.fluids[static_cast<std::size_t>(scene.fluid_volumes.front().fluid)];
  for (std::size_t i = 0; i < scene.fluids.size(); ++i) {
    const bool there =
        std::any_of(scene.fluid_volumes.begin(), scene.fluid_volumes.end(),
                    [&](const FluidVolume& v) { return static_cast<std::size_t>(v.fluid) == i; });
    const Fluid& f = there ? scene.fluids[i] : reference;
    kinds.push_back(make_kind(scene, f.rest_density, f.dynamic_viscosity, spacing, false));
    kinds.back().least_viscosity = static_cast<float>(viscosity_range(scene, f).least);
  }
  // A probe is one more particle of the reference's kind (Eq 8), moved by its body.
  for (const Body& body : scene.bodies) {
    if (!body.point_probe) continue;
    kinds.push_back(make_kind(
        scene, body.particle_density > 0.0 ? body.particle_density : reference.rest_density,
        body.dynamic_viscosity > 0.0 ? body.dynamic_viscosity : reference.dynamic_viscosity, spacing, true));
  }
  return kinds;
}

bool any_artificial_viscosity(std::span<const ParticleKind> kinds, float noise) {
  return std::any_of(kinds.begin(), kinds.end(), [&](const ParticleKind& kind) {
    return artificial_viscosity_left(noise, kind.least_viscosity) > 0.0f;
  });
}

RunConstants make_run_constants(const Scene& scene, const SampledScene& sampled, Plan plan) {
  RunConstants c;
  c.plan = std::move(plan);
  const double h = c.plan.support_radius;
  const double spacing = c.plan.spacing;
  const Box box = domain_of(scene, sampled, h);
  // Many particles can afford more cells than few: what empty ones cost is shared by them.
  constexpr double kCellsAParticle = 8.0;
  c.grid = CellGrid(
      box.lower, box.upper, h,
      std::max(CellGrid::kMaxCells, kCellsAParticle * static_cast<double>(sampled.fluid_positions.size())));
  c.support_radius = static_cast<float>(h);
  with_model(c.plan.model, [&]<class Parts>() {
    c.force_scale = static_cast<float>(Parts::ForceKernel::scale(h));
    c.rest_number_density =
        static_cast<float>(rest_number_density<typename Parts::DensityKernel>(spacing, h));
  });
  const DragShape<double> shape = drag_shape(drag_layer(scene, c.plan), h);
  c.drag_shape = {static_cast<float>(shape.level), static_cast<float>(shape.growth)};
  const double volume = std::pow(spacing, 3);
  c.rest_volume = static_cast<float>(volume);
  if (corrects_gradients(c.plan.model)) {
    const double moment = rest_moment<Spiky>(spacing, h);
    const FluidExtremes fluids = fluid_extremes(scene);
    const auto noise = static_cast<float>(artificial_viscosity(c.plan, fluids.lightest));
    c.correction = {c.rest_number_density,
                    static_cast<float>(moment),
                    static_cast<float>(1.0 / (volume * moment * Spiky::scale(h))),
                    static_cast<float>(std::pow(h, 3)),
                    noise,
                    c.rest_volume,
                    static_cast<float>(c.plan.stiffness),
                    static_cast<float>(c.plan.tension),
                    static_cast<float>(impact_growth(c.plan)),
                    static_cast<float>(max_explicit_viscosity(scene, c.plan)),
                    wall_layer_of(scene, noise, fluids.least_viscous)};
  }
  c.gravity = glm::vec3(scene.gravity);
  if (c.plan.model != ParticleModel::kIncompressible)
    c.load_compression = 0.5 * glm::length(scene.gravity) * fluid_heights(scene).load / c.plan.stiffness;
  c.kinds = particle_kinds(scene, spacing);
  if (c.plan.has(PassId::kHeat)) c.heat = heat_constants(scene, c.plan);
  double heaviest = 0.0;
  for (const ParticleKind& kind : c.kinds) heaviest = std::max<double>(heaviest, kind.mass);
  c.impulse_units = impulse_units(heaviest > 0.0 ? heaviest : 1.0, c.plan.max_speed, spacing);
  return c;
}

ParticleStart make_particle_start(const Scene& scene, const SampledScene& sampled,
                                  const RunConstants& constants, std::span<const RigidBody> bodies) {
  ParticleStart start;
  start.fluid_count = sampled.fluid_positions.size();
  std::vector<glm::vec3> positions = sampled.fluid_positions;
  std::vector<glm::vec3> velocities = sampled.fluid_velocities;
  velocities.resize(positions.size(), glm::vec3(0.0f));
  ParticleState& p = start.particles;
  p.kind = sampled.fluid_index;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].point) continue;
    p.kind.push_back(static_cast<std::uint8_t>(scene.fluids.size() + start.probes.size()));
    start.probes.push_back({static_cast<std::uint32_t>(positions.size()), static_cast<int>(b)});
    positions.emplace_back(bodies[b].position);
    velocities.emplace_back(bodies[b].velocity);
  }
  p.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const glm::vec3& x = positions[i];
    const glm::vec3& v = velocities[i];
    p.x[i] = x.x;
    p.y[i] = x.y;
    p.z[i] = x.z;
    p.vx[i] = v.x;
    p.vy[i] = v.y;
    p.vz[i] = v.z;
    p.volume[i] = constants.rest_volume;
    if (!constants.heat.kinds.empty()) {
      const HeatKind& kind = constants.heat.kinds[p.kind[i]];
      p.temperature[i] = kind.temperature;
      p.cure[i] = kind.cure;
      p.thickness[i] = thickness_of(kind, constants.kinds[p.kind[i]].viscosity, kind.temperature, kind.cure);
    }
    p.id[i] = static_cast<std::uint32_t>(i);
    const bool whole = finite(x) && finite(v);
    const bool waits = i < start.fluid_count && comes_later(scene, sampled, p.id[i]);
    start.waiting += waits;
    const bool inside = whole && !waits && constants.grid.contains(x.x, x.y, x.z);
    p.key[i] = inside ? constants.grid.cell_of(x.x, x.y, x.z) : constants.grid.retired_key();
    if (!inside && !waits) start.status |= whole ? kStatusEscaped : kStatusNonFinite;
    if (!whole) p.broken += 1;
  }
  start.fixed = surface_particles(scene, sampled, constants.plan, BodyMotion::kFixed);
  start.moving = surface_particles(scene, sampled, constants.plan, BodyMotion::kFree);
  start.clamp_fields = clamp_fields(scene, sampled, constants.plan);
  return start;
}

}  // namespace slosh
