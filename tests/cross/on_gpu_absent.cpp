// Where the CUDA backend is left out.
#include "tests/cross/on_gpu.h"

namespace slosh::testing {

Result<std::shared_ptr<const SharedParticles>> put_on_gpu(std::span<const glm::vec3>,
                                                          std::span<const std::uint8_t>) {
  return Error{"particles on the GPU", "this was built without CUDA", "Draw from main memory"};
}

}  // namespace slosh::testing
