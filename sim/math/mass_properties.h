// The mass of a rigid body, where it is and how it is spread.
#pragma once

#include <glm/glm.hpp>

namespace slosh {

struct MassProperties {
  double mass = 0.0;               ///< kg, > 0
  glm::dvec3 center_of_mass{0.0};  ///< m, in the body's mesh frame
  glm::dmat3 inertia{0.0};         ///< kg·m², about the centre of mass, mesh axes

  bool operator==(const MassProperties&) const = default;
};

}  // namespace slosh
