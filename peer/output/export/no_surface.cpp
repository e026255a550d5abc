// In place of fluid_surface.cpp where OpenVDB is not there.
#include "peer/output/export/export_options.h"
#include "peer/output/export/fluid_surface.h"

namespace slosh {

bool can_make_surfaces() {
  return false;
}

SurfaceFrame make_surfaces(const ParticleFrame&, const ExportedFluids& fluids, bool, int) {
  SurfaceFrame none;
  none.fluids.resize(fluids.names.size());
  return none;
}

}  // namespace slosh
