// What the fluid lacks of bodies' drag once they are solved.
#include "sim/cpu/passes.h"
#include "sim/cpu/state.h"
#include "sim/passes/pressure_force/row_force.h"

namespace slosh {

namespace {

// One chunk of runs. All of a pair in one loop: left to itself the compiler calls functions and hands batches
// over in memory.
template <class Parts>
__attribute__((flatten)) void drag_chunk(const PassContext& context, FluidParticles& fluid,
                                         const BoundaryParticles& moving, const FluidPress& press,
                                         std::size_t begin, std::size_t end) {
  const std::vector<CellRun>& runs = fluid.index.runs();
  const NeighborColumns fluid_columns = columns(fluid);
  const NeighborColumns moving_columns = columns(moving);
  const FloatBatch h(context.support_radius);
  const DragShape<FloatBatch> shape = in_all_lanes(context.drag_shape);
  for (std::size_t r = begin; r < end; ++r) {
    const RowList& rows = press.near[r].moving;
    if (!rows.count) continue;
    for (std::uint32_t p = runs[r].particles.begin; p < runs[r].particles.end; ++p) {
      const ParticleView<FloatBatch> self =
          broadcast(fluid_columns, p, particle_viscosity(context, fluid, p));
      ForceSum<FloatBatch> sum{FloatBatch(0.0f), FloatBatch(0.0f), FloatBatch(0.0f)};
      for_each_dragged<Viscosity::kPair, Neighbours::kWalls>(
          self, moving_columns, rows, h, FloatBatch(1.0f),
          [&](const ParticleView<FloatBatch>& i, FloatBatch reach, FloatBatch weight) {
            add_pair_viscosity<typename Parts::ForceKernel, Parts::kDrag>(self, i, reach, shape, weight, sum);
          });
      const float scale = context.force_scale;
      fluid.fx[p] += scale * lane_sum(sum.x);
      fluid.fy[p] += scale * lane_sum(sum.y);
      fluid.fz[p] += scale * lane_sum(sum.z);
    }
  }
}

}  // namespace

void drag_fluid(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                const BoundaryParticles& moving, const FluidPress& press) {
  with_model(context.plan.model, [&]<class Parts>() {
    team.run(fluid.index.runs().size(), kForceRunsPerChunk, [&](std::size_t begin, std::size_t end) {
      drag_chunk<Parts>(context, fluid, moving, press, begin, end);
    });
  });
}

namespace passes {

void body_drag_on_cpu(CpuState& s, const PassInputs& in) {
  s.moving.set_velocities(s.bodies, in.changes);
  drag_fluid(s.context, s.team, s.fluid, s.moving.sorted(), s.pairs);
}

}  // namespace passes

}  // namespace slosh
