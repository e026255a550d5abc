#include "sim/cuda/state.h"

namespace slosh {

void cuda::find_wrenches(CudaState& s) {
  const Plan& plan = s.constants.plan;
  const bool with_drag = plan.has(PassId::kBodyDrag);
  const SurfaceSides sides{s.fixed, s.moving};
  s.sums.find_forces(s.step, plan, s.constants.kinds.front().viscosity, s.fluid.sorted(), sides, with_drag,
                     s.check, s.stream);
  s.sums.sum(sides, s.sent.bodies(), s.report.wrenches(), with_drag ? s.report.drags() : nullptr, s.check,
             s.stream);
}

}  // namespace slosh

namespace slosh::passes {

// Found by pressure_force_on_cuda() already.
void wrenches_on_cuda(cuda::CudaState&, const PassInputs&) {}

}  // namespace slosh::passes
