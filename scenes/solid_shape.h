// A body's solid, asked where its surface is.
#pragma once

#include <glm/glm.hpp>

#include "sim/math/distance_field.h"

namespace slosh {

/// The solid inside a closed mesh, in the mesh's frame: inside is inside any of its parts. Immutable; safe
/// from several threads.
class SolidShape {
 public:
  virtual ~SolidShape() = default;

  /// The signed distance, m, and its gradient, unit: exact (to rounding), where a DistanceField is round at
  /// edges and costs a hundredth.
  virtual DistanceSample at(const glm::vec3& point) const = 0;

  /// m from a point of the surface straight through the solid, along `inward` (unit). Infinity where that
  /// ends on a surface which slants by more than 60 degrees, as it may from an edge itself.
  virtual float thickness(const glm::vec3& surface, const glm::vec3& inward) const = 0;
};

}  // namespace slosh
