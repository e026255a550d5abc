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

/// Calls f.template operator()<Team>() with the team for `count` particles.
template <TeamSizes sizes, class F>
void with_team(std::uint32_t count, F&& f) {
  const std::uint32_t lanes = sizes.lanes(count);
  if (lanes == 4) return f.template operator()<Team<4>>();
  if constexpr (sizes.two > sizes.four) {
    if (lanes == 2) return f.template operator()<Team<2>>();
  }
  f.template operator()<Alone>();
}

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

/// Pa·s of a fluid particle itself, whoever it meets.
__device__ inline float particle_viscosity(const SortedFluid& fluid, const ParticleKind* kinds,
                                           std::uint32_t p) {
  return fluid.state.heat ? fluid.state.heat[p].w : kinds[fluid.state.kind[p]].viscosity;
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

/// Of a row's particles that may be in reach, the first in the highest bit.
struct MarkedRow {
  std::uint32_t marks, first;
};
/// As many rows as a thread marks before it looks at them.
inline constexpr std::uint32_t kMarkedRows = 9;

/// Of the next kListed of a thread's share of a row, in the lowest bits of what `marks` becomes, who may be
/// in reach of particle p. Who is alone asks CellGrid::coarse_of(), in one load; a team, which waits for
/// latency rather than for loads to be carried out, the particles themselves: a list is a twelfth shorter
/// then.
template <class Team>
class Near {
 public:
  /// Where the share begins.
  __device__ static std::uint32_t first(const RowRange& row) {
    return kAlone ? row.begin / kListed * kListed : row.begin + Team::lane();
  }
  __device__ Near(const StepConstants& c, const SortedFluid& fluid, std::uint32_t p, const float4& x)
      : fluid_(fluid), x_(x), h_(c.support_radius), limit_(-c.coarse_reach_squared) {
    if constexpr (kAlone) own_ = from_ = __ldg(fluid.coarse + p) | kSigns;
  }
  /// What comes next is in the n-th row.
  __device__ void go_to(std::uint32_t n) {
    // The rows' cells lie one below, beside and one above, 64 units each.
    if constexpr (kAlone) from_ = own_ + 64u * (1u - n % 3u) + 64u * 256u * (1u - n / 3u);
  }
  __device__ std::uint32_t mark(std::uint32_t base, std::uint32_t marks) const {
    if constexpr (kAlone) {
      const uint4 y = __ldg(reinterpret_cast<const uint4*>(fluid_.coarse + base));
      for (const std::uint32_t other : {y.x, y.y, y.z, y.w}) {
        const auto apart = static_cast<int>((from_ - other) ^ kSigns);
        marks = __funnelshift_l(static_cast<unsigned>(__dp4a(apart, apart, limit_)), marks, 1);
      }
    } else {
      float4 y[kListed];
      for (std::uint32_t i = 0; i < kListed; ++i) y[i] = __ldg(fluid_.state.x + base + i * Team::kLanes);
      for (const float4& other : y) {
        const float dx = x_.x - other.x, dy = x_.y - other.y, dz = x_.z - other.z;
        marks = __funnelshift_l(__float_as_uint(dx * dx + (dy * dy + (dz * dz - h_ * h_))), marks, 1);
      }
    }
    return marks;
  }

 private:
  static constexpr bool kAlone = Team::kLanes == 1;
  static constexpr std::uint32_t kSigns = 0x8080u;  // what keeps y and z from borrowing

  const SortedFluid& fluid_;
  float4 x_;
  float h_;
  std::int32_t limit_;
  std::uint32_t own_ = 0, from_ = 0;
};

/// Calls f(j), j of kListed particles, for the particles around sorted particle p, at x, that may be in
/// reach, or the thread's share of them as for_neighbors() has it; kNobodies fill up. They are marked first:
/// a warp would do for nearly each candidate what is to be done for one of its threads. `rows`: kMarkedRows
/// of the block's threads each, shared.
template <class Team, class F>
__device__ inline void for_near(const StepConstants& c, const SortedFluid& fluid, std::uint32_t p,
                                const float4& x, std::uint32_t cell, MarkedRow (*rows)[kThreads], F&& f) {
  constexpr std::uint32_t kBits = 32;
  Near<Team> near(c, fluid, p, x);
  std::uint32_t n = 0;
  RowRange row = row_of(c.grid, fluid.cells, cell, 0);
  std::uint32_t base = near.first(row);
  while (n < 9) {
    std::uint32_t marked = 0;
    while (n < 9 && marked < kMarkedRows) {
      const RowRange next = row_of(c.grid, fluid.cells, cell, n < 8 ? n + 1 : 8);
      near.go_to(n);
      std::uint32_t marks = 0, bits = 0;
      const std::uint32_t first = base;
#pragma unroll 1
      for (; base < row.end && bits < kBits; bits += kListed, base += kListed * Team::kLanes)
        marks = near.mark(base, marks);
      if (bits > 0) {
        marks <<= kBits - bits;
        const std::uint32_t there = (row.end - first + Team::kLanes - 1) / Team::kLanes;
        if (there < bits) marks &= ~0u << (kBits - there);
        if (first < row.begin) marks &= ~0u >> (row.begin - first);
        if (marks) rows[marked++][threadIdx.x] = {marks, first};
      }
      if (base < row.end) continue;
      ++n;
      row = next;
      base = near.first(row);
    }
    std::uint32_t marks = 0, first = 0, looked = 0;
    while (marks || looked < marked) {
      std::uint32_t j[kListed];
      for (std::uint32_t& one : j) {
        if (!marks && looked < marked) {
          const MarkedRow& of = rows[looked++][threadIdx.x];
          marks = of.marks;
          first = of.first;
        }
        const auto bit = static_cast<std::uint32_t>(__clz(static_cast<int>(marks)));
        one = marks ? first + bit * Team::kLanes : fluid.count;
        marks &= ~(0x80000000u >> bit % kBits);
      }
      f(j);
    }
  }
}

/// Calls f(j) for what the density pass found, or the thread's share of it, in the same order. Calls it for
/// others, too, who are out of reach: their kernel is 0. `at_once`: f's loads wait together, 2 or kListed.
template <class Team, std::uint32_t at_once = kListed, class F>
__device__ inline void for_listed(const CellGrid& grid, const SortedFluid& fluid, std::uint32_t cell,
                                  std::uint32_t found, F&& f) {
  if (found > fluid.near.room) return for_neighbors<Team>(grid, fluid.cells, cell, f);
  const uint4* entry = fluid.near.of(thread_index());
  uint4 next = *entry;
#pragma unroll 1
  for (std::uint32_t k = 0; k < found; k += kListed) {
    uint4 j = next;
    entry += 32;
    next = *entry;  // it comes while f() is at work
    if constexpr (at_once == kListed) {
      for (const std::uint32_t one : {j.x, j.y, j.z, j.w}) f(one);
    } else {
#pragma unroll 1
      for (std::uint32_t i = 0; i < kListed; i += 2) {
        for (const std::uint32_t one : {j.x, j.y}) f(one);
        j = make_uint4(j.z, j.w, 0, 0);
      }
    }
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
