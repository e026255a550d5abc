// Where the particles sit by which one body presses.
#pragma once

#include <vector>

#include "scenes/scene.h"
#include "sim/plan.h"
#include "sim/viscosity/wall_drag.h"
#include "sim/walls/sheet.h"

namespace slosh {

/// The surface's mean curvature times the spacing at a sample of it, from -0.7 (concave) to 0.7 (a ball
/// of 1.4 spacings). 0 where it is less than 0.02, and where there is no spacing of solid behind it: at edges
/// and on thin walls. `spacing`: m, of the fluid.
float bend(const SolidShape& solid, const glm::vec3& sample, const glm::vec3& normal, float spacing);

/// How deep a body's sheet lies, spacings.
struct SheetDepths {
  float flat, concave, convex;  ///< convex: before it is less by how much it is bent

  float at(float bent) const;
};

/// Of samples that are `apart` m from each other.
SheetDepths sheet_depths(const Scene& scene, const Plan& plan, float apart, DragSheet sheet);

/// One body's particles, in its mesh frame. `solid`: null for a body that is made of samples alone.
std::vector<SheetParticle> body_sheet(const SurfaceSamples& surface, const DistanceFieldView& field,
                                      const SolidShape* solid, const Plan& plan, const SheetDepths& deep);

}  // namespace slosh
