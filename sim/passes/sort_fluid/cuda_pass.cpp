#include "sim/cuda/state.h"

namespace slosh::passes {

void sort_fluid_on_cuda(cuda::CudaState& s, const PassInputs&) {
  if (!s.sorted_ahead) s.fluid.sort(s.step, s.space, cuda::Keys::kNotCounted, s.check, s.stream);
}

}  // namespace slosh::passes
