#include "sim/cuda/state.h"

namespace slosh::passes {

void bonds_on_cuda(cuda::CudaState& s, const PassInputs& in) {
  if (s.check.failed()) return;
  const float reach = kBondReach * static_cast<float>(s.constants.plan.spacing);
  launch_bonds(s.step, s.heat_kinds.data(), in.look, reach, s.constants.heat.bond_lengths, s.fluid.sorted(),
               s.bonds.view(), s.stream);
  s.check.launched("bonds");
}

}  // namespace slosh::passes
