#include "peer/view/cut_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "sim/math/convex.h"

namespace slosh {
namespace {

struct Vertex {
  glm::vec3 at;
  glm::vec3 normal;
  glm::vec2 texcoord;
};
using Triangle = std::array<Vertex, 3>;

bool comes_first(const glm::vec3& a, const glm::vec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

// Both triangles at an edge get the same bits, so that the mesh stays closed.
Vertex crossing(const Vertex& a, const Vertex& b, double at_a, double at_b) {
  if (comes_first(b.at, a.at)) return crossing(b, a, at_b, at_a);
  const auto share = static_cast<float>(at_a / (at_a - at_b));
  return {glm::mix(a.at, b.at, share), glm::mix(a.normal, b.normal, share),
          glm::mix(a.texcoord, b.texcoord, share)};
}

// The points, which lie on a convex outline, as triangles that look along `normal`.
void close(const glm::vec3& normal, std::vector<glm::vec3>& rim, std::vector<Triangle>& out) {
  std::sort(rim.begin(), rim.end(), comes_first);
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  if (rim.size() < 3) return;
  glm::vec3 middle(0.0f);
  for (const glm::vec3& p : rim) middle += p / static_cast<float>(rim.size());
  const glm::vec3 along = std::abs(normal.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 u = glm::normalize(along - glm::dot(along, normal) * normal), v = glm::cross(normal, u);
  std::vector<std::pair<float, glm::vec3>> turned;
  for (const glm::vec3& p : rim)
    turned.emplace_back(std::atan2(glm::dot(v, p - middle), glm::dot(u, p - middle)), p);
  std::stable_sort(turned.begin(), turned.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto vertex = [&](std::size_t i) { return Vertex{turned[i].second, normal, glm::vec2(0.0f)}; };
  for (std::size_t i = 1; i + 1 < turned.size(); ++i) out.push_back({vertex(0), vertex(i), vertex(i + 1)});
}

std::vector<Triangle> clipped(const std::vector<Triangle>& all, const CutPlane& plane) {
  std::vector<Triangle> out;
  std::vector<glm::vec3> rim;
  for (const Triangle& triangle : all) {
    std::array<Vertex, 4> kept;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex &a = triangle[i], &b = triangle[(i + 1) % 3];
      const double at_a = plane.distance(glm::dvec3(a.at)), at_b = plane.distance(glm::dvec3(b.at));
      if (at_a <= 0.0) kept[count++] = a;
      if ((at_a <= 0.0) == (at_b <= 0.0)) continue;
      kept[count] = crossing(a, b, at_a, at_b);
      rim.push_back(kept[count++].at);
    }
    for (std::size_t i = 1; i + 1 < count; ++i) out.push_back({kept[0], kept[i], kept[i + 1]});
  }
  close(glm::vec3(plane.normal), rim, out);
  return out;
}

}  // namespace

TriangleMesh cut_mesh(const TriangleMesh& mesh, std::span<const CutPlane> planes) {
  if (mesh.triangles.size() > kMaxCutTriangles) return mesh;
  const std::size_t points = mesh.positions.size();
  const auto vertex = [&](std::uint32_t i) {
    return Vertex{mesh.positions[i], i < mesh.normals.size() ? mesh.normals[i] : glm::vec3(0, 1, 0),
                  i < mesh.texcoords.size() ? mesh.texcoords[i] : glm::vec2(0.0f)};
  };
  std::vector<Triangle> all;
  for (const glm::uvec3& t : mesh.triangles)
    if (std::max({t.x, t.y, t.z}) < points) all.push_back({vertex(t.x), vertex(t.y), vertex(t.z)});
  for (const CutPlane& plane : planes) all = clipped(all, plane);

  TriangleMesh cut;
  cut.name = mesh.name;
  for (const Triangle& triangle : all) {
    const auto first = static_cast<std::uint32_t>(cut.positions.size());
    for (const Vertex& v : triangle) {
      cut.positions.push_back(v.at);
      const float length = glm::length(v.normal);
      cut.normals.push_back(length > 0.0f ? v.normal / length : glm::vec3(0, 1, 0));
      if (!mesh.texcoords.empty()) cut.texcoords.push_back(v.texcoord);
    }
    cut.triangles.emplace_back(first, first + 1, first + 2);
  }
  return cut;
}

}  // namespace slosh
