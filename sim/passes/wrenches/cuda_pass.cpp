#include "sim/cuda/state.h"

namespace slosh {

void cuda::find_wrenches(CudaState& s) {
  const Plan& plan = s.constants.plan;
  const bool with_drag = plan.has(PassId::kBodyDrag);
  const SurfaceSides sides{s.fixed, s.moving};
  s.sums.find_forces(s.step, plan, s.constants.kinds.front().viscosity, s.fluid.sorted(), sides, with_drag,
                     s.check, s.stream);
  s.sums.sum_wrenches(sides, s.sent.bodies(), s.report.wrenches(), s.check, s.stream);
  if (with_drag) s.sums.sum_drags(sides, s.sent.bodies(), s.report.drags(), s.check, s.stream);
}

}  // namespace slosh

namespace slosh::passes {

// Found by pressure_force_on_cuda() already.
void wrenches_on_cuda(cuda::CudaState&, const PassInputs&) {}

}  // namespace slosh::passes
