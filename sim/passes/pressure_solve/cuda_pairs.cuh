// Which pairs press, and how strongly: the same for writing rows down and for walking the neighbours anew.
#pragma once

#include "sim/cuda/pair_rows.cuh"
#include "sim/passes/pressure_solve/cuda_kernels.h"

namespace slosh::cuda {

using PressedParts = ModelParts<ParticleModel::kIncompressible>;

__device__ inline float3 vec3(const float4& v) {
  return make_float3(v.x, v.y, v.z);
}
__device__ inline float dot(const float3& a, const float3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// K of a fluid particle with the kernel's constant, m².
__device__ inline Symmetric<float> push_tensor(const StepConstants& c, const SortedFluid& fluid,
                                               std::uint32_t p) {
  const float4 a = __ldg(fluid.push_a + p);
  const float4 b = __ldg(fluid.push_b + p);
  const float s = c.force_scale;
  return {s * a.x, s * a.y, s * a.z, s * a.w, s * b.x, s * b.y};
}

__device__ inline float3 pushed_by(const Symmetric<float>& k, const float3& w) {
  return make_float3(k.xx * w.x + k.xy * w.y + k.xz * w.z, k.xy * w.x + k.yy * w.y + k.yz * w.z,
                     k.xz * w.x + k.yz * w.y + k.zz * w.z);
}

/// Calls f(j, w), w = (−W'/r) (x − x_j) without the kernel's constant, for those of `others` within reach of
/// x: `reach`, m, or what each wall's particle has, for whom w is times its share.
template <Neighbours neighbours, class F>
__device__ inline void for_each_pressed(const StepConstants& c, const float4& x, const float4* others,
                                        const CellTable& cells, std::uint32_t cell, float reach,
                                        const float* reaches, F&& f) {
  for_neighbors(c.grid, cells, cell, [&](std::uint32_t j) {
    const float4 y = __ldg(others + j);
    const float dx = x.x - y.x, dy = x.y - y.y, dz = x.z - y.z;
    const float r_squared = dx * dx + dy * dy + dz * dz;
    const float h = neighbours == Neighbours::kWalls ? __ldg(reaches + j) : reach;
    if (r_squared >= h * h) return;
    float by = PressedParts::ForceKernel::pair(r_squared, h, 1.0f).slope_over_r;
    if (!(r_squared * by > 0.0f)) return;
    if constexpr (neighbours == Neighbours::kWalls) {
      if (y.w == 0.0f) return;
      by *= y.w;
    }
    f(j, make_float3(by * dx, by * dy, by * dz));
  });
}

/// Calls f(entry, own, other) for the pairs of entry `e`: first those with fluid, then, of fluid, those with
/// particles of bodies that may move, which have no `other` (PressureView::rows).
template <class F>
__device__ inline void for_each_press(const StepConstants& c, const SortedFluid& fluid,
                                      const SortedSurface& moving, std::uint32_t e, F&& f) {
  if (e < fluid.count) {
    const std::uint32_t cell = fluid.state.key[e];
    if (cell >= c.grid.retired_key()) return;
    const Symmetric<float> own = push_tensor(c, fluid, e);
    const float4 x = fluid.pressed[e];
    for_each_pressed<Neighbours::kFluid>(c, x, fluid.pressed, fluid.cells, cell, c.support_radius, nullptr,
                                         [&](std::uint32_t j, const float3& w) {
                                           f(j, pushed_by(own, w), pushed_by(push_tensor(c, fluid, j), w));
                                         });
    if (moving.count == 0) return;
    for_each_pressed<Neighbours::kWalls>(c, x, moving.x, moving.cells, cell, c.support_radius, moving.reach,
                                         [&](std::uint32_t j, const float3& w) {
                                           f(fluid.count + j, pushed_by(own, w),
                                             make_float3(0.0f, 0.0f, 0.0f));
                                         });
    return;
  }
  const std::uint32_t i = e - fluid.count;
  const std::uint32_t cell = moving.key[i];
  if (cell >= c.grid.retired_key()) return;
  const float4 x = moving.x[i];
  if (x.w == 0.0f) return;
  for_each_pressed<Neighbours::kFluid>(c, x, fluid.pressed, fluid.cells, cell, moving.reach[i], nullptr,
                                       [&](std::uint32_t j, const float3& w) {
                                         const float3 share = make_float3(x.w * w.x, x.w * w.y, x.w * w.z);
                                         f(j, pushed_by(push_tensor(c, fluid, j), share),
                                           make_float3(0.0f, 0.0f, 0.0f));
                                       });
}

}  // namespace slosh::cuda
