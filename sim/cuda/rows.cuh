// A particle's neighbours: nine rows of three cells, each one run of memory.
#pragma once

#include "sim/cuda/kernels.h"

namespace slosh::cuda {

inline constexpr int kThreads = 128;

inline unsigned blocks_for(std::uint32_t count, int threads = kThreads) {
  return (count + static_cast<unsigned>(threads) - 1) / static_cast<unsigned>(threads);
}

__device__ inline std::uint32_t thread_index() {
  return blockIdx.x * blockDim.x + threadIdx.x;
}

/// Calls f(j) for every particle in the 27 cells around `cell`, in memory's order.
template <class F>
__device__ inline void for_neighbors(const CellGrid& grid, const CellTable& cells, std::uint32_t cell,
                                     F&& f) {
  for (std::uint32_t n = 0; n < 9; ++n) {
    const std::uint32_t first = grid.row_around(cell, n);
    const std::uint32_t begin =
        min(min(__ldg(cells.begin + first), __ldg(cells.begin + first + 1)), __ldg(cells.begin + first + 2));
    const std::uint32_t end =
        max(max(__ldg(cells.end + first), __ldg(cells.end + first + 1)), __ldg(cells.end + first + 2));
    for (std::uint32_t j = begin; j < end; ++j) f(j);
  }
}

/// Whether there is any particle in the 27 cells around `cell`.
__device__ inline bool any_near(const CellGrid& grid, const CellTable& cells, std::uint32_t cell) {
  std::uint32_t end = 0;
  for (std::uint32_t n = 0; n < 9; ++n) {
    const std::uint32_t first = grid.row_around(cell, n);
    end |= __ldg(cells.end + first) | __ldg(cells.end + first + 1) | __ldg(cells.end + first + 2);
  }
  return end != 0;
}

}  // namespace slosh::cuda
