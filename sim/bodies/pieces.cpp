#include "sim/bodies/pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace slosh {
namespace {

bool comes_first(const glm::dvec3& a, const glm::dvec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

// Where the way between two points, one on each side, meets the plane. Whichever of two faces asks, and from
// whichever side of the plane, gets the same bits: so that pieces fit and faces close.
glm::dvec3 crossing(const glm::dvec3& a, const glm::dvec3& b, double at_a, double at_b) {
  if (at_a == 0.0) return a;
  if (at_b == 0.0) return b;
  return comes_first(a, b) ? a + (b - a) * (at_a / (at_a - at_b)) : b + (a - b) * (at_b / (at_b - at_a));
}

void add_corner(const glm::dvec3& p, std::vector<glm::dvec3>& corners) {
  if (corners.empty() || corners.back() != p) corners.push_back(p);
}

// Two axes that with `normal` are a right-handed frame.
struct PlaneAxes {
  glm::dvec3 u, v;
  PlaneAxes(const glm::dvec3& normal, const glm::dvec3& along)
      : u(glm::normalize(along - glm::dot(along, normal) * normal)), v(glm::cross(normal, u)) {}
  explicit PlaneAxes(const glm::dvec3& normal)
      : PlaneAxes(normal, std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)) {}
  glm::dvec2 of(const glm::dvec3& p) const { return {glm::dot(p, u), glm::dot(p, v)}; }
};

// The points, which lie on a convex outline, in its order about the normal.
void put_in_order(const glm::dvec3& normal, std::vector<glm::dvec3>& rim) {
  std::sort(rim.begin(), rim.end(), comes_first);
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  glm::dvec3 middle(0.0);
  for (const glm::dvec3& p : rim) middle += p / static_cast<double>(rim.size());
  const PlaneAxes axes(normal);
  const auto angle = [&](const glm::dvec3& p) {
    const glm::dvec2 at = axes.of(p - middle);
    return std::atan2(at.y, at.x);
  };
  std::stable_sort(rim.begin(), rim.end(),
                   [&](const glm::dvec3& a, const glm::dvec3& b) { return angle(a) < angle(b); });
}

glm::dvec3 longest_edge(const std::vector<glm::dvec3>& corners) {
  glm::dvec3 longest(0.0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 edge = corners[(i + 1) % corners.size()] - corners[i];
    if (glm::length(edge) > glm::length(longest)) longest = edge;
  }
  return longest;
}

// A grid of cells about as wide as samples are apart, along the longest edge, so that a rectangle is covered
// evenly up to its edges. Those samples stay whose place is on the face.
void cover(const ConvexSolid::Face& face, double apart, SurfaceSamples& out) {
  const glm::dvec3 along = longest_edge(face.corners);
  if (face.corners.size() < 3 || !(glm::length(along) > 0.0)) return;
  const PlaneAxes axes(face.normal, along);
  std::vector<glm::dvec2> outline;
  for (const glm::dvec3& p : face.corners) outline.push_back(axes.of(p));
  glm::dvec2 lower = outline.front(), upper = lower;
  for (const glm::dvec2& p : outline) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  const glm::dvec2 size = upper - lower;
  const glm::dvec2 cells = glm::max(glm::round(size / apart), glm::dvec2(1.0));
  const double height = glm::dot(face.corners.front(), face.normal);
  const auto is_on_face = [&](const glm::dvec2& p) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const glm::dvec2 edge = outline[(i + 1) % outline.size()] - outline[i], way = p - outline[i];
      if (edge.x * way.y - edge.y * way.x < 0.0) return false;
    }
    return true;
  };
  for (double y = 0.5; y < cells.y; y += 1.0) {
    for (double x = 0.5; x < cells.x; x += 1.0) {
      const glm::dvec2 at = lower + size * glm::dvec2(x, y) / cells;
      if (!is_on_face(at)) continue;
      out.positions.emplace_back(at.x * axes.u + at.y * axes.v + height * face.normal);
      out.normals.emplace_back(face.normal);
    }
  }
}

}  // namespace

ConvexSolid convex_solid(const TriangleMesh& mesh) {
  ConvexSolid solid;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const glm::dvec3 area = glm::cross(b - a, c - a);
    if (glm::length(area) > 0.0) solid.faces.push_back({{a, b, c}, glm::normalize(area), -1});
  }
  return solid;
}

ConvexSolid clipped(const ConvexSolid& solid, const CutPlane& plane, int number) {
  ConvexSolid out;
  std::vector<glm::dvec3> rim;
  for (const ConvexSolid::Face& face : solid.faces) {
    std::vector<glm::dvec3> kept;
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const glm::dvec3& a = face.corners[i];
      const glm::dvec3& b = face.corners[(i + 1) % face.corners.size()];
      const double at_a = plane.distance(a), at_b = plane.distance(b);
      if (at_a <= 0.0) add_corner(a, kept);
      if ((at_a <= 0.0) == (at_b <= 0.0)) continue;
      const glm::dvec3 p = crossing(a, b, at_a, at_b);
      add_corner(p, kept);
      rim.push_back(p);
    }
    if (kept.size() > 1 && kept.back() == kept.front()) kept.pop_back();
    if (kept.size() >= 3) out.faces.push_back({std::move(kept), face.normal, face.plane});
  }
  if (rim.empty()) return out;
  put_in_order(plane.normal, rim);
  if (rim.size() >= 3) out.faces.push_back({std::move(rim), plane.normal, number});
  return out;
}

ConvexSolid clipped(const ConvexSolid& solid, std::span<const CutPlane> planes) {
  ConvexSolid out = solid;
  for (std::size_t i = 0; i < planes.size(); ++i) out = clipped(out, planes[i], static_cast<int>(i));
  return out;
}

SolidIntegrals integrate(const ConvexSolid& solid) {
  SolidIntegrals sum;
  if (solid.faces.empty()) return sum;
  const glm::dvec3 origin = solid.faces.front().corners.front();
  glm::dvec3 first(0.0);
  glm::dmat3 second(0.0);  // ∫ x xᵀ
  for (const ConvexSolid::Face& face : solid.faces) {
    for (std::size_t i = 1; i + 1 < face.corners.size(); ++i) {
      const glm::dvec3 a = face.corners[0] - origin, b = face.corners[i] - origin,
                       c = face.corners[i + 1] - origin;
      const double volume = glm::dot(a, glm::cross(b, c)) / 6.0;
      const glm::dvec3 all = a + b + c;
      sum.volume += volume;
      first += 0.25 * volume * all;
      second += 0.05 * volume *
                (glm::outerProduct(all, all) + glm::outerProduct(a, a) + glm::outerProduct(b, b) +
                 glm::outerProduct(c, c));
    }
  }
  if (!(sum.volume > 0.0)) return {};
  const glm::dvec3 middle = first / sum.volume;
  second -= sum.volume * glm::outerProduct(middle, middle);
  sum.center = origin + middle;
  sum.inertia = glm::dmat3(second[0][0] + second[1][1] + second[2][2]) - second;
  return sum;
}

Extent extent_along(const ConvexSolid& solid, const glm::dvec3& direction) {
  if (solid.faces.empty()) return {};
  Extent extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const ConvexSolid::Face& face : solid.faces) {
    for (const glm::dvec3& p : face.corners) {
      extent.least = std::min(extent.least, glm::dot(p, direction));
      extent.most = std::max(extent.most, glm::dot(p, direction));
    }
  }
  return extent;
}

std::vector<glm::dvec3> section(const ConvexSolid& solid, const CutPlane& plane) {
  std::vector<glm::dvec3> rim;
  for (const ConvexSolid::Face& face : solid.faces) {
    double before = plane.distance(face.corners.back());
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const double now = plane.distance(face.corners[i]);
      if ((before <= 0.0) != (now <= 0.0)) {
        const std::size_t last = i == 0 ? face.corners.size() - 1 : i - 1;
        rim.push_back(crossing(face.corners[last], face.corners[i], before, now));
      }
      before = now;
    }
  }
  if (!rim.empty()) put_in_order(plane.normal, rim);
  if (rim.size() < 3) rim.clear();
  return rim;
}

SurfaceSamples samples_within(const SurfaceSamples& whole, std::span<const CutPlane> planes,
                              const ConvexSolid& solid) {
  SurfaceSamples out;
  out.particle_volume = whole.particle_volume;
  out.apart = whole.apart;
  for (std::size_t i = 0; i < whole.positions.size(); ++i) {
    const glm::dvec3 at(whole.positions[i]);
    if (!std::ranges::all_of(planes, [&](const CutPlane& plane) { return plane.distance(at) < 0.0; }))
      continue;
    out.positions.push_back(whole.positions[i]);
    out.normals.push_back(whole.normals[i]);
  }
  for (const ConvexSolid::Face& face : solid.faces)
    if (face.plane >= 0) cover(face, whole.apart, out);
  return out;
}

DistanceField field_within(const DistanceField& whole, std::span<const CutPlane> planes) {
  DistanceField out = whole;
  for (const CutPlane& plane : planes) {
    const glm::vec3 normal(plane.normal);
    const auto offset = static_cast<float>(plane.offset);
    for_each_node(whole.view(), [&](float, const glm::vec3& p, int node) {
      float& distance = out.distance[static_cast<std::size_t>(node)];
      distance = std::max(distance, glm::dot(normal, p) - offset);
    });
  }
  return out;
}

Corners corners_of(const ConvexSolid& solid) {
  CornerFinder<glm::dvec3> corners;
  for (const ConvexSolid::Face& face : solid.faces)
    for (const glm::dvec3& p : face.corners) corners.add(p, face.normal);
  return corners.found();
}

}  // namespace slosh
