#include "scenes/mesh/convex.h"

#include <algorithm>

namespace slosh::mesh {

bool is_convex(const WeldedMesh& mesh) {
  constexpr double kRounding = 1e-5;
  if (mesh.points.empty()) return false;
  glm::dvec3 lower = mesh.points.front(), upper = lower;
  for (const glm::dvec3& p : mesh.points) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  const double most = kRounding * glm::length(upper - lower);
  return std::ranges::all_of(mesh.triangles, [&](const glm::uvec3& t) {
    const glm::dvec3& a = mesh.points[t.x];
    const glm::dvec3 area = glm::cross(mesh.points[t.y] - a, mesh.points[t.z] - a);
    const double twice = glm::length(area);
    return std::ranges::all_of(mesh.points,
                               [&](const glm::dvec3& p) { return glm::dot(p - a, area) <= most * twice; });
  });
}

}  // namespace slosh::mesh
