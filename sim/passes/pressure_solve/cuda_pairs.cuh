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
__device__ inline void add(const float3& v, float by, float3& sum) {
  sum.x += by * v.x;
  sum.y += by * v.y;
  sum.z += by * v.z;
}

__device__ inline void add_force(const SortedFluid& fluid, std::uint32_t p, const float3& more) {
  const float4 f = fluid.force[p];
  fluid.force[p] = make_float4(f.x + more.x, f.y + more.y, f.z + more.z, f.w);
}

/// K of a fluid particle with the kernel's constant, in units that make a pair's push a whole number of 16
/// bits.
struct PushTensor {
  Symmetric<float> k;
  float unit;  ///< m², a power of two, or 0 where K is
};

/// 1/unit, exactly; finite where the unit is 0.
__device__ inline float inverse_of(float unit) {
  return __uint_as_float(0x7f000000u - __float_as_uint(unit));
}

__device__ inline PushTensor push_tensor(const StepConstants& c, const SortedFluid& fluid, std::uint32_t p) {
  const float4 a = __ldg(fluid.push_a + p);
  const float4 b = __ldg(fluid.push_b + p);
  const float row = fmaxf(fmaxf(fabsf(a.x) + fabsf(a.y) + fabsf(a.z), fabsf(a.y) + fabsf(a.w) + fabsf(b.x)),
                          fabsf(a.z) + fabsf(b.x) + fabsf(b.y));
  // No component of a pair's w is above h²: |W'| without its constant is (h − r)².
  const float largest = row * (c.force_scale * c.support_radius * c.support_radius / 32767.0f);
  const float unit = __uint_as_float((__float_as_uint(largest) + 0x7fffffu) & 0x7f800000u);  // rounded up
  const float s = row > 0.0f ? c.force_scale * inverse_of(unit) : 0.0f;
  return {{s * a.x, s * a.y, s * a.z, s * a.w, s * b.x, s * b.y}, unit};
}

// Its last place is 1, and what is added to it within ±2¹⁵ lies in its last 16 bits.
inline constexpr float kMiddle = 8421376.0f;  // 2²³ + 2¹⁵

/// What 1 Pa of K's particle pushes by, in its units, as rows have it. Written with fmaf(), so that w and −w
/// give opposite numbers wherever this is compiled in: pairs keep their momentum exactly.
__device__ inline float3 push_of(const Symmetric<float>& k, const float3& w) {
  const auto whole = [&](float x, float y, float z) {
    return fmaf(z, w.z, fmaf(y, w.y, x * w.x)) + kMiddle - kMiddle;
  };
  return make_float3(whole(k.xx, k.xy, k.xz), whole(k.xy, k.yy, k.yz), whole(k.xz, k.yz, k.zz));
}

/// An entry of PressRows: push_of(), and by how much the other's place is above the entry's before.
__device__ inline uint2 entry_of(const float3& push, std::uint32_t on) {
  const auto bits = [](float x) { return __float_as_uint(x + kMiddle) & 0xffffu; };
  return make_uint2(bits(push.x) | bits(push.y) << 16, bits(push.z) | on << 16);
}
__device__ inline float3 push_in(std::uint32_t xy, std::uint32_t z) {
  const auto number = [](std::uint32_t bits) { return __uint_as_float(0x4b000000u | bits) - kMiddle; };
  return make_float3(number(xy & 0xffffu), number(xy >> 16), number(z & 0xffffu));
}

__device__ inline float3 pushed_by(const Symmetric<float>& k, const float3& w) {
  return make_float3(k.xx * w.x + k.xy * w.y + k.xz * w.z, k.xy * w.x + k.yy * w.y + k.yz * w.z,
                     k.xz * w.x + k.yz * w.y + k.zz * w.z);
}

/// How a fluid particle and another press on each other.
struct PressPair {
  float3 by_own;    ///< what 1 Pa of its own pushes it by, in its units; 0 where they do not meet
  float3 by_other;  ///< what 1 Pa of the other does, in the other's
  float unit;       ///< the other's, m²
  bool meets;       ///< within reach, and not the same
};
/// `x`, `own`: of the one. Without branches, so that what several pairs load comes together.
__device__ inline PressPair press_pair(const StepConstants& c, const SortedFluid& fluid, const float4& x,
                                       const PushTensor& own, std::uint32_t j) {
  const float4 y = __ldg(fluid.pressed + j);
  const float dx = x.x - y.x, dy = x.y - y.y, dz = x.z - y.z;
  const float r_squared = fmaf(dz, dz, fmaf(dy, dy, dx * dx));
  const float by = PressedParts::ForceKernel::pair(r_squared, c.support_radius, 1.0f).slope_over_r;
  const float3 w = make_float3(by * dx, by * dy, by * dz);
  const PushTensor other = push_tensor(c, fluid, j);
  return {push_of(own.k, w), push_of(other.k, w), other.unit, r_squared * by > 0.0f};
}

/// Calls f(j, pair) for the thread's share of fluid particle p's pairs with fluid, of the cells around: for
/// who has more than its row has room for.
template <class Team, class F>
__device__ inline void for_each_walked(const StepConstants& c, const SortedFluid& fluid, std::uint32_t p,
                                       F&& f) {
  const PushTensor own = push_tensor(c, fluid, p);
  const float4 x = fluid.pressed[p];
  for_neighbors<Team>(c.grid, fluid.cells, fluid.state.key[p],
                      [&](std::uint32_t j) { f(j, press_pair(c, fluid, x, own, j)); });
}

/// Calls f(j, w), w = (−W'/r) (x − x_j) without the kernel's constant, for the thread's share of those of
/// `others` within reach of x: `reach`, m, or what each wall's particle has, for whom w is times its share.
template <class Team, Neighbours neighbours, class F>
__device__ inline void for_each_pressed(const StepConstants& c, const float4& x, const float4* others,
                                        const CellTable& cells, std::uint32_t cell, float reach,
                                        const float* reaches, F&& f) {
  for_neighbors<Team>(c.grid, cells, cell, [&](std::uint32_t j) {
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
/// Of fluid particle p with the particles of `walls`.
template <class Team, class F>
__device__ inline void for_each_wall(const StepConstants& c, const SortedFluid& fluid,
                                     const SortedSurface& walls, std::uint32_t p, F&& f) {
  for_each_pressed<Team, Neighbours::kWalls>(c, fluid.pressed[p], walls.x, walls.cells, fluid.state.key[p],
                                             c.support_radius, walls.reach, f);
}

/// Calls f(i, on_fluid) for the thread's share of fluid particle p's pairs with particles of bodies that may
/// move: what 1 Pa of p pushes it by there, m².
template <class Team, class F>
__device__ inline void for_each_walked_touch(const StepConstants& c, const SortedFluid& fluid,
                                             const SortedSurface& moving, std::uint32_t p, F&& f) {
  const PushTensor own = push_tensor(c, fluid, p);
  for_each_wall<Team>(c, fluid, moving, p, [&](std::uint32_t i, const float3& w) {
    const float3 push = pushed_by(own.k, w);
    f(i, make_float3(own.unit * push.x, own.unit * push.y, own.unit * push.z));
  });
}

/// Calls f(j, on_body) for the fluid around a body's particle i: what 1 Pa of j pushes it by, in j's units.
template <class F>
__device__ inline void for_each_walked_press(const StepConstants& c, const SortedFluid& fluid,
                                             const SortedSurface& moving, std::uint32_t i, F&& f) {
  const float4 x = moving.x[i];
  const std::uint32_t cell = moving.key[i];
  if (x.w == 0.0f || cell >= c.grid.retired_key()) return;
  for_each_pressed<Alone, Neighbours::kFluid>(
      c, x, fluid.pressed, fluid.cells, cell, moving.reach[i], nullptr,
      [&](std::uint32_t j, const float3& w) {
        f(j, pushed_by(push_tensor(c, fluid, j).k, make_float3(x.w * w.x, x.w * w.y, x.w * w.z)));
      });
}

}  // namespace slosh::cuda
