// How many layers of fluid a wall is in the moment of the fluid beside it.
#pragma once

namespace slosh {

/// In the moment matrix of thick fluid, where that of thin fluid has one. With one layer still syrup beside
/// no-slip walls circulates. Fitted to tanks of 2 Pa·s at support ratios 1.5 to 2.6, linear between them:
/// tests/notebook, 2026-11-26-wall-layers.csv and 2026-11-26-still-syrup-creeps.md.
double thick_layers(double support_ratio);

/// CorrectionConstants::wall_layer for a run whose fluids have at least `viscosity`, Pa·s. `noise`: Pa·s, the
/// artificial viscosity (viscosity/artificial_viscosity.h).
float wall_layer(float noise, float viscosity, double support_ratio);

}  // namespace slosh
