// The force of rows of sorted neighbours on one particle: the inner loop of both force passes.
#pragma once

#include "sim/cpu/particles.h"
#include "sim/cpu/row_batches.h"
#include "sim/model.h"

namespace slosh {

/// Runs of cells that a thread takes at once.
inline constexpr std::size_t kForceRunsPerChunk = 16;

/// Where the neighbours' columns are. Unused ones (velocity and viscosity without viscosity) may be null.
struct NeighborColumns {
  const float *x, *y, *z;
  const float *vx, *vy, *vz;
  const float *pressure, *volume, *viscosity;
  // The corrected model's, of fluid:
  const float *pxx, *pxy, *pxz, *pyy, *pyz, *pzz;
  const float *ux, *uy, *uz;
  const float* reach = nullptr;  // of bodies
};

// The corrected model's are null where the plan has them not, and for bodies.
inline NeighborColumns columns(const FluidParticles& f) {
  const Column<float>& pressure = f.solved.empty() ? f.pressure : f.solved;
  return {f.x.data(),      f.y.data(),      f.z.data(),         f.vx.data(),  f.vy.data(),  f.vz.data(),
          pressure.data(), f.volume.data(), f.viscosity.data(), f.pxx.data(), f.pxy.data(), f.pxz.data(),
          f.pyy.data(),    f.pyz.data(),    f.pzz.data(),       f.ux.data(),  f.uy.data(),  f.uz.data()};
}

inline NeighborColumns columns(const BoundaryParticles& b) {
  return {b.x.data(),        b.y.data(),      b.z.data(),
          b.vx.data(),       b.vy.data(),     b.vz.data(),
          b.pressure.data(), b.volume.data(), b.viscosity.data(),
          nullptr,           nullptr,         nullptr,
          nullptr,           nullptr,         nullptr,
          nullptr,           nullptr,         nullptr,
          b.reach.data()};
}

enum class Neighbours { kFluid, kWalls };

/// A wall's particle's own side of Eq 9. Where the fluid has one viscosity its column is not filled: the mean
/// of the two is known up front.
template <Viscosity viscosity>
float own_viscosity(const WallViscosity& wall, float of_the_fluid) {
  return viscosity == Viscosity::kOne ? 0.5f * (wall.own + wall.of_fluid * of_the_fluid) : wall.own;
}

/// A neighbour's side of Eq 9. `of_fluid`: WallViscosity's where p is a wall's particle, else 1.
template <Viscosity viscosity, Neighbours neighbours>
FloatBatch viscosity_of(const ParticleView<FloatBatch>& p, const NeighborColumns& n, std::uint32_t j,
                        FloatBatch of_fluid) {
  if constexpr (viscosity != Viscosity::kPair) {
    return p.viscosity;
  } else if constexpr (neighbours == Neighbours::kWalls) {
    const FloatBatch own = FloatBatch::load_unaligned(n.viscosity + j);
    // side_of_wall, for a batch
    const FloatBatch fluids =
        xsimd::select(own == FloatBatch(static_cast<float>(kFreeSlip)), -p.viscosity, p.viscosity);
    return xsimd::select(own < FloatBatch(0.0f), fluids, own);
  } else {
    return of_fluid * FloatBatch::load_unaligned(n.viscosity + j);
  }
}

/// Within which p and its neighbours j meet: what walls' particles have, of fluid `h`, m.
template <Neighbours neighbours>
FloatBatch reach_of(const NeighborColumns& n, std::uint32_t j, FloatBatch h) {
  if constexpr (neighbours == Neighbours::kWalls) return FloatBatch::load_unaligned(n.reach + j);
  return h;
}

/// What is done with each batch besides: nothing.
struct NothingBesides {
  void operator()(const ParticleView<FloatBatch>&, FloatBatch, FloatBatch) const {}
};

/// `h`: within which p meets fluid, m. Calls also(i, reach, weight) for each batch besides.
template <class Parts, PairRule rule, Viscosity viscosity, Neighbours neighbours = Neighbours::kFluid,
          class Sum = ForceSum<FloatBatch>, class Also = NothingBesides>
void add_row_forces(const ParticleView<FloatBatch>& p, const NeighborColumns& n, const RowList& rows,
                    FloatBatch h, const DragShape<FloatBatch>& shape, Sum& sum,
                    FloatBatch of_fluid = FloatBatch(1.0f), const Also& also = {}) {
  // With one viscosity, viscosity times velocity is in u already.
  constexpr bool kViscous =
      is_corrected_fluid(rule) ? viscosity == Viscosity::kPair : viscosity != Viscosity::kNone;
  constexpr bool kVolume = kViscous || rule == PairRule::kPaper || is_corrected_fluid(rule);
  const auto add = [&](std::uint32_t j, FloatBatch weight) {
    ParticleView<FloatBatch> i;
    i.x = FloatBatch::load_unaligned(n.x + j);
    i.y = FloatBatch::load_unaligned(n.y + j);
    i.z = FloatBatch::load_unaligned(n.z + j);
    if constexpr (rule == PairRule::kCorrected || is_corrected_body(rule)) {
      i.push = {FloatBatch::load_unaligned(n.pxx + j), FloatBatch::load_unaligned(n.pxy + j),
                FloatBatch::load_unaligned(n.pxz + j), FloatBatch::load_unaligned(n.pyy + j),
                FloatBatch::load_unaligned(n.pyz + j), FloatBatch::load_unaligned(n.pzz + j)};
    }
    if constexpr (presses(rule) && rule != PairRule::kCorrected && rule != PairRule::kCorrectedBody)
      i.pressure = FloatBatch::load_unaligned(n.pressure + j);
    if constexpr (is_corrected_fluid(rule)) {
      i.ux = FloatBatch::load_unaligned(n.ux + j);
      i.uy = FloatBatch::load_unaligned(n.uy + j);
      i.uz = FloatBatch::load_unaligned(n.uz + j);
    }
    if constexpr (kVolume) i.volume = FloatBatch::load_unaligned(n.volume + j);
    if constexpr (kViscous) {
      i.vx = FloatBatch::load_unaligned(n.vx + j);
      i.vy = FloatBatch::load_unaligned(n.vy + j);
      i.vz = FloatBatch::load_unaligned(n.vz + j);
      i.viscosity = viscosity_of<viscosity, neighbours>(p, n, j, of_fluid);
    }
    const FloatBatch reach = reach_of<neighbours>(n, j, h);
    add_pair_force<typename Parts::ForceKernel, rule, Parts::kDrag, kViscous>(p, i, reach, shape, weight,
                                                                              sum);
    also(i, reach, weight);
  };
  for_each_batch(rows, add);
}

/// Calls f(i, reach, weight) for the batches of neighbours of p as the viscous force sees them. `h`: within
/// which p meets fluid, m.
template <Viscosity viscosity, Neighbours neighbours, class F>
void for_each_dragged(const ParticleView<FloatBatch>& p, const NeighborColumns& n, const RowList& rows,
                      FloatBatch h, FloatBatch of_fluid, F&& f) {
  for_each_batch(rows, [&](std::uint32_t j, FloatBatch weight) {
    ParticleView<FloatBatch> i;
    i.x = FloatBatch::load_unaligned(n.x + j);
    i.y = FloatBatch::load_unaligned(n.y + j);
    i.z = FloatBatch::load_unaligned(n.z + j);
    i.vx = FloatBatch::load_unaligned(n.vx + j);
    i.vy = FloatBatch::load_unaligned(n.vy + j);
    i.vz = FloatBatch::load_unaligned(n.vz + j);
    i.volume = FloatBatch::load_unaligned(n.volume + j);
    i.viscosity = viscosity_of<viscosity, neighbours>(p, n, j, of_fluid);
    f(i, reach_of<neighbours>(n, j, h), weight);
  });
}

inline ParticleView<FloatBatch> broadcast(const NeighborColumns& n, std::uint32_t j, float viscosity) {
  ParticleView<FloatBatch> p;
  p.x = FloatBatch(n.x[j]);
  p.y = FloatBatch(n.y[j]);
  p.z = FloatBatch(n.z[j]);
  p.vx = FloatBatch(n.vx[j]);
  p.vy = FloatBatch(n.vy[j]);
  p.vz = FloatBatch(n.vz[j]);
  p.pressure = FloatBatch(n.pressure[j]);
  p.volume = FloatBatch(n.volume[j]);
  p.viscosity = FloatBatch(viscosity);
  if (!n.pxx) return p;
  p.push = {FloatBatch(n.pxx[j]), FloatBatch(n.pxy[j]), FloatBatch(n.pxz[j]),
            FloatBatch(n.pyy[j]), FloatBatch(n.pyz[j]), FloatBatch(n.pzz[j])};
  p.ux = FloatBatch(n.ux[j]);
  p.uy = FloatBatch(n.uy[j]);
  p.uz = FloatBatch(n.uz[j]);
  return p;
}

}  // namespace slosh
