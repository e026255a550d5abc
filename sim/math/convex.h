// Is a closed mesh convex?
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <span>

namespace slosh {

inline constexpr std::size_t kMaxCutTriangles = 2000;  ///< of a body that may be cut

/// Whether no point is before any triangle's plane, by more than rounding of a file's numbers (1e-5 of the
/// mesh's size). Every triangle is looked at with every point.
template <class Point>
bool is_convex(std::span<const Point> points, std::span<const glm::uvec3> triangles) {
  constexpr double kRounding = 1e-5;
  if (points.empty()) return false;
  Point lower = points.front(), upper = lower;
  for (const Point& p : points) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  const double most = kRounding * glm::length(glm::dvec3(upper - lower));
  return std::ranges::all_of(triangles, [&](const glm::uvec3& t) {
    const glm::dvec3 a(points[t.x]);
    const glm::dvec3 area = glm::cross(glm::dvec3(points[t.y]) - a, glm::dvec3(points[t.z]) - a);
    const double twice = glm::length(area);
    return std::ranges::all_of(
        points, [&](const Point& p) { return glm::dot(glm::dvec3(p) - a, area) <= most * twice; });
  });
}

}  // namespace slosh
