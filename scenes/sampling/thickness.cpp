#include "scenes/sampling/thickness.h"

#include <algorithm>
#include <cmath>

#include "scenes/mesh/closed.h"

namespace slosh::sampling {
namespace {

constexpr int kRays = 2000;
constexpr double kIgnoredShare = 0.05;
constexpr float kOpposite = -0.7f;  // cosine between the normals at a way's two ends

}  // namespace

double wall_thickness(const TriangleMesh& mesh, const mesh::MeshTree& tree) {
  const double share = mesh::surface_area(mesh) / kRays;
  std::vector<float> ways;
  double due = 0.5 * share;
  double walked = 0.0;
  int ray = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::vec3& a = mesh.positions[mesh.triangles[t].x];
    const glm::vec3& b = mesh.positions[mesh.triangles[t].y];
    const glm::vec3& c = mesh.positions[mesh.triangles[t].z];
    walked += 0.5 * glm::length(glm::cross(glm::dvec3(b - a), glm::dvec3(c - a)));
    const glm::vec3 normal = tree.face_normal(static_cast<int>(t));
    for (; due < walked && ray < kRays; due += share, ++ray) {
      // A low-discrepancy place in the triangle (Roberts' R2 sequence): even, and the same every time.
      float u = static_cast<float>(std::fmod(0.5 + 0.7548776662466927 * ray, 1.0));
      float v = static_cast<float>(std::fmod(0.5 + 0.5698402909980532 * ray, 1.0));
      if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
      const glm::vec3 from = a + u * (b - a) + v * (c - a);
      float nearest = INFINITY;
      int facing = -1;
      tree.each_hit(from, -normal, [&](float way, int triangle) {
        if (triangle == static_cast<int>(t) || way < 1e-6f || way >= nearest) return;
        nearest = way;
        facing = triangle;
      });
      if (facing >= 0 && glm::dot(tree.face_normal(facing), normal) < kOpposite) ways.push_back(nearest);
    }
  }
  if (ways.empty()) return INFINITY;
  const auto rank =
      ways.begin() + static_cast<std::ptrdiff_t>(kIgnoredShare * static_cast<double>(ways.size()));
  std::nth_element(ways.begin(), rank, ways.end());
  return *rank;
}

}  // namespace slosh::sampling
