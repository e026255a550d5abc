// How strongly a wall's one sheet must drag for fluid to stand still at the surface.
#pragma once

#include "scenes/scene.h"

namespace slosh {

/// Where the wall's particles sit behind the surface, in spacings (walls/wall_particles.cpp).
inline constexpr double kWallInset = 0.7;
/// Where the fluid's first layer stands off it.
inline constexpr double kFirstLayer = 0.5;

/// Of a flat sheet at the spacing against a lattice of fluid, in units of the damping rate that a particle
/// has among the still neighbours of a whole lattice.
struct WallDrag {
  double factor = 1.0;  ///< what a wall particle's volume counts in the drag
  double rate = 0.0;    ///< of a particle of the first layer by the sheet: across and along it together
};

/// The sheet lies kWallInset behind the surface, where one lattice layer would let the fluid slip by 0.8
/// spacings. `factor` is such that in a linear shear, u = γ · (distance from the surface), the layers of
/// fluid within reach of the sheet pass on the stress that layers pass on to each other. Nothing but the
/// support ratio and the kernel decide it. Models other than kCorrected keep 1.
WallDrag wall_drag(ParticleModel model, double support_ratio);

}  // namespace slosh
