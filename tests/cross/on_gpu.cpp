#include "tests/cross/on_gpu.h"

#include <cuda_runtime.h>

#include "sim/cuda/shared_slots.h"

namespace slosh::testing {

Result<std::shared_ptr<const SharedParticles>> put_on_gpu(std::span<const glm::vec3> positions,
                                                          std::span<const std::uint8_t> fluids) {
  const auto failed = [](cudaError_t code) {
    return Error{"particles on the GPU", cudaGetErrorString(code), "Draw from main memory"};
  };
  if (const cudaError_t code = cudaSetDevice(0); code != cudaSuccess) return failed(code);
  cuda::SharedSlots slots;
  if (auto started = slots.start(positions.size()); !started) return started.error();
  const cuda::SharedSlots::Slot slot = slots.take();
  cudaError_t code =
      cudaMemcpy(slot.positions, positions.data(), positions.size_bytes(), cudaMemcpyHostToDevice);
  if (code == cudaSuccess)
    code = cudaMemcpy(slot.kinds, fluids.data(), fluids.size_bytes(), cudaMemcpyHostToDevice);
  if (code == cudaSuccess) code = cudaDeviceSynchronize();
  if (code != cudaSuccess) return failed(code);
  return slot.particles;
}

}  // namespace slosh::testing
