// CUB's running sum, in a file of its own: it takes long to compile.
#include <cub/device/device_scan.cuh>

#include "sim/cuda/kernels.h"

namespace slosh::cuda {

cudaError_t exclusive_sum(void* temp, std::size_t& temp_bytes, const std::uint32_t* counts,
                          std::uint32_t* starts, std::uint32_t count, cudaStream_t stream) {
  return cub::DeviceScan::ExclusiveSum(temp, temp_bytes, counts, starts, count, stream);
}

}  // namespace slosh::cuda
