#include "scenes/mesh/closed.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace slosh::mesh {
namespace {

struct VolumeTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using VolumeMesh = OpenMesh::TriMesh_ArrayKernelT<VolumeTraits>;

struct EdgeUse {
  std::uint32_t low;
  std::uint32_t high;
  std::uint32_t triangle;
  bool forward;  ///< the triangle runs from low to high
};

std::vector<EdgeUse> sorted_edges(const WeldedMesh& mesh) {
  std::vector<EdgeUse> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = mesh.triangles[t][i];
      const std::uint32_t b = mesh.triangles[t][(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return edges;
}

int find_root(std::vector<int>& parent, int i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

/// OpenMesh takes no vertex where two parts touch; each part gets vertices of its own.
VolumeMesh to_open_mesh(const WeldedMesh& mesh, const Components& components, int component) {
  VolumeMesh out;
  std::unordered_map<std::uint64_t, VolumeMesh::VertexHandle> handles;
  const auto vertex = [&](std::uint32_t point, int part) {
    const std::uint64_t key = (static_cast<std::uint64_t>(part) << 32) | point;
    auto [entry, added] = handles.try_emplace(key);
    if (added) {
      const glm::dvec3& p = mesh.points[point];
      entry->second = out.add_vertex({p.x, p.y, p.z});
    }
    return entry->second;
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int part = components.of_triangle[t];
    if (component >= 0 && part != component) continue;
    const glm::uvec3& c = mesh.triangles[t];
    out.add_face(vertex(c.x, part), vertex(c.y, part), vertex(c.z, part));
  }
  return out;
}

glm::dvec3 to_glm(const OpenMesh::Vec3d& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

Defects find_defects(const WeldedMesh& mesh, Components* components) {
  Defects defects;
  const std::vector<EdgeUse> edges = sorted_edges(mesh);
  std::vector<int> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high)
      ++end;
    const std::size_t uses = end - begin;
    const bool first = !defects.any();
    if (uses == 1) {
      ++defects.open_edges;
    } else if (uses > 2) {
      ++defects.crowded_edges;
    } else {
      if (edges[begin].forward == edges[begin + 1].forward) ++defects.flipped_edges;
      const int a = find_root(parent, static_cast<int>(edges[begin].triangle));
      const int b = find_root(parent, static_cast<int>(edges[begin + 1].triangle));
      parent[std::max(a, b)] = std::min(a, b);
    }
    if (first && defects.any()) {
      defects.where = 0.5 * (mesh.points[edges[begin].low] + mesh.points[edges[begin].high]);
    }
    begin = end;
  }
  if (components) {
    components->count = 0;
    components->of_triangle.assign(parent.size(), -1);
    for (int t = 0; t < static_cast<int>(parent.size()); ++t) {
      const int root = find_root(parent, t);  // never above t, so it already has its number
      if (root == t)
        components->of_triangle[t] = components->count++;
      else
        components->of_triangle[t] = components->of_triangle[root];
    }
  }
  return defects;
}

VolumeIntegrals integrate_volume(const WeldedMesh& mesh, const Components& components, int component) {
  VolumeIntegrals sums;
  if (mesh.points.empty()) return sums;
  const VolumeMesh surface = to_open_mesh(mesh, components, component);
  const glm::dvec3 reference = mesh.points[0];  // near the mesh, so that little cancels
  glm::dvec3 first(0.0);
  glm::dmat3 second(0.0);
  for (const auto face : surface.faces()) {
    glm::dvec3 corner[3];
    int i = 0;
    for (const auto vertex : surface.fv_range(face)) corner[i++] = to_glm(surface.point(vertex)) - reference;
    // The tetrahedron from the reference to the face: V = a·(b×c)/6, ∫x = V(a+b+c)/4,
    // ∫xxᵀ = V/20 (aaᵀ + bbᵀ + ccᵀ + ssᵀ) with s = a + b + c.
    const double v = glm::dot(corner[0], glm::cross(corner[1], corner[2])) / 6.0;
    const glm::dvec3 s = corner[0] + corner[1] + corner[2];
    sums.volume += v;
    first += v / 4.0 * s;
    glm::dmat3 outer = glm::outerProduct(s, s);
    for (const glm::dvec3& c : corner) outer += glm::outerProduct(c, c);
    second += v / 20.0 * outer;
  }
  if (sums.volume == 0.0) return sums;
  const glm::dvec3 center = first / sums.volume;
  sums.centroid = reference + center;
  second -= sums.volume * glm::outerProduct(center, center);
  sums.inertia = glm::dmat3(second[0][0] + second[1][1] + second[2][2]) - second;
  return sums;
}

double surface_area(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]);
    area += 0.5 *
            glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a));
  }
  return area;
}

}  // namespace slosh::mesh
