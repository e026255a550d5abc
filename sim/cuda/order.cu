// Putting particles where they belong: placing, gathering in the order of the cells, scattering by id.
#include "sim/cuda/rows.cuh"

namespace slosh::cuda {

namespace {

__global__ void count_keys_kernel(const std::uint32_t* keys, std::uint32_t count, std::uint32_t retired,
                                  const std::uint32_t* out_before, SortView sort) {
  const std::uint32_t p = thread_index();
  if (p >= count) return;
  const std::uint32_t key = keys[p];
  const bool stays = key >= retired && out_before && p >= *out_before;
  sort.tickets[p] = stays ? SortView::kStays : atomicAdd(sort.counts + key, 1u);
}

__global__ void note_sources_kernel(const std::uint32_t* keys, std::uint32_t count,
                                    const std::uint32_t* start, SortView sort) {
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
  const std::uint32_t p = thread_index();
  if (p >= to.count) return;
  const std::uint32_t key = from.key[p];
  const std::uint32_t place = place_of(p, key, c.grid.retired_key(), to.cells.start, sort);
  for_each_pack(
      [&](auto pack, const auto* values, auto* gathered) {
        if constexpr (pack == Pack::kSolved) {
          if (values) gathered[place] = values[p];
        } else if constexpr (carried(pack)) {
          gathered[place] = values[p];
        }
      },
      from, to.state);
  to.state.key[place] = key;
}

__global__ void place_surface_kernel(StepConstants c, LocalSurface local, const DeviceBody* bodies) {
  const std::uint32_t i = thread_index();
  if (i >= local.count) return;
  const SurfaceMotion& motion = bodies[local.body[i]].motion;
  const float4 at = local.position[i];
  const glm::vec3 x = motion.place({at.x, at.y, at.z});
  const glm::vec3 v = motion.velocity_at(x);
  local.placed[i] = make_float4(x.x, x.y, x.z, at.w);
  local.velocity[i] = make_float4(v.x, v.y, v.z, local.material[i].x);
  // Outside the domain there is no fluid to meet.
  local.key[i] = c.grid.contains(x.x, x.y, x.z) ? c.grid.cell_of(x.x, x.y, x.z) : c.grid.retired_key();
}

__global__ void gather_surface_kernel(StepConstants c, LocalSurface from, SortView sort, SortedSurface to) {
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
  const std::uint32_t p = thread_index();
  if (p >= count) return;
  const float4 v = velocities[p];
  velocities[p] = make_float4(v.x * keep, v.y * keep, v.z * keep, v.w);
}

__global__ void scatter_kernel(StepConstants c, FluidView fluid, std::uint32_t count, std::uint32_t visible,
                               float* positions, std::uint8_t* kinds) {
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
  count_keys_kernel<<<blocks_for(count), kThreads, 0, stream>>>(keys, count, retired, out_before, sort);
}

void launch_note_sources(const std::uint32_t* keys, std::uint32_t count, const std::uint32_t* start,
                         const SortView& sort, cudaStream_t stream) {
  note_sources_kernel<<<blocks_for(count), kThreads, 0, stream>>>(keys, count, start, sort);
}

void launch_gather_fluid(const StepConstants& constants, const FluidView& from, const SortView& sort,
                         const SortedFluid& to, cudaStream_t stream) {
  gather_fluid_kernel<<<blocks_for(to.count), kThreads, 0, stream>>>(constants, from, sort, to);
}

void launch_place_surface(const StepConstants& constants, const LocalSurface& local, const DeviceBody* bodies,
                          cudaStream_t stream) {
  place_surface_kernel<<<blocks_for(local.count), kThreads, 0, stream>>>(constants, local, bodies);
}

void launch_gather_surface(const StepConstants& constants, const LocalSurface& from, const SortView& sort,
                           const SortedSurface& to, cudaStream_t stream) {
  gather_surface_kernel<<<blocks_for(to.count), kThreads, 0, stream>>>(constants, from, sort, to);
}

void launch_carry_probes(const StepConstants& constants, const DeviceProbe* probes,
                         const std::uint32_t* slots, std::uint32_t count, const FluidView& fluid,
                         cudaStream_t stream) {
  carry_probes_kernel<<<blocks_for(count), kThreads, 0, stream>>>(constants, probes, slots, count, fluid);
}

void launch_damp(float4* velocities, std::uint32_t count, float keep, cudaStream_t stream) {
  damp_kernel<<<blocks_for(count), kThreads, 0, stream>>>(velocities, count, keep);
}

void launch_scatter(const StepConstants& constants, const FluidView& fluid, std::uint32_t count,
                    std::uint32_t visible, float* positions, std::uint8_t* kinds, cudaStream_t stream) {
  scatter_kernel<<<blocks_for(count), kThreads, 0, stream>>>(constants, fluid, count, visible, positions,
                                                             kinds);
}

}  // namespace slosh::cuda
