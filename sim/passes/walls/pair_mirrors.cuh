// Fluid and free-slip walls (passes/walls/mirror_drag.h), as sim/passes/walls/row_mirror.h.
#pragma once

#include "sim/cuda/pair_rows.cuh"
#include "sim/passes/walls/mirror_drag.h"

namespace slosh::cuda {

/// Of the particle that is `at` in local order.
__device__ inline MirrorView<float> mirror_of(const MirrorPlanes& planes, std::uint32_t at) {
  const float4 n = __ldg(planes.normal + at);
  const float4 a = __ldg(planes.bend_a + at);
  const float2 b = __ldg(planes.bend_b + at);
  return {n.x, n.y, n.z, {a.x, a.y, a.z, a.w, b.x, b.y}};
}
__device__ inline bool mirrors(const MirrorView<float>& m) {
  return m.nx != 0.0f || m.ny != 0.0f || m.nz != 0.0f;
}

/// Adds what a fluid particle loses by the mirrors around it, N·s/m without the kernel's constant, or the
/// thread's share of it. `walls`: such as have mirrors.
template <class Team, class Parts>
__device__ inline void add_mirror_rates(const StepConstants& c, const ParticleView<float>& p,
                                        const SortedSurface& walls, std::uint32_t cell,
                                        Symmetric<float>& sum) {
  for_neighbors<Team>(c.grid, walls.cells, cell, [&](std::uint32_t j) {
    const MirrorView<float> mirror = mirror_of(walls.mirror, __ldg(walls.order + j));
    if (!mirrors(mirror)) return;
    const ParticleView<float> i = view(__ldg(walls.x + j), __ldg(walls.v + j), 0.0f);
    add_mirror_rate<typename Parts::ForceKernel>(p, i, mirror, c.support_radius, c.drag_shape, 1.0f, sum);
  });
}

/// Adds the force on it by that, N without the kernel's constant, or the thread's share of it.
template <class Team, class Parts>
__device__ inline void add_mirror_forces(const StepConstants& c, const ParticleView<float>& p,
                                         const SortedSurface& walls, std::uint32_t cell,
                                         ForceSum<float>& sum) {
  Symmetric<float> rate{};
  add_mirror_rates<Team, Parts>(c, p, walls, cell, rate);
  const Vector3<float> lost = times(rate, p.vx, p.vy, p.vz);
  sum.x -= lost.x;
  sum.y -= lost.y;
  sum.z -= lost.z;
}

/// Adds the force on the i-th particle of `walls` by the fluid that it mirrors, N without the kernel's
/// constant, or the thread's share of it. `velocity(j)`: a fluid particle's, m/s, float3. `first_viscosity`:
/// the fluid's where all have one.
template <class Team, class Parts, Viscosity viscosity, class Velocity>
__device__ inline void add_forces_on_mirror(const StepConstants& c, const SortedSurface& walls,
                                            std::uint32_t i, std::uint32_t cell, float first_viscosity,
                                            const SortedFluid& fluid, Velocity&& velocity,
                                            SurfaceSum<float>& sum) {
  const MirrorView<float> mirror = mirror_of(walls.mirror, walls.order[i]);
  if (!mirrors(mirror)) return;
  const ParticleView<float> self = view(walls.x[i], walls.v[i], 0.0f);
  for_neighbors<Team>(c.grid, fluid.cells, cell, [&](std::uint32_t j) {
    const float4 x = __ldg(fluid.pressed + j);
    const float4 v = __ldg(fluid.state.v + j);
    const float3 moves = velocity(j, v);
    ParticleView<float> p =
        view(x, v, viscosity == Viscosity::kPair ? __ldg(fluid.viscosity + j) : first_viscosity);
    p.vx = moves.x;
    p.vy = moves.y;
    p.vz = moves.z;
    add_mirror_force<typename Parts::ForceKernel>(p, self, mirror, c.support_radius, c.drag_shape, 1.0f, sum);
  });
}

}  // namespace slosh::cuda
