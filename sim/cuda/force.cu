// Eq 5, 6 and 9 on fluid particles.
#include "sim/cuda/pair_mirrors.cuh"

namespace slosh::cuda {

namespace {

template <class Team, class Parts, Viscosity viscosity>
__global__ __launch_bounds__(kThreads) void force_kernel(StepConstants c, const ParticleKind* kinds,
                                                         SortedFluid fluid, SortedSurface fixed,
                                                         SortedSurface moving) {
  const std::uint32_t p = Team::particle();
  if (p >= fluid.count) return;
  const std::uint32_t cell = fluid.state.key[p];
  if (cell >= c.grid.retired_key()) return;
  // Body particles have viscosities of their own, so against them Eq 9 holds even where one fluid has Eq 6.
  constexpr Viscosity kAgainstBodies = viscosity == Viscosity::kNone ? Viscosity::kNone : Viscosity::kPair;
  ParticleView<float> self = view(fluid.pressed[p], fluid.state.v[p], kinds[fluid.state.kind[p]].viscosity);
  if constexpr (Parts::kCorrected) read_corrected(columns(fluid), p, self);
  ForceSum<float> sum{0.0f, 0.0f, 0.0f};
  add_forces<Team, Parts, Parts::kFluids, viscosity>(c, self, columns(fluid), fluid.cells, cell, c.support_radius, sum);
  if (fixed.count) {
    add_forces<Team, Parts, Parts::kWalls, kAgainstBodies, Neighbours::kWalls>(
        c, self, columns(fixed), fixed.cells, cell, c.support_radius, sum);
  }
  if (moving.count) {
    add_forces<Team, Parts, Parts::kWalls, kAgainstBodies, Neighbours::kWalls>(
        c, self, columns(moving), moving.cells, cell, c.support_radius, sum);
  }
  if constexpr (Parts::kCorrected && viscosity != Viscosity::kNone) {
    if (fixed.mirror.normal) add_mirror_forces<Team, Parts>(c, self, fixed, cell, sum);
  }
  Team::sum(sum.x, sum.y, sum.z);
  if (Team::lane() != 0) return;
  const bool near_wall = (fixed.count && any_near(c.grid, fixed.cells, cell)) ||
                         (moving.count && any_near(c.grid, moving.cells, cell));
  fluid.force[p] = make_float4(c.force_scale * sum.x, c.force_scale * sum.y, c.force_scale * sum.z,
                               near_wall ? 1.0f : 0.0f);
}

}  // namespace

void launch_force(const StepConstants& constants, const Plan& plan, const ParticleKind* kinds,
                  const SortedFluid& fluid, const SortedSurface& fixed, const SortedSurface& moving,
                  cudaStream_t stream) {
  with_physics(plan, [&]<class Parts, Viscosity viscosity>() {
    with_team<Parts::kCorrected ? kTensorTeams : kForceTeams>(fluid.count, [&]<class Team>() {
      force_kernel<Team, Parts, viscosity><<<blocks_for(fluid.count * Team::kLanes), kThreads, 0, stream>>>(
          constants, kinds, fluid, fixed, moving);
    });
  });
}

}  // namespace slosh::cuda
