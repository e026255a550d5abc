// How deep behind a surface the particles sit by which a wall presses.
#pragma once

#include "scenes/scene.h"

namespace slosh {

/// In spacings, at a support ratio of 2, of the models that count walls in the density.
inline constexpr double kWallInset = 0.7;

/// In spacings. The first layer of fluid comes to rest where its density is that of a lattice, and with a
/// wider support that is farther from the layer: of walls as deep as at a ratio of 2 a body of 8 spacings
/// was 5.8 % too large for what lifted it at 2.5 (3.3 at 2.25). So the layer lies deeper by as much, and the
/// layer stands where it does at 2. `support_ratio`: above 1. In the model that does not correct gradients
/// kWallInset.
double wall_inset(ParticleModel model, double support_ratio);

/// In spacings: by how much less deep it lies behind flat faces, of which samples are a spacing apart.
/// Fluid's first layer comes to rest over the hollows between them, 0.41 spacings off the face: with a layer
/// as deep as a bent surface's a tank's level is 1.7 % low and a plate of 1.4 spacings is lifted by 8 % too
/// little (10 mm). Samples 0.7 apart have no hollows, and the level is 0.6 % low.
inline constexpr double kOverHollows = 0.03;

}  // namespace slosh
