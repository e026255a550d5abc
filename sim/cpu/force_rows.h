// What the force pass writes down beside the forces, where a solve asks for the pairs again: who drags whom.
#pragma once

#include "sim/cpu/passes.h"
#include "sim/cpu/row_drag.h"
#include "sim/viscosity/implicit.h"

namespace slosh {

// What the passes over fluid particles go through.
struct FluidWalk {
  const PassContext& context;
  ThreadTeam& team;
  FluidParticles& fluid;
  const BoundaryParticles& fixed;
  const BoundaryParticles& moving;
};

// Where drag is not solved for, nothing is written down beside the forces.
struct NoRows {
  struct Given {};
  struct Row {
    Row(NoRows&, std::uint32_t, const ParticleView<FloatBatch>&) {}
    auto fluid() { return kNothingMore; }
    auto fixed() { return kNothingMore; }
    auto moving() { return kNothingMore; }
    void end() {}
  };
  NoRows(const Given&, std::size_t) {}
};

// Who drags whom, of one chunk of runs. By fluid and by moving bodies' particles, which are numbered on
// behind the fluid's; fixed ones are in the own block alone.
template <class Parts, Viscosity viscosity>
struct RowsOf {
  struct Given {
    const FluidWalk& walk;
    float dt;
    FluidDrag& drag;
  };

  // Of one particle; small enough to stay in registers.
  class Row {
   public:
    Row(RowsOf& rows, std::uint32_t p, const ParticleView<FloatBatch>& self)
        : rows_(rows), p_(p), self_(self) {
      rows_.writer.begin(p);
    }
    auto fluid() {
      return [this](const BatchView&, const BatchView&, std::uint32_t j, FloatBatch weight) {
        add(j, pairs<viscosity, Neighbours::kFluid>(rows_.fluids, j, weight));
      };
    }
    auto moving() {
      return [this](const BatchView&, const BatchView&, std::uint32_t j, FloatBatch weight) {
        add(rows_.behind + j, pairs<Viscosity::kPair, Neighbours::kWalls>(rows_.bodies, j, weight));
      };
    }
    auto fixed() {
      return [this](const BatchView&, const BatchView&, std::uint32_t j, FloatBatch weight) {
        const PairBatch w = pairs<Viscosity::kPair, Neighbours::kWalls>(rows_.walls, j, weight);
        const FloatBatch x = w.q * w.x, y = w.q * w.y;
        by_walls_.xx += x * w.x;
        by_walls_.xy += x * w.y;
        by_walls_.xz += x * w.z;
        by_walls_.yy += y * w.y;
        by_walls_.yz += y * w.z;
        by_walls_.zz += w.q * w.z * w.z;
      };
    }
    void end() {
      rows_.writer.end();
      rows_.given.drag.by_walls[p_] = summed(by_walls_);
    }

   private:
    void add(std::uint32_t first, const PairBatch& found) {
      rows_.writer.add(first, found.q, found.q * found.r_squared);
    }
    template <Viscosity of_pair, Neighbours neighbours>
    PairBatch pairs(const NeighborColumns& n, std::uint32_t j, FloatBatch weight) {
      return drag_pairs<Parts, of_pair, neighbours>(self_, n, j, weight, rows_.h, rows_.factor,
                                                    FloatBatch(1.0f));
    }

    RowsOf& rows_;
    const std::uint32_t p_;
    const ParticleView<FloatBatch> self_;
    Symmetric<FloatBatch> by_walls_ = no_rate();
  };

  RowsOf(const Given& g, std::size_t chunk)
      : given(g),
        writer(g.drag.rows, chunk),
        fluids(columns(g.walk.fluid)),
        walls(columns(g.walk.fixed)),
        bodies(columns(g.walk.moving)),
        h(g.walk.context.support_radius),
        factor(kCentralDrag * g.dt * g.walk.context.force_scale),
        behind(static_cast<std::uint32_t>(g.walk.fluid.index.particles())) {}

  const Given given;
  PairRows::Writer writer;
  const NeighborColumns fluids, walls, bodies;
  const FloatBatch h, factor;
  const std::uint32_t behind;
};

}  // namespace slosh
