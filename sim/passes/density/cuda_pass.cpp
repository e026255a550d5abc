#include "sim/cuda/state.h"

namespace slosh::passes {

void density_on_cuda(cuda::CudaState& s, const PassInputs&) {
  if (s.check.failed()) return;
  launch_density(s.step, s.constants.plan, s.kinds.data(),
                 any_artificial_viscosity(s.constants.kinds, s.constants.correction.artificial_viscosity),
                 s.fluid.sorted(), s.fixed.sorted(), s.moving.sorted(), s.report.status(), s.stream);
  s.check.launched("density");
}

}  // namespace slosh::passes
