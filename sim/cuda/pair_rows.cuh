// The force of the neighbours of one kind on one particle: the inner loop of both force passes, as
// sim/cpu/row_force.h.
#pragma once

#include "sim/cuda/rows.cuh"
#include "sim/model.h"

namespace slosh::cuda {

/// Columns of the neighbours; `viscosity` may be null unless kPair.
struct NeighborColumns {
  const float4* x;  ///< w: pressure
  const float4* v;  ///< w: volume
  const float* viscosity;
};

template <class Parts, PairRule rule, Viscosity viscosity>
__device__ inline void add_forces(const StepConstants& c, const ParticleView<float>& p,
                                  const NeighborColumns& n, const CellTable& cells, std::uint32_t cell,
                                  ForceSum<float>& sum) {
  constexpr bool kViscous = viscosity != Viscosity::kNone;
  for_neighbors(c.grid, cells, cell, [&](std::uint32_t j) {
    ParticleView<float> i;
    const float4 x = __ldg(n.x + j);
    i.x = x.x;
    i.y = x.y;
    i.z = x.z;
    i.pressure = x.w;
    if constexpr (kViscous || rule == PairRule::kPaper) {
      const float4 v = __ldg(n.v + j);
      i.vx = v.x;
      i.vy = v.y;
      i.vz = v.z;
      i.volume = v.w;
    }
    if constexpr (kViscous)
      i.viscosity = viscosity == Viscosity::kPair ? __ldg(n.viscosity + j) : p.viscosity;
    add_pair_force<typename Parts::ForceKernel, rule, Parts::kDrag, kViscous>(p, i, c.support_radius, 1.0f,
                                                                              sum);
  });
}

__device__ inline ParticleView<float> view(const float4& x, const float4& v, float viscosity) {
  return {x.x, x.y, x.z, v.x, v.y, v.z, x.w, v.w, viscosity};
}

}  // namespace slosh::cuda
