// The force of rows of sorted neighbours on one particle: the inner loop of both force passes.
#pragma once

#include "sim/cpu/cell_grid.h"
#include "sim/cpu/simd.h"
#include "sim/model.h"

namespace slosh {

/// Where the neighbours' columns are. Unused ones (velocity and viscosity without viscosity) may be null.
struct NeighborColumns {
  const float *x, *y, *z;
  const float *vx, *vy, *vz;
  const float *pressure, *volume, *viscosity;
};

template <class Parts, PairRule rule, Viscosity viscosity>
void add_row_forces(const ParticleView<FloatBatch>& p, const NeighborColumns& n, const RowList& rows,
                    FloatBatch h, ForceSum<FloatBatch>& sum) {
  constexpr bool kViscous = viscosity != Viscosity::kNone;
  const auto add = [&](std::uint32_t j, FloatBatch weight) {
    ParticleView<FloatBatch> i;
    i.x = FloatBatch::load_unaligned(n.x + j);
    i.y = FloatBatch::load_unaligned(n.y + j);
    i.z = FloatBatch::load_unaligned(n.z + j);
    i.pressure = FloatBatch::load_unaligned(n.pressure + j);
    if constexpr (kViscous || rule == PairRule::kPaper) i.volume = FloatBatch::load_unaligned(n.volume + j);
    if constexpr (kViscous) {
      i.vx = FloatBatch::load_unaligned(n.vx + j);
      i.vy = FloatBatch::load_unaligned(n.vy + j);
      i.vz = FloatBatch::load_unaligned(n.vz + j);
      i.viscosity = viscosity == Viscosity::kPair ? FloatBatch::load_unaligned(n.viscosity + j) : p.viscosity;
    }
    add_pair_force<typename Parts::ForceKernel, rule, Parts::kDrag, kViscous>(p, i, h, weight, sum);
  };
  for (int row = 0; row < rows.count; ++row) {
    const ParticleRange range = rows.rows[row];
    std::uint32_t j = range.begin;
    for (; j + kLanes <= range.end; j += kLanes) add(j, FloatBatch(1.0f));
    if (j < range.end) add(j, first_lanes(range.end - j));
  }
}

inline ParticleView<FloatBatch> broadcast(const NeighborColumns& n, std::uint32_t j, float viscosity) {
  return {FloatBatch(n.x[j]),        FloatBatch(n.y[j]),      FloatBatch(n.z[j]),
          FloatBatch(n.vx[j]),       FloatBatch(n.vy[j]),     FloatBatch(n.vz[j]),
          FloatBatch(n.pressure[j]), FloatBatch(n.volume[j]), FloatBatch(viscosity)};
}

}  // namespace slosh
