// Eq 5, 6 and 9 on fluid particles.
#include "sim/passes/walls/pair_mirrors.cuh"

namespace slosh::cuda {

namespace {

// Of fluid by fluid with particle stresses: as add_forces(), with pressure and stress as one tensor, and Eq 9
// by what viscosity is left.
template <class Team, class Parts>
__device__ void add_passed_forces(const StepConstants& c, ParticleView<float> p, std::uint32_t self,
                                  const NeighborColumns& n, const ListWalk<Team, 2>& walk,
                                  ForceSum<float>& sum) {
  using Kernel = typename Parts::ForceKernel;
  const float h = c.support_radius;
  const Matrix3<float> own = read_passed(n, self, p);
  const Vector3<float> own_u{p.ux, p.uy, p.uz};
  p.ux = p.uy = p.uz = 0.0f;  // pairs need only the difference
  Vector3<float> slope{};     // Σ d (−W'/r)
  walk([&](std::uint32_t j) {
    const float4 x = __ldg(n.x + j);
    const float dx = p.x - x.x, dy = p.y - x.y, dz = p.z - x.z;
    ParticleView<float> i;
    const Matrix3<float> by = read_passed(n, j, i);
    i.x = x.x;
    i.y = x.y;
    i.z = x.z;
    i.volume = x.w;
    i.ux -= own_u.x;
    i.uy -= own_u.y;
    i.uz -= own_u.z;
    const float left = 0.5f * (p.viscosity + i.viscosity);
    if (left > 0.0f) {  // not far from walls, where velocities are not fetched
      const float4 v = __ldg(n.v + j);
      i.ux += left * (v.x - p.vx);
      i.uy += left * (v.y - p.vy);
      i.uz += left * (v.z - p.vz);
    }
    add_pair_force<Kernel, PairRule::kSolved, Parts::kDrag, false>(p, i, h, c.drag_shape, 1.0f, sum);
    const float weight = Kernel::pair(dx * dx + dy * dy + dz * dz, h, 1.0f).slope_over_r;
    const float gx = weight * dx, gy = weight * dy, gz = weight * dz;
    const Vector3<float> pushed = times(by, gx, gy, gz);
    sum.x += pushed.x;
    sum.y += pushed.y;
    sum.z += pushed.z;
    slope.x += gx;
    slope.y += gy;
    slope.z += gz;
  });
  const Vector3<float> pushed = times(own, slope.x, slope.y, slope.z);  // by the thread's share of them
  sum.x += pushed.x;
  sum.y += pushed.y;
  sum.z += pushed.z;
}

template <class Team, class Parts, Viscosity viscosity, bool stresses>
__global__ __launch_bounds__(kThreads, stresses ? kBlocksOfTensors
                                                : 0) void force_kernel(StepConstants c,
                                                                       const ParticleKind* kinds,
                                                                       SortedFluid fluid, SortedSurface fixed,
                                                                       SortedSurface moving) {
  wait_for_last_kernel();
  const std::uint32_t p = Team::particle();
  if (p >= fluid.count) return;
  const std::uint32_t cell = fluid.state.key[p];
  if (cell >= c.grid.retired_key()) return;
  // Body particles have viscosities of their own, so against them Eq 9 holds even where one fluid has Eq 6.
  constexpr Viscosity kAgainstBodies = viscosity == Viscosity::kNone ? Viscosity::kNone : Viscosity::kPair;
  ParticleView<float> self = view(fluid.pressed[p], fluid.state.v[p], particle_viscosity(fluid, kinds, p));
  if constexpr (Parts::kCorrected) read_corrected(columns(fluid), p, self);
  ForceSum<float> sum{0.0f, 0.0f, 0.0f};
  if constexpr (stresses) {
    add_passed_forces<Team, Parts>(c, self, p, columns(fluid), ListWalk<Team, 2>{c.grid, fluid, cell}, sum);
  } else {
    using Walk = std::conditional_t<Parts::kCorrected, ListWalk<Team>, CellWalk<Team>>;
    const Walk walk = [&]() -> Walk {
      if constexpr (Parts::kCorrected) {
        return {c.grid, fluid, cell};
      } else {
        return {c.grid, fluid.cells, cell};
      }
    }();
    add_forces<Team, Parts, Parts::kFluids, viscosity>(c, self, columns(fluid), walk, c.support_radius, sum);
  }
  if (fixed.count) {
    add_forces<Team, Parts, Parts::kWalls, kAgainstBodies, Neighbours::kWalls>(
        c, self, columns(fixed), CellWalk<Team>{c.grid, fixed.cells, cell}, c.support_radius, sum);
  }
  if (moving.count) {
    add_forces<Team, Parts, Parts::kWalls, kAgainstBodies, Neighbours::kWalls>(
        c, self, columns(moving), CellWalk<Team>{c.grid, moving.cells, cell}, c.support_radius, sum);
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
      auto kernel = force_kernel<Team, Parts, viscosity, false>;
      if constexpr (Parts::kCorrected && viscosity != Viscosity::kNone) {
        if (plan.has(PassId::kFluidStress)) kernel = force_kernel<Team, Parts, viscosity, true>;
      }
      launch_early(kernel, blocks_for(fluid.count * Team::kLanes), kThreads, stream, constants, kinds, fluid,
                   fixed, moving);
    });
  });
}

}  // namespace slosh::cuda
