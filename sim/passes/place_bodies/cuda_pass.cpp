#include "sim/cuda/state.h"

namespace slosh::passes {

void place_bodies_on_cuda(cuda::CudaState& s, const PassInputs&) {
  s.moving.place(s.step, s.sent.bodies(), s.space, s.check, s.stream);
}

}  // namespace slosh::passes
