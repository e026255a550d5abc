// Eq 5, 6 and 9 on fluid particles, and Eq 10–12 on bodies.
#include <algorithm>
#include <cstring>

#include "sim/cpu/passes.h"
#include "sim/cpu/pressure_loop.h"
#include "sim/cpu/row_force.h"
#include "sim/cpu/row_mirror.h"

namespace slosh {

namespace {

constexpr std::size_t kRunsPerChunk = 16;

// What the passes over fluid particles go through.
struct FluidWalk {
  const PassContext& context;
  ThreadTeam& team;
  FluidParticles& fluid;
  const BoundaryParticles& fixed;
  const BoundaryParticles& moving;
};

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

// One chunk of runs. All of a pair in one loop: left to itself the compiler calls functions and hands batches
// over in memory. For the models that go by rows (forces_by_rows) only the viscous force of walls is left.
template <class Parts, Viscosity viscosity>
__attribute__((flatten)) void find_forces_of(const FluidWalk& walk, std::size_t begin, std::size_t end) {
  // Body particles have viscosities of their own, so against them Eq 9 holds even where one fluid has Eq 6.
  constexpr Viscosity kAgainstBodies = viscosity == Viscosity::kNone ? Viscosity::kNone : Viscosity::kPair;
  constexpr PairRule kWalls = Parts::kCorrected ? PairRule::kSolvedWall : Parts::kWalls;
  const PassContext& context = walk.context;
  FluidParticles& fluid = walk.fluid;
  const std::vector<CellRun>& runs = fluid.index.runs();
  const NeighborColumns fluid_columns = columns(fluid);
  const NeighborColumns fixed_columns = columns(walk.fixed);
  const NeighborColumns moving_columns = columns(walk.moving);
  const FloatBatch h(context.support_radius);
  const DragShape<FloatBatch> shape = in_all_lanes(context.drag_shape);
  for (std::size_t r = begin; r < end; ++r) {
    const RowList fixed_rows = walk.fixed.index.rows(context.grid, runs[r].cell);
    const RowList moving_rows = walk.moving.index.rows(context.grid, runs[r].cell);
    const bool near_wall = fixed_rows.count + moving_rows.count > 0;
    const ParticleRange own = runs[r].particles;
    std::fill(fluid.near_wall.begin() + own.begin, fluid.near_wall.begin() + own.end, near_wall);
    if (Parts::kCorrected && (!near_wall || viscosity == Viscosity::kNone)) continue;
    RowList fluid_rows;
    if constexpr (!Parts::kCorrected) fluid_rows = fluid.index.rows(context.grid, runs[r].cell);
    for (std::uint32_t p = own.begin; p < own.end; ++p) {
      const ParticleView<FloatBatch> self =
          broadcast(fluid_columns, p, context.kinds[fluid.kind[p]].viscosity);
      ForceSum<FloatBatch> sum{FloatBatch(0.0f), FloatBatch(0.0f), FloatBatch(0.0f)};
      if constexpr (!Parts::kCorrected)
        add_row_forces<Parts, Parts::kFluids, viscosity>(self, fluid_columns, fluid_rows, h, shape, sum);
      if (fixed_rows.count)
        add_row_forces<Parts, kWalls, kAgainstBodies, Neighbours::kWalls>(self, fixed_columns, fixed_rows, h,
                                                                          shape, sum);
      if (moving_rows.count)
        add_row_forces<Parts, kWalls, kAgainstBodies, Neighbours::kWalls>(self, moving_columns, moving_rows,
                                                                          h, shape, sum);
      if constexpr (Parts::kCorrected && viscosity != Viscosity::kNone) {
        if (!walk.fixed.mirror.empty() && fixed_rows.count)
          add_mirror_forces<Parts>(self, walk.fixed, fixed_rows, h, shape, sum);
      }
      const float scale = context.force_scale;
      const auto put = [](float& force, float found) { force = Parts::kCorrected ? force + found : found; };
      put(fluid.fx[p], scale * lane_sum(sum.x));
      put(fluid.fy[p], scale * lane_sum(sum.y));
      put(fluid.fz[p], scale * lane_sum(sum.z));
    }
  }
}

template <class Parts, Viscosity viscosity>
void find_forces(const FluidWalk& walk) {
  walk.team.run(walk.fluid.index.runs().size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
    find_forces_of<Parts, viscosity>(walk, begin, end);
  });
}

// By fluid, and what one's own pressure pushes by, walls among those that bear it. With pressure projection
// pressures push later. Pairs of one viscosity need u alone, but where fluid has a particle stress.
template <class Parts, Viscosity viscosity, bool stresses>
void forces_by_rows(const FluidWalk& walk, const FluidPress& press) {
  constexpr bool kPresses = !Parts::kSolved;
  FluidParticles& fluid = walk.fluid;
  const float h = walk.context.support_radius, scale = kCentralDrag * walk.context.force_scale;
  walk.team.run(press.rows.chunks(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      press.rows.for_each_group(chunk, [&](const PairRows::Walk& rows) {
        const DragShape<float>& drag = walk.context.drag_shape;
        GroupForces forces;
        if constexpr (stresses) {
          forces = walk_passed(press, rows, h, drag);
        } else {
          forces = walk_forces < kPresses, true,
          viscosity == Viscosity::kPair > (press, rows, h, drag, [](const auto&...) {});
        }
        float pressed[16], dragged[16];
        std::memcpy(pressed, &forces.pressed, sizeof pressed);
        std::memcpy(dragged, &forces.dragged, sizeof dragged);
        for (std::uint32_t a = 0; a < rows.count; ++a) {
          const std::uint32_t p = rows.first + a;
          const float factor = scale * fluid.volume[p];
          const auto force = [&](float own, std::uint32_t k) {
            return (kPresses || stresses ? own + pressed[4 * a + k] : 0.0f) + factor * dragged[4 * a + k];
          };
          Vector4 own = kPresses ? press.own[p] : Vector4{};
          if constexpr (stresses) {
            const Vector4& by_stress = press.own_stress[p];
            own = {own.x + by_stress.x, own.y + by_stress.y, own.z + by_stress.z, 0.0f};
          }
          fluid.fx[p] = force(own.x, 0);
          fluid.fy[p] = force(own.y, 1);
          fluid.fz[p] = force(own.z, 2);
        }
      });
    }
  });
}

}  // namespace

void compute_fluid_forces(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                          const BoundaryParticles& fixed, const BoundaryParticles& moving, double dt,
                          FluidViscosity& drag, const FluidPress& press) {
  if (context.plan.has(PassId::kImplicitViscosity)) {
    compute_forces_by_rows(context, team, fluid, fixed, moving, dt, drag, press);
    return;
  }
  const FluidWalk walk{context, team, fluid, fixed, moving};
  with_physics(context.plan, [&]<class Parts, Viscosity viscosity>() {
    if constexpr (Parts::kCorrected) {
      auto forces = forces_by_rows<Parts, viscosity, false>;
      if constexpr (viscosity != Viscosity::kNone) {
        if (context.plan.has(PassId::kFluidStress)) forces = forces_by_rows<Parts, viscosity, true>;
      }
      forces(walk, press);
    }
    find_forces<Parts, viscosity>(walk);
  });
}

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
    team.run(runs.size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
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

void drag_fluid(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                const BoundaryParticles& moving) {
  const std::vector<CellRun>& runs = fluid.index.runs();
  const NeighborColumns fluid_columns = columns(fluid);
  const NeighborColumns moving_columns = columns(moving);
  const FloatBatch h(context.support_radius);
  const DragShape<FloatBatch> shape = in_all_lanes(context.drag_shape);
  with_model(context.plan.model, [&]<class Parts>() {
    team.run(runs.size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t r = begin; r < end; ++r) {
        const RowList rows = moving.index.rows(context.grid, runs[r].cell);
        if (!rows.count) continue;
        for (std::uint32_t p = runs[r].particles.begin; p < runs[r].particles.end; ++p) {
          const ParticleView<FloatBatch> self =
              broadcast(fluid_columns, p, context.kinds[fluid.kind[p]].viscosity);
          ForceSum<FloatBatch> sum{FloatBatch(0.0f), FloatBatch(0.0f), FloatBatch(0.0f)};
          for_each_dragged<Viscosity::kPair, Neighbours::kWalls>(
              self, moving_columns, rows, h, FloatBatch(1.0f),
              [&](const ParticleView<FloatBatch>& i, FloatBatch reach, FloatBatch weight) {
                add_pair_viscosity<typename Parts::ForceKernel, Parts::kDrag>(self, i, reach, shape, weight,
                                                                              sum);
              });
          const float scale = context.force_scale;
          fluid.fx[p] += scale * lane_sum(sum.x);
          fluid.fy[p] += scale * lane_sum(sum.y);
          fluid.fz[p] += scale * lane_sum(sum.z);
        }
      }
    });
  });
}

}  // namespace slosh
