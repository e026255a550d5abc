// How far and how fast anything may be: one place for the reader of scenes, `check`, the hands, the host and
// the wire.
#pragma once

#include <glm/glm.hpp>

namespace slosh {

/// m from the scene's origin along each axis, of whatever takes part: particles are kept in floats, which are
/// 0.06 mm apart there.
constexpr double kFarthestPlace = 1000.0;

constexpr double kHandleReach = 5.0;           ///< m beyond the scene's domain
constexpr double kHandleSpeed = 20.0;          ///< m/s
constexpr double kHandleAngularSpeed = 100.0;  ///< rad/s

/// Of driven bodies between two keys: m/s of the mesh frame's origin, rad/s.
constexpr double kDrivenSpeed = 20.0;
constexpr double kDrivenAngularSpeed = 100.0;

/// m from the origin: what is farther is a broken device, no hand.
constexpr double kFarthestHandle = 2.0e3;
static_assert(
    kFarthestHandle > 1.74 * (kFarthestPlace + kHandleReach),
    "a hand can be wherever a scene and its domain may be (the diagonal of a cube is 1.733 of its edge)");

/// The box within which hands are accepted, m, by a scene's domain: a domain may be larger than anything that
/// is in it.
inline glm::dvec3 lowest_handle(const glm::dvec3& domain_min) {
  return glm::max(domain_min, glm::dvec3(-kFarthestPlace)) - kHandleReach;
}
inline glm::dvec3 highest_handle(const glm::dvec3& domain_max) {
  return glm::min(domain_max, glm::dvec3(kFarthestPlace)) + kHandleReach;
}

}  // namespace slosh
