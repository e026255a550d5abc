// Conduction and setting on the GPU: sim/passes/heat/cpu.cpp.
#include "sim/cuda/rows.cuh"

namespace slosh::cuda {
namespace {

__device__ inline float reach_of(const float4& a, const float4& b, float h) {
  const float dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
  return kernel_reach(sqrtf(dx * dx + dy * dy + dz * dz), h);
}

__device__ inline float by_walls(const StepConstants& c, const HeatView& heat, const SortedSurface& walls,
                                 const float4& x, float temperature, std::uint32_t cell) {
  float sum = 0.0f;
  if (walls.count == 0) return sum;
  for_neighbors(c.grid, walls.cells, cell, [&](std::uint32_t j) {
    const float warm = __ldg(heat.bodies + walls.body[j]);
    if (warm != warm) return;  // the body has none
    const float4 y = __ldg(walls.x + j);
    const float share = heat.by_volume ? walls.v[j].w : y.w;
    sum += share * reach_of(x, y, __ldg(walls.reach + j)) * (warm - temperature);
  });
  return sum;
}

__global__ __launch_bounds__(kThreads) void conduct_kernel(StepConstants c, HeatView heat, SortedFluid fluid,
                                                           SortedSurface fixed, SortedSurface moving) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (p >= fluid.count) return;
  const std::uint32_t cell = fluid.state.key[p];
  if (cell >= c.grid.retired_key()) return;
  const float4 x = fluid.state.x[p];
  const float temperature = fluid.state.heat[p].x;
  const float own = heat.kinds[fluid.state.kind[p]].conductivity;
  float sum = 0.0f;
  for_neighbors(c.grid, fluid.cells, cell, [&](std::uint32_t j) {
    const float reach = reach_of(x, __ldg(fluid.state.x + j), c.support_radius);
    if (!(reach > 0.0f)) return;
    const float other = heat.kinds[fluid.state.kind[j]].conductivity;
    sum += between(own, other) * reach * (__ldg(fluid.state.heat + j).x - temperature);
  });
  const float walls =
      by_walls(c, heat, fixed, x, temperature, cell) + by_walls(c, heat, moving, x, temperature, cell);
  const float by_bodies = own * heat.wall_scale * walls;
  fluid.heating[p] = make_float2(heat.pair_scale * sum + by_bodies, by_bodies);
}

__global__ void warm_kernel(StepConstants c, const ParticleKind* kinds, HeatView heat, float dt,
                            SortedFluid fluid) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (p >= fluid.count || fluid.state.key[p] >= c.grid.retired_key()) return;
  const std::uint8_t index = fluid.state.kind[p];
  const HeatKind& kind = heat.kinds[index];
  float4 own = fluid.state.heat[p];
  if (dt > 0.0f) {
    const float2 heating = fluid.heating[p];
    own.x += heating.x * dt / kind.capacity;
    own.z += heating.y * dt;
    own.y = cure_after(kind, own.x, own.y, dt);
  }
  own.w = thickness_of(kind, kinds[index].viscosity, own.x, own.y);
  fluid.state.heat[p] = own;
}

}  // namespace

void launch_heat(const StepConstants& constants, const ParticleKind* kinds, const HeatView& heat, float dt,
                 const SortedFluid& fluid, const SortedSurface& fixed, const SortedSurface& moving,
                 cudaStream_t stream) {
  if (dt > 0.0f)
    launch_early(conduct_kernel, blocks_for(fluid.count), kThreads, stream, constants, heat, fluid, fixed,
                 moving);
  launch_early(warm_kernel, blocks_for(fluid.count), kThreads, stream, constants, kinds, heat, dt, fluid);
}

}  // namespace slosh::cuda
