// Where the boundary particles of one body lie that touches no other: how deep behind its surface, at edges,
// behind bent surfaces and in thin walls.
#pragma once

#include <vector>

#include "scenes/scene.h"
#include "sim/plan.h"
#include "sim/viscosity/wall_drag.h"
#include "sim/walls/particle_layer.h"

namespace slosh {

/// The surface's mean curvature times the spacing (m) at p, along the field's gradient there: below 0 where
/// it is concave, 0 where it is flat, at edges and on thin walls.
float bend(const DistanceFieldView& field, const glm::vec3& p, float spacing);

/// How deep a body's layer lies, spacings.
struct Depths {
  float flat, concave, convex;  ///< convex: before it is less the more it is bent

  float at(float bent) const;  ///< `bent` as bend() has it
};
/// Of samples that are `apart` m from each other.
Depths depths_of(const Scene& scene, const Plan& plan, float apart, DragLayer layer);

/// One body's particles in its mesh frame.
std::vector<LayerParticle> own_layer(const SurfaceSamples& surface, const DistanceFieldView& field,
                                     const Plan& plan, const Depths& deep);

}  // namespace slosh
