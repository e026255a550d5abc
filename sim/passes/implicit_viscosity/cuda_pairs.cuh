// Viscous pairs, and how strong each is: the same for writing rows down and for walking the neighbours anew.
#pragma once

#include "sim/cuda/pair_rows.cuh"
#include "sim/passes/implicit_viscosity/cuda_kernels.h"

namespace slosh::cuda {

/// Implicit viscosity is for this model alone (Plan::implicit_viscosity).
using SolvedParts = ModelParts<ParticleModel::kCorrected>;
static_assert(SolvedParts::kDrag == DragRule::kCentral);

__device__ inline void add_outer(const float3& w, Symmetric<float>& sum) {
  sum.xx += w.x * w.x;
  sum.xy += w.x * w.y;
  sum.xz += w.x * w.z;
  sum.yy += w.y * w.y;
  sum.yz += w.y * w.z;
  sum.zz += w.z * w.z;
}

__device__ inline float3 scaled_by(const Symmetric<float>& s, const float3& v) {
  return make_float3(s.xx * v.x + s.xy * v.y + s.xz * v.z, s.xy * v.x + s.yy * v.y + s.yz * v.z,
                     s.xz * v.x + s.yz * v.y + s.zz * v.z);
}

__device__ inline Symmetric<float> tensor(const TensorColumn& column, std::uint32_t at) {
  const float4 a = column.a[at];
  const float2 b = column.b[at];
  return {a.x, a.y, a.z, a.w, b.x, b.y};
}
__device__ inline void set_tensor(const TensorColumn& column, std::uint32_t at, const Symmetric<float>& t) {
  column.a[at] = make_float4(t.xx, t.xy, t.xz, t.yy);
  column.b[at] = make_float2(t.yz, t.zz);
}

/// Calls f(j, w) for the pairs of p with those of one kind. `factor`: kCentralDrag, the kernel's constant and
/// the time, s, that the force acts for.
template <Viscosity viscosity, Neighbours neighbours, class F>
__device__ inline void for_each_pair(const StepConstants& c, const ParticleView<float>& p,
                                     const NeighborColumns& n, const CellTable& cells, std::uint32_t cell,
                                     float factor, float of_fluid, F&& f) {
  const float h = c.support_radius;
  for_neighbors(c.grid, cells, cell, [&](std::uint32_t j) {
    const float4 x = __ldg(n.x + j);
    const float dx = p.x - x.x, dy = p.y - x.y, dz = p.z - x.z;
    const float r_squared = dx * dx + dy * dy + dz * dz;
    if (r_squared >= h * h || r_squared == 0.0f) return;
    ParticleView<float> i;
    i.volume = neighbours == Neighbours::kFluid ? x.w : __ldg(reinterpret_cast<const float*>(n.v + j) + 3);
    i.viscosity = viscosity_of<viscosity, neighbours>(p, n, j, of_fluid);
    const PairKernel<float> kernel = SolvedParts::ForceKernel::pair(r_squared, h, 1.0f);
    const float drag = factor * drag_coefficient(p, i, c.drag_shape(kernel.laplacian));
    if (!(drag > 0.0f)) return;
    const float w = sqrtf(drag) * kernel.inverse_r;
    f(j, make_float3(w * dx, w * dy, w * dz));
  });
}

/// A fluid particle as the viscous force sees it.
__device__ inline ParticleView<float> dragged(const SortedFluid& fluid, const ParticleKind* kinds,
                                              std::uint32_t p) {
  const float4 x = fluid.pressed[p];
  ParticleView<float> self{};
  self.x = x.x;
  self.y = x.y;
  self.z = x.z;
  self.volume = x.w;
  self.viscosity = particle_viscosity(fluid, kinds, p);
  return self;
}

/// Of a wall's particle. Where the fluid has one viscosity its column is not filled: Eq 9's mean is known up
/// front.
template <Viscosity viscosity>
__device__ inline ParticleView<float> dragged(const SortedSurface& surface, std::uint32_t i,
                                              const WallViscosity& wall, float first_viscosity) {
  return view(surface.x[i], surface.v[i],
              viscosity == Viscosity::kOne ? 0.5f * (wall.own + wall.of_fluid * first_viscosity) : wall.own);
}

/// Calls f(entry, w) for the pairs of entry `e` that each iteration reads: of a fluid particle those with
/// fluid and with bodies that may move, of such a body's particle those with fluid.
template <Viscosity viscosity, class F>
__device__ inline void for_each_pair_of(const StepConstants& c, const ParticleKind* kinds,
                                        float first_viscosity, float factor, const SortedFluid& fluid,
                                        const SortedSurface& moving, std::uint32_t e, F&& f) {
  if (e < fluid.count) {
    const std::uint32_t cell = fluid.state.key[e];
    const ParticleView<float> self = dragged(fluid, kinds, e);
    for_each_pair<viscosity, Neighbours::kFluid>(c, self, columns(fluid), fluid.cells, cell, factor, 1.0f, f);
    if (moving.count) {
      for_each_pair<Viscosity::kPair, Neighbours::kWalls>(
          c, self, columns(moving), moving.cells, cell, factor, 1.0f,
          [&](std::uint32_t j, const float3& w) { f(fluid.count + j, w); });
    }
    return;
  }
  const std::uint32_t i = e - fluid.count;
  const std::uint32_t cell = moving.key[i];
  if (cell >= c.grid.retired_key()) return;
  const WallViscosity wall = wall_viscosity(moving.viscosity[i]);
  const ParticleView<float> self = dragged<viscosity>(moving, i, wall, first_viscosity);
  for_each_pair<viscosity, Neighbours::kFluid>(c, self, columns(fluid), fluid.cells, cell, factor,
                                               wall.of_fluid, f);
}

/// Calls f.template operator()<viscosity>(): Eq 6 or Eq 9 between fluids.
template <class F>
auto with_solved_viscosity(const Plan& plan, F&& f) {
  if (plan.has(PassId::kPairViscosity)) return f.template operator()<Viscosity::kPair>();
  return f.template operator()<Viscosity::kOne>();
}

}  // namespace slosh::cuda
