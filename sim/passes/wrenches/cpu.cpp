// Eq 5, 6 and 9 on body particles, summed by Eq 10–12.
#include "sim/cpu/passes.h"
#include "sim/cpu/state.h"
#include "sim/passes/pressure_force/row_force.h"
#include "sim/passes/walls/row_mirror.h"

namespace slosh {

namespace {

// Of one body particle, N·s/m.
template <class Parts, Viscosity viscosity>
Symmetric<float> drag_rate(const ParticleView<FloatBatch>& self, const NeighborColumns& fluid,
                           const RowList& rows, FloatBatch h, const DragShape<FloatBatch>& shape, float scale,
                           float of_fluid) {
  const FloatBatch none(0.0f);
  Symmetric<FloatBatch> sum{none, none, none, none, none, none};
  for_each_dragged<viscosity, Neighbours::kFluid>(
      self, fluid, rows, h, FloatBatch(of_fluid),
      [&](const ParticleView<FloatBatch>& i, FloatBatch reach, FloatBatch weight) {
        add_pair_viscosity_rate<typename Parts::ForceKernel, Parts::kDrag>(self, i, reach, shape, weight,
                                                                           sum);
      });
  return {scale * lane_sum(sum.xx), scale * lane_sum(sum.xy), scale * lane_sum(sum.xz),
          scale * lane_sum(sum.yy), scale * lane_sum(sum.yz), scale * lane_sum(sum.zz)};
}

}  // namespace

void sum_body_wrenches(PassContext& context, ThreadTeam& team, const FluidParticles& fluid,
                       const BoundaryParticles& boundary, std::span<const glm::dvec3> centers,
                       const std::vector<char>& wanted, SurfaceSums& scratch, std::span<Wrench> wrenches,
                       std::span<BodyDrag> drags) {
  const std::vector<CellRun>& runs = boundary.index.runs();
  const std::size_t count = boundary.index.particles();
  if (count == 0) return;
  scratch.force.resize(count);
  scratch.couple.resize(count);
  if (!drags.empty()) scratch.drag_rate.resize(count);
  const NeighborColumns fluid_columns = columns(fluid);
  const NeighborColumns own = columns(boundary);
  const DragShape<FloatBatch> shape = in_all_lanes(context.drag_shape);
  const FloatBatch beyond(1.0f - context.correction.wall_layer);
  with_physics(context.plan, [&]<class Parts, Viscosity viscosity>() {
    team.run(runs.size(), kForceRunsPerChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t r = begin; r < end; ++r) {
        const RowList rows = fluid.index.rows(context.grid, runs[r].cell);
        for (std::uint32_t i = runs[r].particles.begin; i < runs[r].particles.end; ++i) {
          scratch.force[i] = scratch.couple[i] = glm::vec3(0.0f);
          if (!drags.empty()) scratch.drag_rate[i] = {};
          if (rows.count == 0 || !wanted[boundary.body[i]]) continue;
          const FloatBatch none(0.0f), h(boundary.reach[i]);
          SurfaceSum<FloatBatch> sum{{none, none, none}, none, none, none, beyond};
          const WallViscosity wall = wall_viscosity(boundary.viscosity[i]);
          const ParticleView<FloatBatch> self =
              broadcast(own, i, own_viscosity<viscosity>(wall, context.kinds.front().viscosity));
          add_row_forces<Parts, Parts::kOnBodies, viscosity>(self, fluid_columns, rows, h, shape, sum,
                                                             FloatBatch(wall.of_fluid));
          if constexpr (Parts::kCorrected && viscosity != Viscosity::kNone) {
            if (!boundary.mirror.empty())
              add_forces_on_mirror<Parts, viscosity>(boundary, i, context.kinds.front().viscosity,
                                                     fluid_columns, rows, h, shape, sum);
          }
          const float scale = context.force_scale;
          scratch.force[i] = scale * glm::vec3(lane_sum(sum.x), lane_sum(sum.y), lane_sum(sum.z));
          scratch.couple[i] = scale * glm::vec3(lane_sum(sum.cx), lane_sum(sum.cy), lane_sum(sum.cz));
          if constexpr (viscosity != Viscosity::kNone) {
            if (!drags.empty())
              scratch.drag_rate[i] =
                  drag_rate<Parts, viscosity>(self, fluid_columns, rows, h, shape, scale, wall.of_fluid);
          }
        }
      }
    });
  });
  // One fixed order (that of the cells), so that the sum does not depend on the threads.
  for (std::size_t i = 0; i < count; ++i) {
    const int body = boundary.body[i];
    if (!wanted[body]) continue;
    const glm::dvec3 force(scratch.force[i]);
    const glm::dvec3 arm = glm::dvec3(boundary.x[i], boundary.y[i], boundary.z[i]) - centers[body];
    wrenches[body].force += force;
    wrenches[body].torque += glm::cross(arm, force) + glm::dvec3(scratch.couple[i]);
    if (drags.empty()) continue;
    const Symmetric<float>& rate = scratch.drag_rate[i];
    drags[body].add({rate.xx, rate.xy, rate.xz, rate.yy, rate.yz, rate.zz}, arm);
  }
}

namespace passes {

void wrenches_on_cpu(CpuState& s, const PassInputs&) {
  s.sum_wrenches(s.moving, s.found,
                 s.context.plan.has(PassId::kBodyDrag) ? std::span(s.drags) : std::span<BodyDrag>());
  // Fixed ones are measured when all of the pressure is known.
  if (s.context.plan.has(PassId::kPressureSolve)) return;
  if (s.fixed_measured) s.sum_wrenches(s.fixed, s.found, {});
  s.carry_probe_forces_out(s.found);
}

}  // namespace passes

}  // namespace slosh
