#include "scenes/sample.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "scenes/gltf/extras.h"
#include "scenes/mesh/tree.h"
#include "scenes/mesh/united.h"
#include "scenes/sampling/distance.h"
#include "scenes/sampling/fill.h"
#include "scenes/sampling/place.h"
#include "scenes/sampling/surface.h"
#include "scenes/sampling/thickness.h"

namespace slosh {
namespace {

using gltf::short_number;

/// A wall counts as thick enough from this share of the spacing on: a round rod made of flat faces is a
/// little thinner than its name.
constexpr double kThinnest = 0.95;

// Measured on one core of an Intel Xeon, from 30 000 particles on; below that it is less.
constexpr double kSecondsASurfaceParticle = 6e-5;
constexpr double kSecondsAFluidParticle = 2e-6;

constexpr double kMaxFluid = 2e7;
constexpr double kMaxSurface = 2e6;

/// Of the spacing, where fluid slides along a wall. At 0.8 half of what the bumps brake is left.
constexpr double kSmoothSheet = 0.7;

/// What one mesh gives every body that has it.
struct SampledMesh {
  SurfaceSamples surface;
  DistanceField field;
};

Result<SampledMesh> sample_mesh(const Scene& scene, const Body& body, double spacing,
                                const std::function<void(double)>& tell) {
  const TriangleMesh& triangles = scene.meshes[body.mesh];
  const mesh::MeshTree tree(triangles);
  const double thickness = sampling::wall_thickness(triangles, tree);
  if (thickness < kThinnest * spacing) {
    return Error{sampling::place_of(scene, "node '" + body.name + "'"),
                 "its walls are " + short_number(1000.0 * thickness) + " mm thick, the particles are " +
                     short_number(1000.0 * spacing) + " mm apart: fluid on one side would feel the other",
                 "Lower the scene's spacing_max_m (or the spacing asked for) to " +
                     short_number(0.001 * std::floor(1e4 * thickness) * 0.1) + ", or thicken the wall"};
  }
  mesh::Components parts;
  mesh::find_defects(mesh::weld(triangles), &parts);
  const double apart = boundary_spacing(scene, body, spacing);
  // Solids that touch may have faces between them, also where they hang together.
  const int solids = parts.touching ? std::max(parts.count, 2) : parts.count;
  SurfaceSamples surface = sampling::sample_surface(triangles, tree, solids, apart, tell);
  surface.particle_volume *= static_cast<float>(spacing / apart);  // area · spacing / count
  return SampledMesh{std::move(surface), sampling::make_distance_field(triangles, tree, spacing)};
}

/// A spacing that is far too small must not look like a
/// hang.
std::optional<Error> check_size(const Scene& scene, double spacing) {
  const ParticleEstimate estimate = estimate_particles(scene, spacing);
  const bool fluid = estimate.fluid > kMaxFluid;
  if (!fluid && estimate.surface <= kMaxSurface) return std::nullopt;
  return Error{sampling::place_of(scene, "spacing"),
               "is " + short_number(1000.0 * spacing) + " mm: about " +
                   short_number(fluid ? estimate.fluid : estimate.surface) + (fluid ? " fluid" : " surface") +
                   " particles, more than " + short_number(fluid ? kMaxFluid : kMaxSurface),
               "Choose a larger spacing"};
}

// About how many, of a body that has a mesh.
double surface_particles(const Scene& scene, const Body& body, double spacing) {
  const double apart = boundary_spacing(scene, body, spacing);
  return mesh::surface_area(scene.meshes[body.mesh]) / (apart * apart);
}

SurfaceSamples sample_probe(double spacing) {
  const auto volume = static_cast<float>(spacing * spacing * spacing);
  return {{glm::vec3(0.0f)}, {glm::vec3(0.0f, 1.0f, 0.0f)}, volume, static_cast<float>(spacing)};
}

// What bodies that share their samples have in common: the mesh, and how far apart the samples are.
using SheetKey = std::pair<int, double>;
SheetKey sheet_key(const Scene& scene, const Body& body, double spacing) {
  return {body.mesh, boundary_spacing(scene, body, spacing)};
}

// The share of the work that the surfaces are, each boundary layer counted once.
class Work {
 public:
  Work(const Scene& scene, double spacing, const std::function<void(double)>& tell)
      : scene_(scene), spacing_(spacing), tell_(tell) {
    if (!tell) return;
    std::set<SheetKey> sheets;
    for (const Body& body : scene.bodies) {
      if (!body.point_probe && sheets.insert(sheet_key(scene, body, spacing)).second)
        whole_ += seconds_of(body);
    }
    whole_ += estimate_sampling({estimate_particles(scene, spacing).fluid, 0.0});
  }
  /// For sample_mesh of that body.
  std::function<void(double)> within(const Body& body) const {
    if (!tell_) return {};
    return [this, &body](double share) { tell_((done_ + share * seconds_of(body)) / whole_); };
  }
  void end(const Body& body) {
    if (!tell_) return;
    done_ += seconds_of(body);
    tell_(done_ / whole_);
  }

 private:
  double seconds_of(const Body& body) const {
    return estimate_sampling({0.0, surface_particles(scene_, body, spacing_)});
  }

  const Scene& scene_;
  double spacing_;
  const std::function<void(double)>& tell_;
  double whole_ = 0.0, done_ = 0.0;  // s
};

Result<SampledScene> sample(const Scene& scene, double spacing, SampleReport* report,
                            const std::function<void(double)>& tell) {
  if (!(spacing >= 1e-5 && spacing <= 10.0)) {
    return Error{sampling::place_of(scene, "spacing"), "is " + short_number(spacing) + " m",
                 "Give 0.00001 to 10 m"};
  }
  if (const auto problem = check_size(scene, spacing)) return *problem;
  SampledScene out;
  out.spacing = spacing;
  std::map<SheetKey, std::size_t> first_sampled;
  Work work(scene, spacing, tell);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (body.point_probe) {
      out.surfaces.push_back(sample_probe(spacing));
      out.distance_fields.emplace_back();
      continue;
    }
    const auto [known, is_new] = first_sampled.try_emplace(sheet_key(scene, body, spacing), b);
    if (is_new) {
      Result<SampledMesh> sampled = sample_mesh(scene, body, spacing, work.within(body));
      if (!sampled) return sampled.error();
      work.end(body);
      out.surfaces.push_back(std::move(sampled.value().surface));
      out.distance_fields.push_back(std::move(sampled.value().field));
    } else {
      out.surfaces.push_back(SurfaceSamples(out.surfaces[known->second]));
      out.distance_fields.push_back(DistanceField(out.distance_fields[known->second]));
    }
  }
  for (const Region& region : scene.regions) {
    const TriangleMesh& triangles = scene.meshes[static_cast<std::size_t>(region.mesh)];
    out.region_fields.push_back(sampling::make_distance_field(triangles, mesh::MeshTree(triangles), spacing));
  }
  if (const auto problem = sampling::fill_fluids(scene, out, report)) return *problem;
  return out;
}

}  // namespace

double boundary_spacing(const Scene& scene, const Body& body, double spacing) {
  const bool smooth = body.motion == BodyMotion::kFixed && body.dynamic_viscosity == kFreeSlip &&
                      corrects_gradients(scene.model);
  return smooth ? kSmoothSheet * spacing : spacing;
}

Result<SampledScene> sample_scene(const Scene& scene, double spacing, SampleReport* report,
                                  const std::function<void(double)>& tell) {
  try {
    return sample(scene, spacing, report, tell);
  } catch (const std::exception& problem) {  // out of memory
    return Error{scene.source_file, std::string("cannot be sampled: ") + problem.what(),
                 "Choose a larger spacing"};
  }
}

ParticleEstimate estimate_particles(const Scene& scene, double spacing) {
  ParticleEstimate estimate;
  for (const FluidVolume& volume : scene.fluid_volumes) {
    const mesh::WeldedMesh welded = mesh::weld(scene.meshes[volume.mesh]);
    mesh::Components parts;
    mesh::find_defects(welded, &parts);
    estimate.fluid += mesh::integrate_union(welded, parts).solid.volume / (spacing * spacing * spacing);
  }
  for (const Body& body : scene.bodies) {
    estimate.surface += body.point_probe ? 1.0 : surface_particles(scene, body, spacing);
  }
  return estimate;
}

double estimate_sampling(const ParticleEstimate& particles) {
  return kSecondsASurfaceParticle * particles.surface + kSecondsAFluidParticle * particles.fluid;
}

double thinnest_wall(const Scene& scene, std::size_t* body) {
  double thinnest = std::numeric_limits<double>::infinity();
  std::map<int, double> known;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (scene.bodies[b].point_probe) continue;
    const TriangleMesh& triangles = scene.meshes[scene.bodies[b].mesh];
    const auto [entry, is_new] = known.try_emplace(scene.bodies[b].mesh, 0.0);
    if (is_new) entry->second = sampling::wall_thickness(triangles, mesh::MeshTree(triangles));
    if (entry->second >= thinnest) continue;
    thinnest = entry->second;
    if (body) *body = b;
  }
  return thinnest;
}

}  // namespace slosh
