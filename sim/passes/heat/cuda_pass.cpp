#include "sim/cuda/state.h"

namespace slosh::passes {

void heat_on_cuda(cuda::CudaState& s, const PassInputs& in) {
  if (s.check.failed()) return;
  const HeatConstants& c = s.constants.heat;
  const cuda::HeatView view{s.heat_kinds.data(), s.body_temperatures.data(), c.pair_scale,
                            c.wall_scale / c.share_unit, c.by_volume};
  launch_heat(s.step, s.kinds.data(), view, static_cast<float>(in.dt), s.fluid.sorted(), s.fixed.sorted(),
              s.moving.sorted(), s.stream);
  s.check.launched("heat");
}

}  // namespace slosh::passes
