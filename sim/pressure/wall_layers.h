// How many layers of fluid a wall is in the moment of the fluid beside it.
#pragma once

namespace slosh {

/// In the moment of thick fluid, where that of thin fluid has one. With one each layer of fluid beside a wall
/// that holds bears another share of its weight, and still syrup goes round by itself (2 Pa·s, 16 cm deep, 10
/// mm: along the axis at 0 to 13 mm/s). Read from such tanks, where it rises no more, at the ratios 1.5
/// to 2.6 that a scene may have; between them along straight lines. Source: tests/notebook,
/// 2026-11-26-wall-layers.csv and 2026-11-26-still-syrup-creeps.md.
double thick_layers(double support_ratio);

/// CorrectionConstants::wall_layer for a run whose fluids have at least `viscosity`, Pa·s. `noise`: Pa·s,
/// what jostling would need.
float wall_layer(float noise, float viscosity, double support_ratio);

}  // namespace slosh
