#include "sim/cuda/state.h"

namespace slosh::passes {

void pressure_force_on_cuda(cuda::CudaState& s, const PassInputs& in) {
  const Plan& plan = s.constants.plan;
  // The wrenches first: the bodies' solve on the CPU needs them alone, and runs while the GPU goes on.
  if (plan.has(PassId::kWrenches)) cuda::find_wrenches(s);
  if (!s.probes_report()) s.report.fetch(s.check, s.stream);
  if (s.check.failed()) return;
  launch_force(s.step, plan, s.kinds.data(), s.fluid.sorted(), s.fixed.sorted(), s.moving.sorted(), s.stream);
  s.check.launched("forces");
  // While the CPU sees where the bodies are going.
  if (plan.has(PassId::kImplicitViscosity))
    s.viscous.write_rows(s.solve_sides(), static_cast<float>(in.dt), s.check, s.stream);
  if (plan.has(PassId::kPressureSolve)) s.pressure.push_by_last(s.solve_sides(), s.check, s.stream);
}

}  // namespace slosh::passes
