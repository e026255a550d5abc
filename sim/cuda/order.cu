// Putting particles where they belong: placing, gathering in the order of the cells, scattering by id.
#include "sim/cuda/rows.cuh"

namespace slosh::cuda {

namespace {

__global__ void identity_kernel(std::uint32_t* values, std::uint32_t count) {
  const std::uint32_t i = thread_index();
  if (i < count) values[i] = i;
}

// Writes where the cell of the p-th sorted key begins or ends, if it does so at p.
__device__ void mark_cell(const std::uint32_t* keys, std::uint32_t p, std::uint32_t count,
                          std::uint32_t retired, const CellTable& cells) {
  const std::uint32_t key = keys[p];
  if (key >= retired) return;
  if (p == 0 || keys[p - 1] != key) cells.begin[key] = p;
  if (p + 1 == count || keys[p + 1] != key) cells.end[key] = p + 1;
}

__global__ void gather_fluid_kernel(StepConstants c, FluidView from, const std::uint32_t* order,
                                    SortedFluid to) {
  const std::uint32_t p = thread_index();
  if (p >= to.count) return;
  const std::uint32_t source = order[p];
  for_each_pack(
      [&](auto pack, const auto* values, auto* gathered) {
        if constexpr (pack == Pack::kSolved) {
          if (values) gathered[p] = values[source];
        } else if constexpr (carried(pack)) {
          gathered[p] = values[source];
        }
      },
      from, to.state);
  mark_cell(to.state.key, p, to.count, c.grid.retired_key(), to.cells);
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

__global__ void gather_surface_kernel(StepConstants c, LocalSurface from, SortedSurface to) {
  const std::uint32_t i = thread_index();
  if (i >= to.count) return;
  const std::uint32_t source = to.order[i];
  to.x[i] = from.placed[source];
  to.v[i] = from.velocity[source];
  to.viscosity[i] = from.material[source].y;
  to.reach[i] = from.reach[source];
  to.body[i] = from.body[source];
  mark_cell(to.key, i, to.count, c.grid.retired_key(), to.cells);
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

void launch_identity(std::uint32_t* values, std::uint32_t count, cudaStream_t stream) {
  if (count) identity_kernel<<<blocks_for(count), kThreads, 0, stream>>>(values, count);
}

void launch_gather_fluid(const StepConstants& constants, const FluidView& from, const std::uint32_t* order,
                         const SortedFluid& to, cudaStream_t stream) {
  gather_fluid_kernel<<<blocks_for(to.count), kThreads, 0, stream>>>(constants, from, order, to);
}

void launch_place_surface(const StepConstants& constants, const LocalSurface& local, const DeviceBody* bodies,
                          cudaStream_t stream) {
  place_surface_kernel<<<blocks_for(local.count), kThreads, 0, stream>>>(constants, local, bodies);
}

void launch_gather_surface(const StepConstants& constants, const LocalSurface& from, const SortedSurface& to,
                           cudaStream_t stream) {
  gather_surface_kernel<<<blocks_for(to.count), kThreads, 0, stream>>>(constants, from, to);
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
