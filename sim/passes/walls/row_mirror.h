// Fluid and free-slip walls, batch by batch (passes/walls/mirror_drag.h).
#pragma once

#include "sim/passes/pressure_force/row_force.h"
#include "sim/passes/walls/mirror_drag.h"

namespace slosh {

inline MirrorView<FloatBatch> mirrors_from(const MirrorColumns& m, std::uint32_t j) {
  const auto of = [j](const Column<float>& column) { return FloatBatch::load_unaligned(column.data() + j); };
  return {of(m.nx), of(m.ny), of(m.nz), {of(m.xx), of(m.xy), of(m.xz), of(m.yy), of(m.yz), of(m.zz)}};
}

/// Adds what a fluid particle loses by the mirrors around it, N·s/m times `each`.
template <class Parts>
void add_mirror_rates(const ParticleView<FloatBatch>& p, const BoundaryParticles& walls, const RowList& rows,
                      FloatBatch h, const DragShape<FloatBatch>& shape, Symmetric<FloatBatch>& sum,
                      FloatBatch each = FloatBatch(1.0f)) {
  for_each_batch(rows, [&](std::uint32_t j, FloatBatch weight) {
    ParticleView<FloatBatch> i;
    i.x = FloatBatch::load_unaligned(walls.x.data() + j);
    i.y = FloatBatch::load_unaligned(walls.y.data() + j);
    i.z = FloatBatch::load_unaligned(walls.z.data() + j);
    i.volume = each * FloatBatch::load_unaligned(walls.volume.data() + j);
    add_mirror_rate<typename Parts::ForceKernel>(p, i, mirrors_from(walls.mirror, j), h, shape, weight, sum);
  });
}

/// Adds the force on it by that, N without the kernel's constant.
template <class Parts>
void add_mirror_forces(const ParticleView<FloatBatch>& p, const BoundaryParticles& walls, const RowList& rows,
                       FloatBatch h, const DragShape<FloatBatch>& shape, ForceSum<FloatBatch>& sum) {
  const FloatBatch none(0.0f);
  Symmetric<FloatBatch> rate{none, none, none, none, none, none};
  add_mirror_rates<Parts>(p, walls, rows, h, shape, rate);
  const Vector3<FloatBatch> lost = times(rate, p.vx, p.vy, p.vz);
  sum.x -= lost.x;
  sum.y -= lost.y;
  sum.z -= lost.z;
}

/// Adds the force on the i-th particle of `walls` by the fluid that it mirrors, N without the kernel's
/// constant, times `each`. `first_viscosity`: the fluid's where all have one.
template <class Parts, Viscosity viscosity>
void add_forces_on_mirror(const BoundaryParticles& walls, std::uint32_t i, float first_viscosity,
                          const NeighborColumns& fluid, const RowList& rows, FloatBatch h,
                          const DragShape<FloatBatch>& shape, SurfaceSum<FloatBatch>& sum,
                          FloatBatch each = FloatBatch(1.0f)) {
  const MirrorColumns& m = walls.mirror;
  if (m.nx[i] == 0.0f && m.ny[i] == 0.0f && m.nz[i] == 0.0f) return;
  const MirrorView<FloatBatch> mirror{FloatBatch(m.nx[i]),
                                      FloatBatch(m.ny[i]),
                                      FloatBatch(m.nz[i]),
                                      {FloatBatch(m.xx[i]), FloatBatch(m.xy[i]), FloatBatch(m.xz[i]),
                                       FloatBatch(m.yy[i]), FloatBatch(m.yz[i]), FloatBatch(m.zz[i])}};
  ParticleView<FloatBatch> self{};
  self.x = FloatBatch(walls.x[i]);
  self.y = FloatBatch(walls.y[i]);
  self.z = FloatBatch(walls.z[i]);
  self.volume = each * FloatBatch(walls.volume[i]);
  self.viscosity = FloatBatch(first_viscosity);
  for_each_dragged<viscosity, Neighbours::kFluid>(
      self, fluid, rows, h, FloatBatch(1.0f),
      [&](const ParticleView<FloatBatch>& p, FloatBatch reach, FloatBatch weight) {
        add_mirror_force<typename Parts::ForceKernel>(p, self, mirror, reach, shape, weight, sum);
      });
}

}  // namespace slosh
