#include "sim/fluid_extremes.h"

#include <algorithm>

namespace slosh {

FluidExtremes fluid_extremes(const Scene& scene) {
  if (scene.fluid_volumes.empty()) return {1000.0, 1000.0, 0.0, 0.0};
  FluidExtremes e;
  for (const FluidVolume& volume : scene.fluid_volumes) {
    const Fluid& fluid = scene.fluids[volume.fluid];
    e.lightest = std::min(e.lightest, fluid.rest_density);
    e.heaviest = std::max(e.heaviest, fluid.rest_density);
    e.least_viscous = std::min(e.least_viscous, fluid.dynamic_viscosity);
    e.most_viscous = std::max(e.most_viscous, fluid.dynamic_viscosity);
  }
  return e;
}

}  // namespace slosh
