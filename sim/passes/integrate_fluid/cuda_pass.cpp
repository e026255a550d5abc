#include "sim/cuda/state.h"

namespace slosh::passes {

void integrate_fluid_on_cuda(cuda::CudaState& s, const PassInputs& in) {
  // A probe's place changes before the next sort.
  s.sorted_ahead = s.probes.empty();
  s.clamps.send(s.constants.plan, s.prepared, in.after, s.check, s.stream);
  if (!s.check.failed()) {
    const cuda::ProbeOutput probes{static_cast<std::uint32_t>(s.fluid_count), s.report.probes(),
                                   s.sent_probes.slots().data()};
    launch_integrate(s.step, s.kinds.data(), s.fluid.sorted(), static_cast<float>(in.dt),
                     static_cast<float>(speed_limit(s.constants.plan, in.dt)),
                     s.clamps.view(s.constants.impulse_units), probes,
                     s.sorted_ahead ? s.space.view() : cuda::SortView{}, s.report.status(), s.stream);
    s.check.launched("integration");
  }
  if (s.sorted_ahead) {
    s.clock.ended(PassId::kIntegrateFluid, s.check, s.stream);
    s.fluid.sort(s.step, s.space, cuda::Keys::kCounted, s.check, s.stream);
    s.clock.ended(PassId::kSortFluid, s.check, s.stream);
  }
  if (s.probes_report()) s.report.fetch(s.check, s.stream);
}

}  // namespace slosh::passes
