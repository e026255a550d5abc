// Stands in for the CUDA backend where the program is built without it.
#include "sim/cuda/cuda_engine.h"

namespace slosh {

CudaDevice find_cuda_device(int) {
  return {false, "", "this program was built without CUDA"};
}

Result<std::unique_ptr<ParticleEngine>> make_cuda_engine(const RunConstants&, const ParticleStart&,
                                                         std::span<const RigidBody>, int) {
  return Error{"backend cuda", find_cuda_device().reason,
               "Build with -DSLOSH_CUDA=ON where there is a CUDA compiler"};
}

std::string cuda_variant(const Plan&, std::uint32_t, int) {
  return {};
}

}  // namespace slosh
