// The lightest and the heaviest, the thinnest and the thickest fluid of a scene.
#pragma once

#include <limits>

#include "scenes/scene.h"

namespace slosh {

/// Over the fluids that a volume of the scene has.
struct FluidExtremes {
  double lightest = std::numeric_limits<double>::infinity(), heaviest = 0.0;           ///< kg/m³
  double least_viscous = std::numeric_limits<double>::infinity(), most_viscous = 0.0;  ///< Pa·s
};
/// Of water without viscosity where the scene has no fluid.
FluidExtremes fluid_extremes(const Scene& scene);

}  // namespace slosh
