// The radix sort of CUB, in a file of its own: it takes as long to compile as all the rest.
#include <cub/device/device_radix_sort.cuh>

#include "sim/cuda/kernels.h"

namespace slosh::cuda {

cudaError_t sort_by_key(void* temp, std::size_t& temp_bytes, const std::uint32_t* keys,
                        std::uint32_t* sorted_keys, const std::uint32_t* identity, std::uint32_t* order,
                        std::uint32_t count, int bits, cudaStream_t stream) {
  return cub::DeviceRadixSort::SortPairs(temp, temp_bytes, keys, sorted_keys, identity, order, count, 0, bits,
                                         stream);
}

}  // namespace slosh::cuda
