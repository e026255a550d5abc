// The Novint Falcon's delta mechanism: three arms' angles to the grip's place and back (Stamper 1997).
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>

namespace slosh {

using FalconAngles = std::array<double, 3>;  ///< rad, of the three arms

/// m from the base's middle, x right, y up, z towards the user. About the middle of the workspace z = 0.150.
FalconAngles falcon_angles(const glm::dvec3& grip, bool& reachable);

/// Closed in three equations, solved by Newton's method from `near` (the grip's last place). Nothing where it
/// does not come to rest: these angles no grip has.
std::optional<glm::dvec3> falcon_grip(const FalconAngles& angles, const glm::dvec3& near);

/// ∂angle/∂place: row i is arm i's. Rad/m.
glm::dmat3 falcon_jacobian(const glm::dvec3& grip, const FalconAngles& angles);

/// N·m of the three motors that put `force` (N) on the hand. Nothing where the mechanism is singular.
std::optional<glm::dvec3> falcon_torques(const glm::dvec3& grip, const FalconAngles& angles,
                                         const glm::dvec3& force);

/// An encoder's count to its arm's angle, rad, and back.
double falcon_angle_of(int count);
double falcon_count_of(double angle);

constexpr double kFalconMiddle = 0.150;  ///< m, z of the workspace's origin

}  // namespace slosh
