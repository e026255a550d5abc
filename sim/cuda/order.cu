// Putting particles where they belong: placing, gathering in the order of the cells, scattering by id.
#include "sim/cuda/rows.cuh"

namespace slosh::cuda {

namespace {

__global__ void count_keys_kernel(const std::uint32_t* keys, std::uint32_t count, std::uint32_t retired,
                                  const std::uint32_t* out_before, SortView sort) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (p >= count) return;
  const std::uint32_t key = keys[p];
  const bool stays = key >= retired && out_before && p >= *out_before;
  sort.tickets[p] = stays ? SortView::kStays : take_ticket(sort, key, retired);
}

/// What the block's threads before this one have, and all of them together.
struct BlockSum {
  std::uint32_t before, all;
};
template <int threads>
__device__ BlockSum sum_over_block(std::uint32_t own) {
  constexpr int kWarps = threads / 32;
  __shared__ std::uint32_t warps[kWarps];
  const int lane = static_cast<int>(threadIdx.x % 32), warp = static_cast<int>(threadIdx.x / 32);
  std::uint32_t up_to = own;
  for (int by = 1; by < 32; by *= 2) {
    const std::uint32_t other = __shfl_up_sync(0xffffffffu, up_to, by);
    if (lane >= by) up_to += other;
  }
  __syncthreads();  // who has still to read what the last call left
  if (lane == 31) warps[warp] = up_to;
  __syncthreads();
  BlockSum sum{up_to - own, 0};
  for (int w = 0; w < kWarps; ++w) {
    if (w < warp) sum.before += warps[w];
    sum.all += warps[w];
  }
  return sum;
}

constexpr int kTileSumThreads = 1024;
constexpr int kTileThreads = 256;

// One block: where each tile begins, and who is out.
__global__ __launch_bounds__(kTileSumThreads) void tile_kernel(SortView sort, std::uint32_t tiles,
                                                               std::uint32_t* out_start) {
  wait_for_last_kernel();
  constexpr std::uint32_t kEach = 4;
  std::uint32_t start = 0;
  for (std::uint32_t base = 0; base < tiles; base += kEach * kTileSumThreads) {
    const std::uint32_t first = base + kEach * threadIdx.x;
    std::uint32_t n[kEach], own = 0;
    for (std::uint32_t i = 0; i < kEach; ++i) n[i] = first + i < tiles ? sort.in_tile[first + i] : 0;
    for (std::uint32_t i = 0; i < kEach; ++i) own += n[i];
    const BlockSum sum = sum_over_block<kTileSumThreads>(own);
    std::uint32_t at = start + sum.before;
    for (std::uint32_t i = 0; i < kEach && first + i < tiles; ++i) {
      sort.tile_start[first + i] = at;
      at += n[i];
      if (n[i]) sort.in_tile[first + i] = 0;
    }
    start += sum.all;
  }
  if (threadIdx.x == 0) sort.tile_start[tiles] = *out_start = start;
}

// A block a tile: where each of its cells begins. Four counts are read at a time: a line is a multiple.
__global__ __launch_bounds__(kTileThreads) void cells_kernel(SortView sort, std::uint32_t cell_count,
                                                             CellTable cells) {
  wait_for_last_kernel();
  const std::uint32_t tile = blockIdx.x;
  const std::uint32_t begin = sort.tile_start[tile];
  const bool filled = sort.tile_start[tile + 1] > begin;
  if (!filled && !cells.filled[tile]) return;
  __syncthreads();
  if (threadIdx.x == 0) cells.filled[tile] = filled;
  const std::uint32_t first = tile * sort.tile_cells;
  const std::uint32_t size = min(sort.tile_cells, cell_count - first) / 4;
  const auto* counts = reinterpret_cast<const uint4*>(sort.counts + first);
  auto* starts = reinterpret_cast<uint4*>(cells.start + first);
  constexpr std::uint32_t kEach = 4;
  std::uint32_t start = begin;
  for (std::uint32_t base = 0; base < size; base += kEach * kTileThreads) {
    const std::uint32_t at = base + kEach * threadIdx.x;
    uint4 n[kEach];
    std::uint32_t own = 0;
    for (std::uint32_t i = 0; i < kEach; ++i)
      n[i] = filled && at + i < size ? counts[at + i] : make_uint4(0, 0, 0, 0);
    for (const uint4& four : n) own += four.x + four.y + four.z + four.w;
    const BlockSum sum = sum_over_block<kTileThreads>(own);
    std::uint32_t next = start + sum.before;
    for (std::uint32_t i = 0; i < kEach && at + i < size; ++i) {
      starts[at + i] =
          make_uint4(next, next + n[i].x, next + n[i].x + n[i].y, next + n[i].x + n[i].y + n[i].z);
      next += n[i].x + n[i].y + n[i].z + n[i].w;
    }
    start += sum.all;
  }
}

__global__ void note_sources_kernel(const std::uint32_t* keys, std::uint32_t count,
                                    const std::uint32_t* start, SortView sort) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (p < count && sort.tickets[p] != SortView::kStays) sort.came[start[keys[p]] + sort.tickets[p]] = p;
}

// Where `p`, whose key is `key`, goes to. The order of those that are out is nobody's concern.
__device__ std::uint32_t place_of(std::uint32_t p, std::uint32_t key, std::uint32_t retired,
                                  const std::uint32_t* start, const SortView& sort) {
  const std::uint32_t ticket = sort.tickets[p];
  if (ticket == SortView::kStays) return p;
  sort.counts[key] = 0;
  const std::uint32_t begin = start[key];
  if (key >= retired) return begin + ticket;
  const std::uint32_t end = start[key + 1];
  std::uint32_t place = begin;
  for (std::uint32_t i = begin; i < end; ++i) place += sort.came[i] < p;
  return place;
}

__global__ void gather_fluid_kernel(StepConstants c, FluidView from, SortView sort, SortedFluid to) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (p >= to.count) return;
  const std::uint32_t key = from.key[p];
  const std::uint32_t place = place_of(p, key, c.grid.retired_key(), to.cells.start, sort);
  for_each_pack(
      [&](auto pack, const auto* values, auto* gathered) {
        if constexpr (need_of(pack) != ColumnNeed::kAlways) {
          if (values) gathered[place] = values[p];
        } else if constexpr (carried(pack)) {
          gathered[place] = values[p];
        }
      },
      from, to.state);
  to.state.key[place] = key;
  if (!to.coarse) return;
  const float4 x = from.x[p];
  to.coarse[place] = c.grid.coarse_of(x.x, x.y, x.z);
}

__global__ void place_surface_kernel(StepConstants c, LocalSurface local, const DeviceBody* bodies,
                                     SortView sort) {
  wait_for_last_kernel();
  const std::uint32_t i = thread_index();
  if (i >= local.count) return;
  const SurfaceMotion& motion = bodies[local.body[i]].motion;
  const float4 at = local.position[i];
  const glm::vec3 x = motion.place({at.x, at.y, at.z});
  const glm::vec3 v = motion.velocity_at(x);
  local.placed[i] = make_float4(x.x, x.y, x.z, at.w);
  local.velocity[i] = make_float4(v.x, v.y, v.z, local.material[i].x);
  // Outside the domain there is no fluid to meet.
  const std::uint32_t retired = c.grid.retired_key();
  const std::uint32_t key = c.grid.contains(x.x, x.y, x.z) ? c.grid.cell_of(x.x, x.y, x.z) : retired;
  local.key[i] = key;
  sort.tickets[i] = take_ticket(sort, key, retired);
}

__global__ void gather_surface_kernel(StepConstants c, LocalSurface from, SortView sort, SortedSurface to) {
  wait_for_last_kernel();
  const std::uint32_t i = thread_index();
  if (i >= to.count) return;
  const std::uint32_t key = from.key[i];
  const std::uint32_t place = place_of(i, key, c.grid.retired_key(), to.cells.start, sort);
  to.x[place] = from.placed[i];
  to.v[place] = from.velocity[i];
  to.viscosity[place] = from.material[i].y;
  to.reach[place] = from.reach[i];
  to.body[place] = from.body[i];
  to.key[place] = key;
  to.order[place] = i;
}

__global__ void carry_probes_kernel(StepConstants c, const DeviceProbe* probes, const std::uint32_t* slots,
                                    std::uint32_t count, FluidView fluid) {
  wait_for_last_kernel();
  const std::uint32_t i = thread_index();
  if (i >= count) return;
  const DeviceProbe probe = probes[i];
  const std::uint32_t slot = slots[i];
  fluid.x[slot] = probe.x;
  fluid.v[slot] = make_float4(probe.v.x, probe.v.y, probe.v.z, fluid.v[slot].w);  // the volume stays its own
  // A probe that a hand takes out of the domain comes back with it: it waits in the nearest cell.
  fluid.key[slot] = c.grid.cell_of(probe.x.x, probe.x.y, probe.x.z);
}

__global__ void damp_kernel(float4* velocities, std::uint32_t count, float keep) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (p >= count) return;
  const float4 v = velocities[p];
  velocities[p] = make_float4(v.x * keep, v.y * keep, v.z * keep, v.w);
}

__global__ void scatter_kernel(StepConstants c, FluidView fluid, std::uint32_t count, std::uint32_t visible,
                               float* positions, std::uint8_t* kinds) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (p >= count) return;
  const std::uint32_t id = fluid.id[p];
  if (id >= visible) return;
  const bool retired = fluid.key[p] >= c.grid.retired_key();
  kinds[id] = retired ? 255 : fluid.kind[p];
  if (retired) return;
  const float4 x = fluid.x[p];
  positions[3 * id] = x.x;
  positions[3 * id + 1] = x.y;
  positions[3 * id + 2] = x.z;
}

}  // namespace

void launch_count_keys(const std::uint32_t* keys, std::uint32_t count, std::uint32_t retired,
                       const std::uint32_t* out_before, const SortView& sort, cudaStream_t stream) {
  launch_early(count_keys_kernel, blocks_for(count), kThreads, stream, keys, count, retired, out_before,
               sort);
}

void launch_find_cells(const std::uint32_t* keys, std::uint32_t count, std::uint32_t retired,
                       const CellTiles& tiles, const SortView& sort, const CellTable& cells,
                       cudaStream_t stream) {
  launch_early(tile_kernel, 1, kTileSumThreads, stream, sort, tiles.count, cells.start + retired);
  launch_early(cells_kernel, tiles.count, kTileThreads, stream, sort, retired, cells);
  launch_early(note_sources_kernel, blocks_for(count), kThreads, stream, keys, count, cells.start, sort);
}

void launch_gather_fluid(const StepConstants& constants, const FluidView& from, const SortView& sort,
                         const SortedFluid& to, cudaStream_t stream) {
  launch_early(gather_fluid_kernel, blocks_for(to.count), kThreads, stream, constants, from, sort, to);
}

void launch_place_surface(const StepConstants& constants, const LocalSurface& local, const DeviceBody* bodies,
                          const SortView& sort, cudaStream_t stream) {
  launch_early(place_surface_kernel, blocks_for(local.count), kThreads, stream, constants, local, bodies,
               sort);
}

void launch_gather_surface(const StepConstants& constants, const LocalSurface& from, const SortView& sort,
                           const SortedSurface& to, cudaStream_t stream) {
  launch_early(gather_surface_kernel, blocks_for(to.count), kThreads, stream, constants, from, sort, to);
}

void launch_carry_probes(const StepConstants& constants, const DeviceProbe* probes,
                         const std::uint32_t* slots, std::uint32_t count, const FluidView& fluid,
                         cudaStream_t stream) {
  launch_early(carry_probes_kernel, blocks_for(count), kThreads, stream, constants, probes, slots, count,
               fluid);
}

void launch_damp(float4* velocities, std::uint32_t count, float keep, cudaStream_t stream) {
  launch_early(damp_kernel, blocks_for(count), kThreads, stream, velocities, count, keep);
}

void launch_scatter(const StepConstants& constants, const FluidView& fluid, std::uint32_t count,
                    std::uint32_t visible, float* positions, std::uint8_t* kinds, cudaStream_t stream) {
  launch_early(scatter_kernel, blocks_for(count), kThreads, stream, constants, fluid, count, visible,
               positions, kinds);
}

}  // namespace slosh::cuda
