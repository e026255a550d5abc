// The force pass with implicit viscosity: it goes by the pressure pairs, which the density pass found among
// all candidates, and writes the viscous pairs down beside the forces.
#include <algorithm>
#include <cstring>

#include "sim/cpu/passes.h"
#include "sim/passes/pair_viscosity/row_viscosity.h"
#include "sim/passes/pressure_force/pressure_loop.h"
#include "sim/passes/walls/row_mirror.h"
#include "sim/viscosity/artificial_viscosity.h"

namespace slosh {

namespace {

// Implicit viscosity is for this model and the incompressible one, whose viscous force is the same
// (Plan::implicit_viscosity).
using Parts = ModelParts<ParticleModel::kCorrected>;

// What all rows of a sub-step go through.
struct DragWalk {
  const PassContext& context;
  FluidParticles& fluid;
  const BoundaryParticles &fixed, &moving;
  const FluidPress& press;
  FluidViscosity& drag;
  float factor;  // kCentralDrag, the kernel's constant and the time, s, that the force acts for
};

// Writes a group's viscous pairs with fluid down.
template <bool presses, bool artificial>
GroupForces write_fluid_pairs(const DragWalk& w, const PairRows::Walk& walk, PairRows::Writer& writer) {
  const float* const own = &w.press.tensors[walk.first].xx;
  const Sixteen volume = fourths(walk.of_group<8>(own)), viscosity = fourths(walk.of_group<8>(own + 4));
  PairRows::Pair* to = writer.take(walk);
  return walk_forces<presses, artificial, false>(
      w.press, walk, w.context.support_radius, w.context.drag_shape,
      [&](const PairRows::Pair* four, const Sixteen& shape, const Sixteen& even, const Sixteen& odd) {
        // As drag_pairs(): both sides of a pair get a bitwise identical q.
        const Sixteen of_both = (0.5f * (viscosity + fourths(odd))) * (volume * fourths(even));
        const PairRows::Others others{four[0].other, four[1].other, four[2].other, four[3].other};
        put_pairs(of_both * (w.factor * shape), others.data(), to);
        to += PairRows::kTogether;
      });
}

// Of one particle: its pairs with moving bodies' particles, which are numbered on behind the fluid's, go down
// too; fixed ones are in the own block alone.
void write_body_pairs(const DragWalk& w, std::uint32_t p, const RowList& fixed_rows,
                      const RowList& moving_rows, PairRows::Writer& writer) {
  const FloatBatch h(w.context.support_radius), factor(w.factor), one(1.0f);
  const DragShape<FloatBatch> shape = in_all_lanes(w.context.drag_shape);
  const ParticleView<FloatBatch> self =
      broadcast(columns(w.fluid), p, particle_viscosity(w.context, w.fluid, p));
  Symmetric<FloatBatch> by_walls = no_rate();
  const NeighborColumns fixed = columns(w.fixed), moving = columns(w.moving);
  for_each_batch(fixed_rows, [&](std::uint32_t j, FloatBatch weight) {
    const PairBatch found = drag_pairs<Parts, Viscosity::kPair, Neighbours::kWalls>(self, fixed, j, weight, h,
                                                                                    shape, factor, one);
    const FloatBatch x = found.q * found.x, y = found.q * found.y;
    by_walls.xx += x * found.x;
    by_walls.xy += x * found.y;
    by_walls.xz += x * found.z;
    by_walls.yy += y * found.y;
    by_walls.yz += y * found.z;
    by_walls.zz += found.q * found.z * found.z;
  });
  if (!w.fixed.mirror.empty()) {
    // Wall particles stand still, so that their viscous force depends on the fluid's own velocity alone.
    const FloatBatch each(w.factor / kCentralDrag);
    add_mirror_rates<Parts>(self, w.fixed, fixed_rows, h, shape, by_walls, each);
  }
  const auto behind = static_cast<std::uint32_t>(w.fluid.index.particles());
  for_each_batch(moving_rows, [&](std::uint32_t j, FloatBatch weight) {
    const PairBatch found = drag_pairs<Parts, Viscosity::kPair, Neighbours::kWalls>(self, moving, j, weight,
                                                                                    h, shape, factor, one);
    writer.add(behind + j, found.q, lanes_less(FloatBatch(0.0f), found.q * found.r_squared));
  });
  w.drag.by_walls[p] = summed(by_walls);
}

// One chunk of rows. All of a pair in one loop, as in the density pass.
template <bool presses, bool artificial>
__attribute__((flatten)) void find_chunk(const DragWalk& w, std::size_t chunk) {
  FluidParticles& fluid = w.fluid;
  PairRows::Writer writer(w.drag.rows, chunk);
  std::uint32_t cell = w.context.grid.retired_key();
  RowList fixed_rows, moving_rows;
  w.press.rows.for_each_group(chunk, [&](const PairRows::Walk& walk) {
    const GroupForces forces = write_fluid_pairs<presses, artificial>(w, walk, writer);
    float pressed[16], damped[16];
    std::memcpy(pressed, &forces.pressed, sizeof pressed);
    std::memcpy(damped, &forces.dragged, sizeof damped);
    for (std::uint32_t a = 0; a < walk.count; ++a) {
      const std::uint32_t p = walk.first + a;
      const float factor = kCentralDrag * w.context.force_scale * fluid.volume[p];
      const auto force = [&](float own, int k) {
        return (presses ? own + pressed[4 * a + k] : 0.0f) + (artificial ? factor * damped[4 * a + k] : 0.0f);
      };
      fluid.fx[p] = force(w.press.own[p].x, 0);
      fluid.fy[p] = force(w.press.own[p].y, 1);
      fluid.fz[p] = force(w.press.own[p].z, 2);
      if (fluid.key[p] != cell) {
        cell = fluid.key[p];
        fixed_rows = w.fixed.index.rows(w.context.grid, cell);
        moving_rows = w.moving.index.rows(w.context.grid, cell);
      }
      fluid.near_wall[p] = fixed_rows.count + moving_rows.count > 0;
      w.drag.by_walls[p] = {};
      writer.begin(p);
      if (fluid.near_wall[p]) write_body_pairs(w, p, fixed_rows, moving_rows, writer);
      writer.end();
    }
  });
}

}  // namespace

void compute_forces_by_rows(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                            const BoundaryParticles& fixed, const BoundaryParticles& moving, double dt,
                            FluidViscosity& drag, const FluidPress& press) {
  drag.clear(fluid.index.particles(), press.rows.chunks());
  const float factor = kCentralDrag * static_cast<float>(dt) * context.force_scale;
  const DragWalk walk{context, fluid, fixed, moving, press, drag, factor};
  // With pressure projection pressures push later (PressureSolver::push_by_last).
  const bool presses = !context.plan.has(PassId::kPressureSolve);
  const bool artificial = any_artificial_viscosity(context.kinds, context.correction.artificial_viscosity);
  const auto run = [&]<bool pressing, bool artificial>() {
    team.run(press.rows.chunks(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t chunk = begin; chunk < end; ++chunk) find_chunk<pressing, artificial>(walk, chunk);
    });
  };
  if (presses && artificial) {
    run.operator()<true, true>();
  } else if (presses) {
    run.operator()<true, false>();
  } else if (artificial) {
    run.operator()<false, true>();
  } else {
    run.operator()<false, false>();
  }
}

}  // namespace slosh
