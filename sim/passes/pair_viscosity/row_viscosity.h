// The viscous pairs of a particle, batch by batch, and as implicit viscosity uses them.
#pragma once

#include <cstring>

#include "sim/cpu/pair_rows.h"
#include "sim/passes/pressure_force/row_force.h"

namespace slosh {

inline Symmetric<FloatBatch> no_rate() {
  const FloatBatch z(0.0f);
  return {z, z, z, z, z, z};
}

inline Symmetric<float> summed(const Symmetric<FloatBatch>& s) {
  return {lane_sum(s.xx), lane_sum(s.xy), lane_sum(s.xz), lane_sum(s.yy), lane_sum(s.yz), lane_sum(s.zz)};
}

/// A batch of candidates: d from each to the particle, m, and q, kg/m²: over the sub-step it exerts a viscous
/// impulse on the particle by q d (d · v), N·s, v their velocity less the particle's. q is 0 out of reach.
struct PairBatch {
  FloatBatch x, y, z;  // d
  FloatBatch r_squared;
  FloatBatch q;
};

/// Calls f(p, N·s on p) for the particles of a chunk, by those that it has pairs with, all at `places` and
/// moving by `velocities`.
template <class F>
void for_each_dragged_of(const PairRows& rows, std::size_t chunk, const Vector4* places,
                         const Vector4* velocities, F&& f) {
  rows.for_each_group(chunk, [&](const PairRows::Walk& walk) {
    const Sixteen dragged = walk.dragged(places, velocities);
    float of[16];
    std::memcpy(of, &dragged, sizeof dragged);
    for (std::uint32_t a = 0; a < walk.count; ++a)
      f(walk.first + a, ForceSum<float>{of[4 * a], of[4 * a + 1], of[4 * a + 2]});
  });
}

/// Calls f(p, the sum of q d dᵀ over p's row, kg) for the particles of a chunk.
template <class F>
void for_each_rate_of(const PairRows& rows, std::size_t chunk, const Vector4* places, F&& f) {
  rows.for_each_group(chunk, [&](const PairRows::Walk& walk) {
    const PairRows::Walk::SumOfSquares rates = walk.rates(places);
    float even[16], odd[16];
    std::memcpy(even, &rates.even, sizeof even);
    std::memcpy(odd, &rates.odd, sizeof odd);
    for (std::uint32_t a = 0; a < walk.count; ++a) {
      const float *e = even + 4 * a, *o = odd + 4 * a;
      f(walk.first + a, Symmetric<float>{e[0], o[0], o[2], e[1], o[1], e[2]});
    }
  });
}

/// Calls f.template operator()<viscosity>(): Eq 6 or Eq 9 between fluids.
template <class F>
void with_solved_viscosity(const Plan& plan, F&& f) {
  if (plan.has(PassId::kPairViscosity)) {
    f.template operator()<Viscosity::kPair>();
  } else {
    f.template operator()<Viscosity::kOne>();
  }
}

/// Of p with the batch that begins at j. `factor`: kCentralDrag, the kernel's constant and the time, s, that
/// the force acts for.
template <class Parts, Viscosity viscosity, Neighbours neighbours>
PairBatch drag_pairs(const ParticleView<FloatBatch>& p, const NeighborColumns& n, std::uint32_t j,
                     FloatBatch weight, FloatBatch h, const DragShape<FloatBatch>& shape, FloatBatch factor,
                     FloatBatch of_fluid) {
  ParticleView<FloatBatch> i;
  i.volume = FloatBatch::load_unaligned(n.volume + j);
  i.viscosity = viscosity_of<viscosity, neighbours>(p, n, j, of_fluid);
  PairBatch pairs;
  pairs.x = p.x - FloatBatch::load_unaligned(n.x + j);
  pairs.y = p.y - FloatBatch::load_unaligned(n.y + j);
  pairs.z = p.z - FloatBatch::load_unaligned(n.z + j);
  pairs.r_squared = pairs.x * pairs.x + pairs.y * pairs.y + pairs.z * pairs.z;
  const auto kernel = Parts::ForceKernel::pair(pairs.r_squared, h, weight);
  // Eq 9's factor, so that both sides of a pair get a bitwise identical one.
  const FloatBatch of_both = (FloatBatch(0.5f) * (p.viscosity + i.viscosity)) * (p.volume * i.volume);
  pairs.q = of_both * (factor * (shape(kernel.laplacian) * (kernel.inverse_r * kernel.inverse_r)));
  return pairs;
}

/// What the force pass (pressure_force/cpu_rows.cpp) writes down of fluid particles with implicit viscosity
/// (implicit.h).
struct FluidViscosity {
  PairRows rows;  ///< with fluid, and behind it with moving bodies' particles
  std::vector<Symmetric<float>>
      by_walls;  ///< N·s for each m/s of its own that fixed bodies take, one a particle

  void clear(std::size_t particles, std::size_t chunks) {
    rows.clear(chunks);
    by_walls.resize(particles);
  }
};

}  // namespace slosh
