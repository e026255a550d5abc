// Eq 5, 6 and 9 on body particles, summed by Eq 10–12.
#include <algorithm>

#include "sim/cpu/passes.h"
#include "sim/cpu/state.h"
#include "sim/passes/pressure_force/near_rows.h"
#include "sim/passes/walls/row_mirror.h"

namespace slosh {

namespace {

// What goes into each body particle's sums, one chunk of runs at a time, and where they go.
struct SurfaceWalk {
  const PassContext& context;
  const FluidParticles& fluid;
  const BoundaryParticles& boundary;
  const std::vector<char>& wanted;
  SurfaceSums& sums;
  bool drags;
};

// All of a pair in one loop: left to itself the compiler calls functions and hands batches over in memory.
template <class Parts, Viscosity viscosity>
__attribute__((flatten)) void find_sums(const SurfaceWalk& walk, std::size_t begin, std::size_t end) {
  const PassContext& context = walk.context;
  const BoundaryParticles& boundary = walk.boundary;
  const std::vector<CellRun>& runs = boundary.index.runs();
  const NeighborColumns own = columns(boundary);
  const NeighborColumns fluid_columns = columns(walk.fluid);
  const DragShape<FloatBatch> shape = in_all_lanes(context.drag_shape);
  const FloatBatch beyond(1.0f - context.correction.wall_layer);
  const float scale = context.force_scale;
  for (std::size_t r = begin; r < end; ++r) {
    RowList rows = walk.fluid.index.rows(context.grid, runs[r].cell);
    const ParticleRange range = runs[r].particles;
    float h_most = 0.0f;  // of those that are wanted
    for (std::uint32_t i = range.begin; i < range.end && rows.count > 0; ++i) {
      if (walk.wanted[boundary.body[i]]) h_most = std::max(h_most, boundary.reach[i]);
    }
    if (rows.count > 0) rows = CellBox(own, range).in_reach(fluid_columns, rows, h_most);
    walk.sums.met[r] = rows.count > 0;
    if (rows.count == 0) continue;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      if (!walk.wanted[boundary.body[i]]) continue;
      const FloatBatch none(0.0f), h(boundary.reach[i]);
      SurfaceSum<FloatBatch> sum{{none, none, none}, none, none, none, beyond};
      Symmetric<FloatBatch> rate{none, none, none, none, none, none};
      const WallViscosity wall = wall_viscosity(boundary.viscosity[i]);
      const ParticleView<FloatBatch> self =
          broadcast(own, i, own_viscosity<viscosity>(wall, context.kinds.front().viscosity));
      const auto add_forces = [&](const auto& also) {
        add_row_forces<Parts, Parts::kOnBodies, viscosity>(self, fluid_columns, rows, h, shape, sum,
                                                           FloatBatch(wall.of_fluid), also);
      };
      if (viscosity != Viscosity::kNone && walk.drags) {
        add_forces([&](const ParticleView<FloatBatch>& p, FloatBatch reach, FloatBatch weight) {
          add_pair_viscosity_rate<typename Parts::ForceKernel, Parts::kDrag>(self, p, reach, shape, weight,
                                                                             rate);
        });
        walk.sums.drag_rate[i] = {scale * lane_sum(rate.xx), scale * lane_sum(rate.xy),
                                  scale * lane_sum(rate.xz), scale * lane_sum(rate.yy),
                                  scale * lane_sum(rate.yz), scale * lane_sum(rate.zz)};
      } else {
        add_forces(NothingBesides{});
      }
      if constexpr (Parts::kCorrected && viscosity != Viscosity::kNone) {
        if (!boundary.mirror.empty())
          add_forces_on_mirror<Parts, viscosity>(boundary, i, context.kinds.front().viscosity, fluid_columns,
                                                 rows, h, shape, sum);
      }
      walk.sums.force[i] = scale * glm::vec3(lane_sum(sum.x), lane_sum(sum.y), lane_sum(sum.z));
      walk.sums.couple[i] = scale * glm::vec3(lane_sum(sum.cx), lane_sum(sum.cy), lane_sum(sum.cz));
    }
  }
}

}  // namespace

void sum_body_wrenches(PassContext& context, ThreadTeam& team, const FluidParticles& fluid,
                       const BoundaryParticles& boundary, std::span<const glm::dvec3> centers,
                       const std::vector<char>& wanted, SurfaceSums& scratch, std::span<Wrench> wrenches,
                       std::span<BodyDrag> drags) {
  const std::vector<CellRun>& runs = boundary.index.runs();
  const std::size_t count = boundary.index.particles();
  if (count == 0) return;
  scratch.met.resize(runs.size());
  scratch.force.resize(count);
  scratch.couple.resize(count);
  if (!drags.empty()) scratch.drag_rate.resize(count);
  const SurfaceWalk walk{context, fluid, boundary, wanted, scratch, !drags.empty()};
  with_physics(context.plan, [&]<class Parts, Viscosity viscosity>() {
    team.run(runs.size(), kForceRunsPerChunk,
             [&](std::size_t begin, std::size_t end) { find_sums<Parts, viscosity>(walk, begin, end); });
  });
  // One fixed order (that of the cells), so that the sum does not depend on the threads.
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (!scratch.met[r]) continue;
    for (std::uint32_t i = runs[r].particles.begin; i < runs[r].particles.end; ++i) {
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
