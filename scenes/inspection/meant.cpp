// What loads, and cannot have been meant.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>

#include "scenes/images/decode.h"
#include "scenes/inspection/around.h"
#include "scenes/inspection/inspection.h"
#include "scenes/reading/reading.h"
#include "scenes/sample.h"

namespace slosh::inspection {
namespace {

constexpr double kMaxParticles = 150'000.0;  // at the coarsest spacing: a tenth of real time on two cores
constexpr double kFewParticles = 100.0;  // of fluid, at the finest: a spoonful that is felt as single blows
constexpr std::size_t kCoarse = 300;     // triangles
constexpr double kRound = 0.44;          // rad, 25°: more between a face and its corners' normals is no facet

std::string number(const char* pattern, double value) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

std::string vector_text(const glm::dvec3& v) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g)", v.x + 0.0, v.y + 0.0, v.z + 0.0);
  return text;
}

void look_at_gravity(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings) {
  const glm::dvec3 g = scene.gravity;
  if (-g.y >= std::abs(g.x) && -g.y >= std::abs(g.z)) return;
  if (g == glm::dvec3(0.0)) return;  // weightless on purpose
  warnings.push_back(
      {"gravity-not-down",
       {document.file + ": scene: extras.gravity_m_s2",
        "is " + vector_text(g) + ", which in Blender's world is " + vector_text(in_blender(g)) +
            ": not down. Vectors in custom properties are not turned by the exporter; here y is up",
        "Give (0, -9.81, 0) for Blender's (0, 0, -9.81), or leave it out"}});
}

/// Blender's up is our +z where the exporter did not turn it: a vessel is open there, and closed where we
/// have up.
bool vessels_lie(const Scene& scene) {
  const Around around(scene);
  for (const FluidVolume& volume : scene.fluid_volumes) {
    if (around.closed(volume, {0.0, 0.0, 1.0}) < 0.2 && around.closed(volume, {0.0, 1.0, 0.0}) > 0.8 &&
        around.closed(volume, {0.0, -1.0, 0.0}) > 0.8 && around.closed(volume, {0.0, 0.0, -1.0}) > 0.8)
      return true;
  }
  return false;
}

/// Whoever places a camera keeps the horizon level: its sideways axis has no part along up.
bool camera_lies(const gltf::Document& document) {
  for (const int node : document.nodes) {
    if (document.model.nodes[node].camera < 0) continue;
    const glm::dvec3 side = glm::normalize(glm::dvec3(document.world[node][0]));
    return std::abs(side.z) < 0.01 && std::abs(side.y) > 0.2;
  }
  return false;
}

void look_at_up(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings) {
  const bool vessel = vessels_lie(scene);
  if (!vessel && !camera_lies(document)) return;
  warnings.push_back({"on-its-side",
                      {document.file,
                       vessel ? "lies on its side: its fluid is open to a side and closed upward"
                              : "lies on its side, by its camera",
                       "In Blender's glTF export: Transform > +Y Up on"}});
}

void look_at_size(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings) {
  const double coarsest = scene.spacing > 0.0 ? scene.spacing : scene.spacing_max;
  const double finest = scene.spacing > 0.0 ? scene.spacing : scene.spacing_min;
  const reading::Bounds bounds = reading::bounds_of_scene(scene);
  const glm::dvec3 size = bounds.high - bounds.low;
  const std::string size_text = number("%.3g", size.x) + " x " + number("%.3g", size.z) + " x " +
                                number("%.3g", size.y) + " m (Blender's x, y, z)";
  const ParticleEstimate count = estimate_particles(scene, coarsest);
  if (count.fluid + count.surface > kMaxParticles) {
    warnings.push_back({"large",
                        {document.file,
                         "takes about " + number("%.0f", count.fluid + count.surface) +
                             " particles at its coarsest spacing, " + number("%.3g", 1e3 * coarsest) +
                             " mm; it measures " + size_text,
                         "Ten times too large? In Blender: Scene Properties > Units, Unit Scale 1, and sizes "
                         "in metres (a mug is 0.1). "
                         "Else raise the scene's spacing_max_m"}});
  }
  if (!scene.fluid_volumes.empty() && estimate_particles(scene, finest).fluid < kFewParticles) {
    warnings.push_back(
        {"small",
         {document.file,
          "its fluid is " + number("%.0f", estimate_particles(scene, finest).fluid) +
              " particles at its finest spacing, " + number("%.3g", 1e3 * finest) + " mm; it measures " +
              size_text,
          "Ten times too small? Sizes are in metres (a mug is 0.1). Else lower spacing_min_m"}});
  }
}

/// A mesh of few faces whose corners are shaded as on something round.
bool coarse_and_smooth(const TriangleMesh& mesh) {
  if (mesh.triangles.empty() || mesh.triangles.size() > kCoarse ||
      mesh.normals.size() != mesh.positions.size())
    return false;
  double angles = 0.0;
  std::size_t corners = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    if (glm::length(normal) <= 0.0) continue;
    for (const unsigned corner : {t.x, t.y, t.z}) {
      const glm::dvec3 shaded(mesh.normals[corner]);
      angles += std::acos(std::clamp(glm::dot(glm::normalize(normal), shaded), -1.0, 1.0));
      corners += 1;
    }
  }
  return corners > 0 && angles / static_cast<double>(corners) > kRound;
}

void look_at_modifiers(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings) {
  const auto look = [&](const std::string& name, int mesh) {
    if (mesh < 0) return;
    const TriangleMesh& triangles = scene.meshes[static_cast<std::size_t>(mesh)];
    if (!coarse_and_smooth(triangles)) return;
    warnings.push_back(
        {"coarse-and-smooth",
         {document.file + ": node '" + name + "'",
          "has " + std::to_string(triangles.triangles.size()) +
              " triangles and is shaded as if it were round: was a Subdivision Surface left out?",
          "In Blender's glTF export: Data > Mesh > Apply Modifiers; if it is meant so, Object > Shade "
          "Flat"}});
  };
  for (const Body& body : scene.bodies)
    if (!body.point_probe) look(body.name, body.mesh);
  for (const FluidVolume& volume : scene.fluid_volumes) look(volume.name, volume.mesh);
}

}  // namespace

glm::dvec3 in_blender(const glm::dvec3& place) {
  return {place.x, 0.0 - place.z, place.y};
}

namespace {

void look_at_textures(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings) {
  for (const SceneImage& image : scene.images) {
    const auto unpacked = images::decode(image.bytes, document.file + ": image '" + image.name + "'");
    if (!unpacked) warnings.push_back({"texture", unpacked.error()});
  }
}

}  // namespace

void look_at_scene(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings) {
  look_at_gravity(document, scene, warnings);
  look_at_up(document, scene, warnings);
  look_at_size(document, scene, warnings);
  look_at_modifiers(document, scene, warnings);
  look_at_reach(document, scene, warnings);
  look_at_textures(document, scene, warnings);
}

}  // namespace slosh::inspection
