#include "sim/cuda/state.h"

namespace slosh::passes {

void body_drag_on_cuda(cuda::CudaState& s, const PassInputs& in) {
  s.sent.send_twists(in.changes, s.check, s.stream);
  if (s.check.failed()) return;
  launch_drag(s.step, s.constants.plan, s.kinds.data(), s.fluid.sorted(), s.moving.sorted(), s.sent.twists(),
              s.stream);
  s.check.launched("drag");
}

}  // namespace slosh::passes
