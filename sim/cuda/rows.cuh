// A particle's neighbours: nine rows of three cells, each one run of memory.
#pragma once

#include "sim/cuda/kernels.h"
#include "sim/math/symmetric.h"

namespace slosh::cuda {

inline constexpr int kThreads = 128;
/// How many blocks a multiprocessor holds at least of the density pass and of forces with particle stresses:
/// 64 registers a thread. By itself the compiler takes 66 to 80, and a step of a million particles a fifth
/// longer (tests/bench/results/2026-11-27-passed-steps-h100.csv).
inline constexpr int kBlocksOfTensors = 8;

inline unsigned blocks_for(std::uint32_t count, int threads = kThreads) {
  return (count + static_cast<unsigned>(threads) - 1) / static_cast<unsigned>(threads);
}

/// Whether the GPU can bring a kernel up while the one before it ends (programmatic dependent launch): up to
/// a tenth of a step of small kernels.
inline bool launches_early() {
  static const bool can = [] {
    int device = 0, major = 0;
    return cudaGetDevice(&device) == cudaSuccess &&
           cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, device) == cudaSuccess &&
           major >= 9;
  }();
  return can;
}

/// kernel<<<blocks, threads, 0, stream>>>(arguments…) for a kernel that begins with wait_for_last_kernel().
template <class... Parameters, class... Arguments>
void launch_early(void (*kernel)(Parameters...), unsigned blocks, unsigned threads, cudaStream_t stream,
                  Arguments&&... arguments) {
  cudaLaunchAttribute early{};
  early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  early.val.programmaticStreamSerializationAllowed = 1;
  const cudaLaunchConfig_t config{dim3(blocks), dim3(threads), 0, stream, &early, launches_early() ? 1u : 0u};
  static_cast<void>(cudaLaunchKernelEx(&config, kernel, Parameters(arguments)...));  // CallCheck::launched()
}

/// Returns when all is over that the stream had before, and lets the next kernel come up to here.
__device__ inline void wait_for_last_kernel() {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
  cudaTriggerProgrammaticLaunchCompletion();
  cudaGridDependencySynchronize();
#endif
}

__device__ inline std::uint32_t thread_index() {
  return blockIdx.x * blockDim.x + threadIdx.x;
}

/// The `lanes` neighbouring threads of a warp (1, 2 or 4) that share one particle's neighbours. A world
/// of 30,000 particles, one thread each, leaves most of a GPU waiting for memory.
template <int lanes>
struct Team {
  static constexpr std::uint32_t kLanes = lanes;
  /// Which particle is this thread's.
  __device__ static std::uint32_t particle() { return thread_index() / kLanes; }
  __device__ static std::uint32_t lane() { return threadIdx.x % kLanes; }
  /// The sum over the team, in an order that depends on nothing: the same on all of its threads, which all
  /// call.
  template <class... Floats>
  __device__ static void sum(Floats&... values) {
    const unsigned team = ((1u << kLanes) - 1u) << (threadIdx.x % 32u / kLanes * kLanes);
    for (std::uint32_t step = 1; step < kLanes; step *= 2) {
      ((values += __shfl_xor_sync(team, values, static_cast<int>(step))), ...);
    }
  }
  template <class... Floats>
  __device__ static void sum(Symmetric<float>& s, Floats&... values) {
    sum(s.xx, s.xy, s.xz, s.yy, s.yz, s.zz, values...);
  }
};
using Alone = Team<1>;

/// Up to how many particles teams of four and of two are quickest; measured on an H200
/// (tests/bench/results/2026-11-cuda-teams-h200.csv).
struct TeamSizes {
  std::uint32_t four, two;
};
/// Calls f.template operator()<Team>() with the team for `count` particles.
template <TeamSizes sizes, class F>
void with_team(std::uint32_t count, F&& f) {
  if (count <= sizes.four) return f.template operator()<Team<4>>();
  if constexpr (sizes.two > sizes.four) {
    if (count <= sizes.two) return f.template operator()<Team<2>>();
  }
  f.template operator()<Alone>();
}
/// Of the corrected model, whose pairs take more work, and of bodies' particles.
inline constexpr TeamSizes kTensorTeams{100'000, 0};
inline constexpr TeamSizes kDensityTeams{50'000, 100'000};
inline constexpr TeamSizes kForceTeams{100'000, 700'000};

/// The ticket of who has this key.
__device__ inline std::uint32_t take_ticket(const SortView& sort, std::uint32_t key, std::uint32_t retired) {
  if (key < retired) {
    // Neighbours in memory lie in one tile: one of the warp's threads counts for all of it.
    const std::uint32_t tile = key / sort.tile_cells;
    const unsigned same = __match_any_sync(__activemask(), tile);
    if (__ffs(static_cast<int>(same)) == static_cast<int>(threadIdx.x % 32u) + 1)
      atomicAdd(sort.in_tile + tile, static_cast<std::uint32_t>(__popc(same)));
  }
  return atomicAdd(sort.counts + key, 1u);
}

/// Particles [begin, end) in sorted order.
struct RowRange {
  std::uint32_t begin, end;
};
/// Those of the n-th row around `cell`.
__device__ inline RowRange row_of(const CellGrid& grid, const CellTable& cells, std::uint32_t cell,
                                  std::uint32_t n) {
  const std::uint32_t* first = cells.start + grid.row_around(cell, n);
  return {__ldg(first), __ldg(first + grid.row_cells())};
}

/// Calls f(j) for every particle in the nine rows around `cell`, in memory's order, or the thread's share of
/// them.
template <class Team = Alone, class F>
__device__ inline void for_neighbors(const CellGrid& grid, const CellTable& cells, std::uint32_t cell,
                                     F&& f) {
  for (std::uint32_t n = 0; n < 9; ++n) {
    const RowRange row = row_of(grid, cells, cell, n);
    for (std::uint32_t j = row.begin + Team::lane(); j < row.end; j += Team::kLanes) f(j);
  }
}

/// As for_neighbors() f(j) for those of whom beyond(x[j]) is negative. Four are loaded at a time, of which
/// the last may be beyond the row (kNobodies): a thread waits for memory once in four. They are marked first:
/// a warp would do for nearly each candidate what is to be done for one of its threads.
template <class Team, class Beyond, class F>
__device__ inline void for_near(const CellGrid& grid, const CellTable& cells, const float4* x,
                                std::uint32_t cell, Beyond&& beyond, F&& f) {
  constexpr std::uint32_t kAtOnce = 4, kMarked = 32;
  RowRange next = row_of(grid, cells, cell, 0);
#pragma unroll 1
  for (std::uint32_t n = 0; n < 9; ++n) {
    const RowRange row = next;
    if (n < 8) next = row_of(grid, cells, cell, n + 1);  // it comes while this one is looked at
    for (std::uint32_t base = row.begin + Team::lane(); base < row.end; base += kMarked * Team::kLanes) {
      const std::uint32_t left = min((row.end - base + Team::kLanes - 1) / Team::kLanes, kMarked);
      std::uint32_t marks = 0, marked = 0;  // the first is the highest bit
      const float4* at = x + base;
#pragma unroll 1
      for (; marked < left; marked += kAtOnce, at += kAtOnce * Team::kLanes) {
        float4 y[kAtOnce];
        for (std::uint32_t i = 0; i < kAtOnce; ++i) y[i] = __ldg(at + i * Team::kLanes);
        for (std::uint32_t i = 0; i < kAtOnce; ++i)
          marks = __funnelshift_l(__float_as_uint(beyond(y[i])), marks, 1);
      }
      marks &= ~0u << (marked - left);
      while (marks) {
        const auto bit = 31u - static_cast<std::uint32_t>(__clz(static_cast<int>(marks)));
        marks ^= 1u << bit;
        f(base + (marked - 1 - bit) * Team::kLanes);
      }
    }
  }
}

/// Calls f(j) for what the density pass found, or the thread's share of it, in the same order. Calls it for
/// others, too, who are out of reach: their kernel is 0. `at_once`: f's loads wait together; a divisor of
/// kListed.
template <class Team, std::uint32_t at_once = kListed, class F>
__device__ inline void for_listed(const CellGrid& grid, const SortedFluid& fluid, std::uint32_t cell,
                                  std::uint32_t found, F&& f) {
  if (found > fluid.near.room) return for_neighbors<Team>(grid, fluid.cells, cell, f);
  const std::uint32_t* entry = fluid.near.of(thread_index());
  std::uint32_t j[at_once], next[at_once];
  for (std::uint32_t i = 0; i < at_once; ++i) next[i] = entry[32 * i];
#pragma unroll 1
  for (std::uint32_t k = 0; k < found; k += at_once) {
    entry += 32 * at_once;
    for (std::uint32_t i = 0; i < at_once; ++i) j[i] = next[i];
    for (std::uint32_t i = 0; i < at_once; ++i) next[i] = entry[32 * i];  // they come while f() is at work
    for (std::uint32_t i = 0; i < at_once; ++i) f(j[i]);
  }
}

/// How a kernel comes to a particle's neighbours: f(j) for each, or for the thread's share of them.
template <class Team>
struct CellWalk {
  static constexpr bool kListed = false;
  const CellGrid& grid;
  const CellTable& cells;
  std::uint32_t cell;
  template <class F>
  __device__ void operator()(F&& f) const {
    for_neighbors<Team>(grid, cells, cell, f);
  }
};
template <class Team, std::uint32_t at_once = kListed>
struct ListWalk {
  static constexpr bool kListed = true;
  const CellGrid& grid;
  const SortedFluid& fluid;
  std::uint32_t cell;
  template <class F>
  __device__ void operator()(F&& f) const {
    for_listed<Team, at_once>(grid, fluid, cell, fluid.near.counts[thread_index()], f);
  }
};

/// Whether there is any particle in the nine rows around `cell`.
__device__ inline bool any_near(const CellGrid& grid, const CellTable& cells, std::uint32_t cell) {
  bool any = false;
  for (std::uint32_t n = 0; n < 9; ++n) {
    const RowRange row = row_of(grid, cells, cell, n);
    any |= row.begin != row.end;
  }
  return any;
}

}  // namespace slosh::cuda
