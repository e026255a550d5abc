// The distance fields of fixed bodies that touch, as of one solid: each for itself knows a face between two
// as a way out, and what the clamp lets into one of them goes on between the two to the other side.
#pragma once

#include <span>
#include <vector>

#include "scenes/scene.h"
#include "sim/walls/exposed_surface.h"

namespace slosh {

/// Deepens `fields`, one a solid and as the solids' own, to the depth below the surface that is left of all,
/// up to two spacings: within a face that another body hides, and right before it. All else stays as it is.
/// `spacing`: m, of the fluid.
void close_joints(std::span<const FixedSolid> solids, float spacing, std::span<DistanceField* const> fields);

}  // namespace slosh
