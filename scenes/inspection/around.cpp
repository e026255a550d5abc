#include "scenes/inspection/around.h"

#include <algorithm>

namespace slosh::inspection {
namespace {

constexpr std::size_t kMaxLookedAt = 32;  // places of a fluid from which is looked around

}  // namespace

Around::Around(const Scene& scene) : scene_(scene) {
  for (const Body& body : scene.bodies)
    trees_.push_back(body.mesh >= 0 ? mesh::MeshTree(scene.meshes[static_cast<std::size_t>(body.mesh)])
                                    : mesh::MeshTree(TriangleMesh{}));
}

double Around::closed(const FluidVolume& volume, const glm::dvec3& way) const {
  const TriangleMesh& mesh = scene_.meshes[static_cast<std::size_t>(volume.mesh)];
  glm::dvec3 middle(0.0);
  for (const glm::vec3& p : mesh.positions) middle += glm::dvec3(p);
  middle /= static_cast<double>(std::max<std::size_t>(mesh.positions.size(), 1));
  const std::size_t every = std::max<std::size_t>(1, mesh.positions.size() / kMaxLookedAt);
  int seen = 0;
  int all = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); i += every) {
    const glm::dvec3 local = 0.5 * (middle + glm::dvec3(mesh.positions[i]));
    seen += meets(transform_point(volume.pose, local), way) ? 1 : 0;
    all += 1;
  }
  return all > 0 ? static_cast<double>(seen) / all : 0.0;
}

bool Around::meets(const glm::dvec3& from, const glm::dvec3& way) const {
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    if (trees_[b].triangle_count() == 0) continue;
    const Pose to_mesh = inverse(scene_.bodies[b].pose);
    bool met = false;
    trees_[b].each_hit(glm::vec3(transform_point(to_mesh, from)), glm::vec3(to_mesh.orientation * way),
                       [&](float, int) { met = true; });
    if (met) return true;
  }
  return false;
}

}  // namespace slosh::inspection
