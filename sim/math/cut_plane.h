// The plane of a cut.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

namespace slosh {

/// What is kept of a body that was cut lies where distance() is not above 0.
struct CutPlane {
  glm::dvec3 normal{0.0, 1.0, 0.0};  ///< unit, out of what is kept
  double offset{};                   ///< m, of the plane along it

  double distance(const glm::dvec3& at) const { return glm::dot(normal, at) - offset; }
  CutPlane reversed() const { return {-normal, -offset}; }
  bool operator==(const CutPlane&) const = default;
};

/// Of one body: so often what is left of it may be cut again.
inline constexpr std::size_t kMaxCutPlanes = 8;

}  // namespace slosh
