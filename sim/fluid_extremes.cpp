#include "sim/fluid_extremes.h"

#include <algorithm>

#include "sim/passes/heat/conduction.h"

namespace slosh {

FluidExtremes fluid_extremes(const Scene& scene) {
  if (scene.fluid_volumes.empty()) return {1000.0, 1000.0, 0.0, 0.0};
  FluidExtremes e;
  for (const FluidVolume& volume : scene.fluid_volumes) {
    const Fluid& fluid = scene.fluids[volume.fluid];
    e.lightest = std::min(e.lightest, fluid.rest_density);
    e.heaviest = std::max(e.heaviest, fluid.rest_density);
    const ViscosityRange range = viscosity_range(scene, fluid);
    e.least_viscous = std::min(e.least_viscous, range.least);
    e.most_viscous = std::max(e.most_viscous, range.most);
  }
  return e;
}

}  // namespace slosh
