// Eq 5, 6 and 9 on fluid particles.
#include "sim/passes/implicit_viscosity/cpu.h"

#include <algorithm>
#include <cstring>

#include "sim/cpu/passes.h"
#include "sim/cpu/state.h"
#include "sim/passes/pressure_force/pressure_loop.h"
#include "sim/passes/pressure_solve/cpu.h"
#include "sim/passes/walls/row_mirror.h"

namespace slosh {

namespace {

// What the passes over fluid particles go through.
struct FluidWalk {
  const PassContext& context;
  ThreadTeam& team;
  FluidParticles& fluid;
  const BoundaryParticles& fixed;
  const BoundaryParticles& moving;
  FluidPress& press;
};

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
    NearRows& near = walk.press.near[r];
    const ParticleRange own = runs[r].particles;
    if constexpr (!Parts::kCorrected) near.find(context.grid, fluid, runs[r], walk.fixed, walk.moving);
    std::fill(fluid.near_wall.begin() + own.begin, fluid.near_wall.begin() + own.end, near.around);
    if (Parts::kCorrected && (near.empty() || viscosity == Viscosity::kNone)) continue;
    RowList fluid_rows;
    if constexpr (!Parts::kCorrected) fluid_rows = fluid.index.rows(context.grid, runs[r].cell);
    for (std::uint32_t p = own.begin; p < own.end; ++p) {
      const ParticleView<FloatBatch> self =
          broadcast(fluid_columns, p, particle_viscosity(context, fluid, p));
      ForceSum<FloatBatch> sum{FloatBatch(0.0f), FloatBatch(0.0f), FloatBatch(0.0f)};
      if constexpr (!Parts::kCorrected)
        add_row_forces<Parts, Parts::kFluids, viscosity>(self, fluid_columns, fluid_rows, h, shape, sum);
      if (near.fixed.count)
        add_row_forces<Parts, kWalls, kAgainstBodies, Neighbours::kWalls>(self, fixed_columns, near.fixed, h,
                                                                          shape, sum);
      if (near.moving.count)
        add_row_forces<Parts, kWalls, kAgainstBodies, Neighbours::kWalls>(self, moving_columns, near.moving,
                                                                          h, shape, sum);
      if constexpr (Parts::kCorrected && viscosity != Viscosity::kNone) {
        if (!walk.fixed.mirror.empty() && near.fixed.count)
          add_mirror_forces<Parts>(self, walk.fixed, near.fixed, h, shape, sum);
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
  walk.team.run(walk.fluid.index.runs().size(), kForceRunsPerChunk, [&](std::size_t begin, std::size_t end) {
    find_forces_of<Parts, viscosity>(walk, begin, end);
  });
}

// By fluid, and what one's own pressure pushes by, walls among those that bear it. With pressure projection
// pressures push later. Pairs of one viscosity need u alone, but where fluid has a particle stress.
template <class Parts, Viscosity viscosity, bool stresses>
void forces_by_rows(const FluidWalk& walk) {
  const FluidPress& press = walk.press;
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
                          FluidViscosity& drag, FluidPress& press) {
  if (context.plan.has(PassId::kImplicitViscosity)) {
    compute_forces_by_rows(context, team, fluid, fixed, moving, dt, drag, press);
    return;
  }
  const FluidWalk walk{context, team, fluid, fixed, moving, press};
  if (press.near.size() < fluid.index.runs().size()) press.near.resize(fluid.index.runs().size());
  with_physics(context.plan, [&]<class Parts, Viscosity viscosity>() {
    if constexpr (Parts::kCorrected) {
      auto forces = forces_by_rows<Parts, viscosity, false>;
      if constexpr (viscosity != Viscosity::kNone) {
        if (context.plan.has(PassId::kFluidStress)) forces = forces_by_rows<Parts, viscosity, true>;
      }
      forces(walk);
    }
    find_forces<Parts, viscosity>(walk);
  });
}

namespace passes {

void pressure_force_on_cpu(CpuState& s, const PassInputs& in) {
  compute_fluid_forces(s.context, s.team, s.fluid, s.fixed.sorted(), s.moving.sorted(), in.dt,
                       s.memory<FluidViscosity>(PassId::kPressureForce), s.pairs);
  if (s.context.plan.has(PassId::kPressureSolve))
    s.memory<PressureSolver>(PassId::kPressureSolve)
        .push_by_last(s.context, s.team, {s.fluid, s.moving.sorted(), s.bodies, s.pairs});
}

}  // namespace passes

}  // namespace slosh
