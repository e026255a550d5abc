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
  std::span<const glm::dvec3> centers;
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
  std::vector<SurfaceSums::Part>& found = walk.sums.of_chunk[begin / kForceRunsPerChunk];
  found.clear();
  const auto part_of = [&](int body) -> SurfaceSums::Part& {
    std::size_t at = 0;
    while (at < found.size() && found[at].body != body) ++at;
    if (at == found.size()) found.push_back({body, {}, {}});
    return found[at];
  };
  for (std::size_t r = begin; r < end; ++r) {
    RowList rows = walk.fluid.index.rows(context.grid, runs[r].cell);
    const ParticleRange range = runs[r].particles;
    float h_most = 0.0f;  // of those that are wanted
    for (std::uint32_t i = range.begin; i < range.end && rows.count > 0; ++i) {
      if (walk.wanted[boundary.body[i]]) h_most = std::max(h_most, boundary.reach[i]);
    }
    if (rows.count > 0) rows = CellBox(own, range).in_reach(fluid_columns, rows, h_most);
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
      const bool drags = viscosity != Viscosity::kNone && walk.drags;
      if (drags) {
        add_forces([&](const ParticleView<FloatBatch>& p, FloatBatch reach, FloatBatch weight) {
          add_pair_viscosity_rate<typename Parts::ForceKernel, Parts::kDrag>(self, p, reach, shape, weight,
                                                                             rate);
        });
      } else {
        add_forces(NothingBesides{});
      }
      if constexpr (Parts::kCorrected && viscosity != Viscosity::kNone) {
        if (!boundary.mirror.empty())
          add_forces_on_mirror<Parts, viscosity>(boundary, i, context.kinds.front().viscosity, fluid_columns,
                                                 rows, h, shape, sum);
      }
      SurfaceSums::Part& part = part_of(boundary.body[i]);
      const glm::dvec3 force(scale * glm::vec3(lane_sum(sum.x), lane_sum(sum.y), lane_sum(sum.z)));
      const glm::dvec3 couple(scale * glm::vec3(lane_sum(sum.cx), lane_sum(sum.cy), lane_sum(sum.cz)));
      const glm::dvec3 arm =
          glm::dvec3(boundary.x[i], boundary.y[i], boundary.z[i]) - walk.centers[boundary.body[i]];
      part.wrench = part.wrench + Wrench{force, glm::cross(arm, force) + couple};
      if (!drags) continue;
      const auto of = [&](const FloatBatch& of_rate) {
        return static_cast<double>(scale * lane_sum(of_rate));
      };
      part.drag.add({of(rate.xx), of(rate.xy), of(rate.xz), of(rate.yy), of(rate.yz), of(rate.zz)}, arm);
    }
  }
}

}  // namespace

void sum_body_wrenches(PassContext& context, ThreadTeam& team, const FluidParticles& fluid,
                       const BoundaryParticles& boundary, std::span<const glm::dvec3> centers,
                       const std::vector<char>& wanted, SurfaceSums& scratch, std::span<Wrench> wrenches,
                       std::span<BodyDrag> drags) {
  const std::vector<CellRun>& runs = boundary.index.runs();
  if (runs.empty()) return;
  scratch.of_chunk.resize(chunk_count(runs.size(), kForceRunsPerChunk));
  const SurfaceWalk walk{context, fluid, boundary, centers, wanted, scratch, !drags.empty()};
  with_physics(context.plan, [&]<class Parts, Viscosity viscosity>() {
    team.run(runs.size(), kForceRunsPerChunk,
             [&](std::size_t begin, std::size_t end) { find_sums<Parts, viscosity>(walk, begin, end); });
  });
  // One fixed order (that of the cells), so that the sum does not depend on the threads.
  for (const std::vector<SurfaceSums::Part>& parts : scratch.of_chunk) {
    for (const auto& [body, wrench, drag] : parts) {
      wrenches[body] = wrenches[body] + wrench;
      for (int k = 0; k < BodyDrag::kSize && !drags.empty(); ++k) drags[body].upper[k] += drag.upper[k];
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
