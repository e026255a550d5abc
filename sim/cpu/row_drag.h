// Who drags a particle, batch by batch: what drag_rows.h writes down.
#pragma once

#include "sim/cpu/drag_rows.h"
#include "sim/cpu/row_force.h"

namespace slosh {

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
/// drag acts for.
template <class Parts, Viscosity viscosity, Neighbours neighbours>
PairBatch drag_pairs(const ParticleView<FloatBatch>& p, const NeighborColumns& n, std::uint32_t j,
                     FloatBatch weight, FloatBatch h, FloatBatch factor, FloatBatch of_fluid) {
  ParticleView<FloatBatch> i;
  i.volume = FloatBatch::load_unaligned(n.volume + j);
  i.viscosity = viscosity_of<viscosity, neighbours>(p, n, j, of_fluid);
  PairBatch pairs;
  pairs.x = p.x - FloatBatch::load_unaligned(n.x + j);
  pairs.y = p.y - FloatBatch::load_unaligned(n.y + j);
  pairs.z = p.z - FloatBatch::load_unaligned(n.z + j);
  pairs.r_squared = pairs.x * pairs.x + pairs.y * pairs.y + pairs.z * pairs.z;
  const auto kernel = Parts::ForceKernel::pair(pairs.r_squared, h, weight);
  // Eq 9's factor, so that both sides of a pair find the same to the bit.
  const FloatBatch of_both = (FloatBatch(0.5f) * (p.viscosity + i.viscosity)) * (p.volume * i.volume);
  pairs.q = of_both * (factor * kernel.laplacian * (kernel.inverse_r * kernel.inverse_r));
  return pairs;
}

/// What the force pass writes down of fluid particles where drag is solved for (implicit.h).
struct FluidDrag {
  DragRows rows;  ///< with fluid, and behind it with moving bodies' particles
  std::vector<Symmetric<float>>
      by_walls;  ///< N·s for each m/s of its own that fixed bodies take, one a particle
  std::vector<Symmetric<float>> block;  ///< the inverse of its own block, one a particle

  void clear(std::size_t particles, std::size_t chunks) {
    rows.clear(particles, chunks);
    by_walls.resize(particles);
    block.resize(particles);
  }
};

}  // namespace slosh
