// How deep behind a surface the boundary particle layer lies.
#pragma once

#include "scenes/scene.h"

namespace slosh {

/// In spacings, at a support ratio of 2, of the models that count walls in the density.
inline constexpr double kWallInset = 0.7;

/// In spacings. The first layer of fluid comes to rest where its density is that of a lattice, and with a
/// wider support that is farther from the boundary layer: buoyancy of a body of 8 spacings would be 5.8 % too
/// large at 2.5. So the boundary layer lies deeper by as much, and the fluid's first layer stands where it
/// does at 2 (tests/notebook/2026-11-26-depth-of-the-boundary-layer.md). `support_ratio`: above 1.
double wall_inset(double support_ratio);

/// In spacings: by how much less deep it lies behind flat faces, of which samples are a spacing apart.
/// Fluid's first layer comes to rest over the hollows between them, 0.41 spacings off the face, which would
/// lower a tank's level by 1.7 % (tests/notebook/2026-11-26-depth-of-the-boundary-layer.md). Samples 0.7
/// apart have no hollows.
inline constexpr double kOverHollows = 0.03;

}  // namespace slosh
