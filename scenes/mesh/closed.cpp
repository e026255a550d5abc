#include "scenes/mesh/closed.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
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

/// Pairs of triangles around an edge of more than two that have solid between them; none where they do not
/// come out even. Going round the edge from low to high counter-clockwise, a triangle that runs from high to
/// low has its solid ahead, the other kind behind it.
std::vector<std::pair<std::uint32_t, std::uint32_t>> wedges(const WeldedMesh& mesh,
                                                            std::span<const EdgeUse> uses) {
  const auto opens = static_cast<std::size_t>(
      std::count_if(uses.begin(), uses.end(), [](const EdgeUse& use) { return !use.forward; }));
  if (2 * opens != uses.size()) return {};
  const glm::dvec3 from = mesh.points[uses[0].low];
  const glm::dvec3 axis = glm::normalize(mesh.points[uses[0].high] - from);
  const glm::dvec3 aside = std::abs(axis.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(axis, aside));
  const glm::dvec3 v = glm::cross(axis, u);
  struct Side {
    double angle;
    bool opens;
    std::uint32_t triangle;
  };
  std::vector<Side> sides;
  for (const EdgeUse& use : uses) {
    const glm::uvec3& t = mesh.triangles[use.triangle];
    const std::uint32_t third = t.x != use.low && t.x != use.high   ? t.x
                                : t.y != use.low && t.y != use.high ? t.y
                                                                    : t.z;
    const glm::dvec3 way = mesh.points[third] - from;
    // Rounded: faces that lie on each other are at one angle, and there solids end before others begin.
    const double angle = std::round(std::atan2(glm::dot(way, v), glm::dot(way, u)) * 1e7) * 1e-7;
    sides.push_back({angle, !use.forward, use.triangle});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.angle, a.opens, a.triangle) < std::tie(b.angle, b.opens, b.triangle);
  });
  // Begin where nothing is open.
  int open = 0, least = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    open += sides[i].opens ? 1 : -1;
    if (open < least) least = open, begin = i + 1;
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  std::vector<std::uint32_t> stack;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side& side = sides[(begin + i) % sides.size()];
    if (side.opens) {
      stack.push_back(side.triangle);
    } else {
      pairs.emplace_back(stack.back(), side.triangle);
      stack.pop_back();
    }
  }
  return pairs;
}

glm::dvec3 to_glm(const OpenMesh::Vec3d& v) {
  return {v[0], v[1], v[2]};
}

/// The triangles of a part, as OpenMesh walks them where it can: it has no edge of more than two faces.
std::vector<std::array<glm::dvec3, 3>> faces_of(const WeldedMesh& mesh, const Components& components,
                                                int component) {
  std::vector<std::array<glm::dvec3, 3>> faces;
  if (components.touching) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (component >= 0 && components.of_triangle[t] != component) continue;
      const glm::uvec3& c = mesh.triangles[t];
      faces.push_back({mesh.points[c.x], mesh.points[c.y], mesh.points[c.z]});
    }
    return faces;
  }
  const VolumeMesh surface = to_open_mesh(mesh, components, component);
  for (const auto face : surface.faces()) {
    std::size_t i = 0;
    faces.emplace_back();
    for (const auto vertex : surface.fv_range(face)) faces.back()[i++] = to_glm(surface.point(vertex));
  }
  return faces;
}

}  // namespace

Defects find_defects(const WeldedMesh& mesh, Components* components) {
  Defects defects;
  const std::vector<EdgeUse> edges = sorted_edges(mesh);
  std::vector<int> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  bool touching = false;
  const auto join = [&parent](std::uint32_t one, std::uint32_t other) {
    const int a = find_root(parent, static_cast<int>(one));
    const int b = find_root(parent, static_cast<int>(other));
    parent[std::max(a, b)] = std::min(a, b);
  };
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high)
      ++end;
    const std::size_t uses = end - begin;
    const bool first = !defects.any();
    if (uses == 1) {
      ++defects.open_edges;
    } else if (uses > 2) {
      touching = true;
      const auto pairs = wedges(mesh, std::span(edges).subspan(begin, uses));
      if (pairs.empty()) ++defects.crowded_edges;
      for (const auto& [one, other] : pairs) join(one, other);
    } else {
      if (edges[begin].forward == edges[begin + 1].forward) ++defects.flipped_edges;
      join(edges[begin].triangle, edges[begin + 1].triangle);
    }
    if (first && defects.any()) {
      defects.where = 0.5 * (mesh.points[edges[begin].low] + mesh.points[edges[begin].high]);
    }
    begin = end;
  }
  if (components) {
    components->count = 0;
    components->touching = touching;
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

bool drop_inner_faces(TriangleMesh& mesh, const WeldedMesh& welded) {
  struct Waiting {
    std::vector<std::uint32_t> even, odd;  // source triangles whose corners run one way round, and the other
  };
  std::map<std::array<std::uint32_t, 3>, Waiting> places;
  std::vector<bool> gone(mesh.triangles.size(), false);
  bool any = false;
  for (std::size_t i = 0; i < welded.triangles.size(); ++i) {
    const glm::uvec3& t = welded.triangles[i];
    std::array<std::uint32_t, 3> key{t.x, t.y, t.z};
    std::sort(key.begin(), key.end());
    const bool even = (t.x < t.y) + (t.y < t.z) + (t.z < t.x) == 2;
    Waiting& waiting = places[key];
    std::vector<std::uint32_t>& others = even ? waiting.odd : waiting.even;
    if (others.empty()) {
      (even ? waiting.even : waiting.odd).push_back(welded.sources[i]);
      continue;
    }
    gone[others.back()] = gone[welded.sources[i]] = any = true;
    others.pop_back();
  }
  if (!any) return false;
  std::vector<glm::uvec3> kept;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (!gone[i]) kept.push_back(mesh.triangles[i]);
  mesh.triangles = std::move(kept);
  return true;
}

VolumeIntegrals integrate_volume(const WeldedMesh& mesh, const Components& components, int component) {
  VolumeIntegrals sums;
  if (mesh.points.empty()) return sums;
  const glm::dvec3 reference = mesh.points[0];  // near the mesh, so that little cancels
  glm::dvec3 first(0.0);
  glm::dmat3 second(0.0);
  for (const auto& face : faces_of(mesh, components, component)) {
    glm::dvec3 corner[3];
    int i = 0;
    for (const glm::dvec3& point : face) corner[i++] = point - reference;
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
