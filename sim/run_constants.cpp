#include "sim/run_constants.h"

#include <cmath>
#include <limits>

#include "sim/snapshot.h"

namespace slosh {

namespace {

// Σ of the density kernel's shape over a cubic lattice, the particle itself included.
double rest_number_density(ParticleModel model, double spacing, double support_radius) {
  const int reach = static_cast<int>(std::ceil(support_radius / spacing));
  double sum = 0.0;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const double r_squared = spacing * spacing * (x * x + y * y + z * z);
        sum += model == ParticleModel::kPaper
                   ? poly6_shape<double>(r_squared, support_radius * support_radius)
                   : spiky_shape<double>(r_squared, support_radius);
      }
    }
  }
  return sum;
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

ParticleKind make_kind(double rest_density, double viscosity, double spacing, bool probe) {
  return {static_cast<float>(rest_density), static_cast<float>(viscosity),
          static_cast<float>(rest_density * std::pow(spacing, 3)), probe};
}

}  // namespace

std::vector<ParticleKind> particle_kinds(const Scene& scene, double spacing) {
  std::vector<ParticleKind> kinds;
  for (const Fluid& f : scene.fluids) {
    kinds.push_back(make_kind(f.rest_density, f.dynamic_viscosity, spacing, false));
  }
  // A probe is one more particle of the first fluid's kind (Eq 8), moved by its body.
  const Fluid reference = scene.fluids.empty() ? Fluid{} : scene.fluids.front();
  for (const Body& body : scene.bodies) {
    if (!body.point_probe) continue;
    kinds.push_back(make_kind(
        body.particle_density > 0.0 ? body.particle_density : reference.rest_density,
        body.dynamic_viscosity > 0.0 ? body.dynamic_viscosity : reference.dynamic_viscosity, spacing, true));
  }
  return kinds;
}

RunConstants make_run_constants(const Scene& scene, const SampledScene& sampled, Plan plan) {
  RunConstants c;
  c.plan = std::move(plan);
  const double h = c.plan.support_radius;
  const double spacing = c.plan.spacing;
  const Box box = domain_of(scene, sampled, h);
  c.grid = CellGrid(box.lower, box.upper, h);
  c.kernels = make_kernel_constants(h);
  c.rest_number_density = static_cast<float>(rest_number_density(c.plan.model, spacing, h));
  c.rest_volume = static_cast<float>(std::pow(spacing, 3));
  c.gravity = glm::vec3(scene.gravity);
  c.kinds = particle_kinds(scene, spacing);
  return c;
}

ParticleStart make_particle_start(const Scene& scene, const SampledScene& sampled,
                                  const RunConstants& constants, std::span<const RigidBody> bodies) {
  ParticleStart start;
  start.positions = sampled.fluid_positions;
  start.velocities = sampled.fluid_velocities;
  start.velocities.resize(start.positions.size(), glm::vec3(0.0f));
  start.kinds = sampled.fluid_index;
  start.fluid_count = start.positions.size();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].point) continue;
    start.kinds.push_back(static_cast<std::uint8_t>(scene.fluids.size() + start.probes.size()));
    start.probes.push_back({static_cast<std::uint32_t>(start.positions.size()), static_cast<int>(b)});
    start.positions.emplace_back(bodies[b].position);
    start.velocities.emplace_back(bodies[b].velocity);
  }
  for (std::size_t i = 0; i < start.positions.size(); ++i) {
    const glm::vec3& x = start.positions[i];
    const bool whole = finite(x) && finite(start.velocities[i]);
    const bool inside = whole && constants.grid.contains(x.x, x.y, x.z);
    start.keys.push_back(inside ? constants.grid.cell_of(x.x, x.y, x.z) : constants.grid.retired_key());
    if (!inside) start.status |= whole ? kStatusEscaped : kStatusNonFinite;
  }
  start.fixed = surface_particles(scene, sampled, constants.plan, BodyMotion::kFixed);
  start.moving = surface_particles(scene, sampled, constants.plan, BodyMotion::kFree);
  return start;
}

SurfaceMotion surface_motion(const RigidBody& body) {
  return {glm::mat3(glm::mat3_cast(body.orientation)), glm::vec3(body.mesh_pose().position),
          glm::vec3(body.position), glm::vec3(body.velocity), glm::vec3(body.angular_velocity)};
}

}  // namespace slosh
