// Writes the pressure pairs down.
#include "sim/passes/pressure_solve/cuda_pairs.cuh"

namespace slosh::cuda {

namespace {

__global__ __launch_bounds__(kThreads) void press_rows_kernel(StepConstants c, const ParticleKind* kinds,
                                                              SortedFluid fluid, SortedSurface fixed,
                                                              SortedSurface moving, PressureView view) {
  const std::uint32_t e = thread_index();
  if (e >= view.fluid + view.surface) return;
  std::uint32_t count = 0, with_fluid = 0;
  float4 own = make_float4(0.0f, 0.0f, 0.0f, 0.0f);
  for_each_press(c, fluid, moving, e, [&](std::uint32_t other, const float3& by_own, const float3& by_other) {
    if (count < view.rows.room) {
      const std::size_t at = view.rows.at(e, count);
      view.rows.pairs[at] = make_float4(by_own.x, by_own.y, by_own.z, __uint_as_float(other));
      if (e < view.fluid && other < view.fluid)
        view.by_other[at] = make_float4(by_other.x, by_other.y, by_other.z, __uint_as_float(other));
    }
    ++count;
    own.x += by_own.x;
    own.y += by_own.y;
    own.z += by_own.z;
    if (other >= view.fluid) return;
    ++with_fluid;
    const ParticleKind& kind = kinds[fluid.state.kind[other]];
    if (!kind.probe) own.w += dot(by_own, by_own) / kind.mass;
  });
  view.rows.counts[e] = count;
  view.with_fluid[e] = with_fluid;
  if (e >= view.fluid) return;
  const std::uint32_t cell = fluid.state.key[e];
  if (fixed.count && cell < c.grid.retired_key()) {
    float3 walls = make_float3(0.0f, 0.0f, 0.0f);
    for_each_pressed<Neighbours::kWalls>(c, fluid.pressed[e], fixed.x, fixed.cells, cell, c.support_radius,
                                         fixed.reach, [&](std::uint32_t, const float3& w) {
                                           walls.x += w.x;
                                           walls.y += w.y;
                                           walls.z += w.z;
                                         });
    const float3 by_walls = pushed_by(push_tensor(c, fluid, e), walls);
    own.x += by_walls.x;
    own.y += by_walls.y;
    own.z += by_walls.z;
  }
  view.own[e] = own;
}

}  // namespace

void launch_pressure_rows(const StepConstants& constants, const ParticleKind* kinds, const SortedFluid& fluid,
                          const SortedSurface& fixed, const SortedSurface& moving, const PressureView& view,
                          cudaStream_t stream) {
  press_rows_kernel<<<blocks_for(view.fluid + view.surface), kThreads, 0, stream>>>(constants, kinds, fluid,
                                                                                    fixed, moving, view);
}

}  // namespace slosh::cuda
