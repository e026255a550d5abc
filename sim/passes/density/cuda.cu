// Eq 2 and 7 on the GPU; what is counted, and why, is in sim/passes/density/cpu.cpp.
#include "sim/cuda/rows.cuh"
#include "sim/model.h"
#include "sim/passes/fluid_stress/fluid_stress.h"
#include "sim/passes/pressure_solve/solved_state.h"
#include "sim/snapshot.h"
#include "sim/walls/wall_particles.h"

namespace slosh::cuda {

namespace {

// The published model's: bodies do not count.
template <class Team, class Parts>
__global__ __launch_bounds__(kThreads) void density_kernel(StepConstants c, const ParticleKind* kinds,
                                                           SortedFluid fluid, bool viscosities,
                                                           std::uint32_t* status) {
  wait_for_last_kernel();
  const std::uint32_t p = Team::particle();
  if (p >= fluid.count) return;
  const std::uint32_t cell = fluid.state.key[p];
  if (cell >= c.grid.retired_key()) return;
  const float4 x = fluid.state.x[p];
  using Kernel = typename Parts::DensityKernel;
  const Support<float> support{c.support_radius, c.support_radius * c.support_radius};
  const auto r_squared = [&](const float4& other) {
    const float dx = x.x - other.x;
    const float dy = x.y - other.y;
    const float dz = x.z - other.z;
    return dx * dx + dy * dy + dz * dz;
  };
  float sum = 0.0f;
  for_neighbors<Team>(c.grid, fluid.cells, cell, [&](std::uint32_t j) {
    sum += Kernel::shape(r_squared(__ldg(fluid.state.x + j)), support);
  });
  Team::sum(sum);
  if (Team::lane() != 0) return;
  const ParticleKind kind = kinds[fluid.state.kind[p]];
  const PressureState state = pressure_state(sum, c.rest_number_density, c.rest_volume, kind.pressing_density,
                                             c.stiffness, c.tension, fluid.state.v[p].w, false);
  fluid.pressed[p] = make_float4(x.x, x.y, x.z, state.pressure);
  fluid.state.v[p].w = state.volume;
  if (viscosities) fluid.viscosity[p] = particle_viscosity(fluid, kinds, p);
  if (state.compression > kTooCompressed) atomicOr(status, kStatusCompressed);
}

template <class Team>
__device__ void sum_over_team(Symmetric<float>& moment, FlowSums<float>& s) {
  Team::sum(moment, s.offset[0], s.offset[1], s.offset[2], s.slope[0], s.slope[1], s.slope[2]);
  Team::sum(s.carried[0][0], s.carried[0][1], s.carried[0][2], s.carried[1][0], s.carried[1][1],
            s.carried[1][2], s.carried[2][0], s.carried[2][1], s.carried[2][2]);
}

// The row of a particle with a viscous stress. `pressed`: its pressure tensor, N·m⁴; `u`: viscosity times
// velocity, Pa·m; `scale`: the force kernel's constant.
__device__ void keep_passed(const SortedFluid& fluid, std::uint32_t p, const Symmetric<float>& pressed,
                            const FluidStress& found, const float (&u)[3], float scale) {
  const Matrix3<float>& t = found.push;
  const float f = 1.0f / scale;
  fluid.passed_x[p] =
      make_float4(pressed.xx + f * t.x.x, pressed.xy + f * t.x.y, pressed.xz + f * t.x.z, u[0]);
  fluid.passed_y[p] =
      make_float4(pressed.xy + f * t.y.x, pressed.yy + f * t.y.y, pressed.yz + f * t.y.z, u[1]);
  fluid.passed_z[p] =
      make_float4(pressed.xz + f * t.z.x, pressed.yz + f * t.z.y, pressed.zz + f * t.z.z, u[2]);
  fluid.left[p] = found.left;
}

// The corrected model's and, `solved`, the incompressible one's: sim/passes/density/cpu_corrected.cpp.
// `flows`: artificial viscosity is needed, or `stresses`, the particle stress.
template <class Team, bool solved, bool flows, bool stresses>
__global__ __launch_bounds__(kThreads, kBlocksOfTensors) void corrected_density_kernel(
    StepConstants c, const ParticleKind* kinds, SortedFluid fluid, SortedSurface fixed, SortedSurface moving,
    bool one_viscosity, bool viscosities, std::uint32_t* status) {
  wait_for_last_kernel();
  using Kernel = ModelParts<ParticleModel::kCorrected>::DensityKernel;
  const std::uint32_t p = Team::particle();
  if (p >= fluid.count) return;
  const std::uint32_t cell = fluid.state.key[p];
  if (cell >= c.grid.retired_key()) return;
  const float4 x = fluid.state.x[p];
  const float h = c.support_radius;
  Neighborhood<float> sum{};
  FlowSums<float> flow{};
  __shared__ MarkedRow rows[kMarkedRows][kThreads];
  std::uint32_t found = 0;
  uint4* entry = fluid.near.of(thread_index());
  for_near<Team>(c, fluid, p, x, cell, rows, [&](const std::uint32_t(&near)[kListed]) {
    if (found < fluid.near.room) *entry = make_uint4(near[0], near[1], near[2], near[3]);
    entry += 32;
    found += kListed;
    for (const std::uint32_t j : near) {
      const float4 y = __ldg(fluid.state.x + j);
      const float dx = x.x - y.x;
      const float dy = x.y - y.y;
      const float dz = x.z - y.z;
      const float4 v = fluid.state.v[j];
      add_fluid_neighbor<Kernel>(dx, dy, dz, v.x, v.y, v.z, h, 1.0f, sum);
      if constexpr (flows) add_flow<Kernel>({dx, dy, dz}, {v.x, v.y, v.z}, h, flow);
    }
  });
  fluid.near.counts[thread_index()] = found;
  Symmetric<float> by_fluid = sum.moment;
  float no_slip = 0.0f;  // Σ d² (−W'/r) V of no-slip walls
  const auto add_walls = [&](const SortedSurface& walls) {
    if (walls.count == 0) return;
    for_neighbors<Team>(c.grid, walls.cells, cell, [&](std::uint32_t j) {
      const float4 wall = __ldg(walls.x + j);
      const float dx = x.x - wall.x;
      const float dy = x.y - wall.y;
      const float dz = x.z - wall.z;
      if (dx * dx + dy * dy + dz * dz >= h * h) return;
      const float reach = __ldg(walls.reach + j);
      add_wall_neighbor<Kernel>(dx, dy, dz, wall.w, c.correction.wall_layer * wall.w, reach, 1.0f, sum);
      if constexpr (stresses) {
        if (__ldg(walls.viscosity + j) == static_cast<float>(kFreeSlip)) return;
        const float r_squared = dx * dx + dy * dy + dz * dz;
        no_slip += __ldg(walls.v + j).w * r_squared * Kernel::pair(r_squared, reach, 1.0f).slope_over_r;
      }
    });
  };
  add_walls(fixed);
  add_walls(moving);
  Team::sum(sum.moment, sum.number, sum.fluid_number, sum.vx, sum.vy, sum.vz);
  if constexpr (flows) sum_over_team<Team>(by_fluid, flow);
  if constexpr (stresses) Team::sum(no_slip);
  if (Team::lane() != 0) return;
  const ParticleKind kind = kinds[fluid.state.kind[p]];
  const float4 motion = fluid.state.v[p];
  const float viscosity = particle_viscosity(fluid, kinds, p);
  const float in_u = one_viscosity ? viscosity : 0.0f;
  const float velocity[3] = {motion.x, motion.y, motion.z};
  const float rest = c.correction.rest_moment;
  FlowAround around;
  InverseMoment moment;
  if constexpr (flows) {
    around = flow_around(flow, velocity);
    moment = inverse_moment(by_fluid, rest);
    follow_flow(around, moment, rest, sum);
  }
  auto state = [&] {
    if constexpr (solved) {
      return solved_state(sum, c.correction, viscosity, in_u, velocity);
    } else {
      return corrected_state(sum, c.correction, kind.pressing_density, viscosity, in_u, motion.w,
                             velocity);
    }
  }();
  if constexpr (stresses) {
    const float number = sum.fluid_number - c.correction.own_number;
    const auto apart = [&](float v, float carried) {
      return number * v - (carried - c.correction.own_number * v);
    };
    const StressSums sums{
        around, number, {apart(motion.x, sum.vx), apart(motion.y, sum.vy), apart(motion.z, sum.vz)}};
    const FluidStress found = fluid_stress(sums, moment, share_of_stress(no_slip / c.rest_volume, rest), rest,
                                           state.volume, viscosity);
    state.u[0] += found.rest.x;
    state.u[1] += found.rest.y;
    state.u[2] += found.rest.z;
    keep_passed(fluid, p, solved ? Symmetric<float>{} : state.push, found, state.u, c.force_scale);
  }
  if constexpr (solved) fluid.expansion[p] = state.expansion;
  fluid.pressed[p] = make_float4(x.x, x.y, x.z, state.volume);
  fluid.push_a[p] = make_float4(state.push.xx, state.push.xy, state.push.xz, state.push.yy);
  fluid.push_b[p] = make_float4(state.push.yz, state.push.zz, state.u[0], state.u[1]);
  fluid.drag_z[p] = state.u[2];
  fluid.state.v[p].w = state.volume;  // nobody reads the w of others here
  if (viscosities) fluid.viscosity[p] = viscosity;
  if (state.compression > kTooCompressed) atomicOr(status, kStatusCompressed);
}

}  // namespace

void launch_density(const StepConstants& constants, const Plan& plan, const ParticleKind* kinds,
                    bool artificial, const SortedFluid& fluid, const SortedSurface& fixed,
                    const SortedSurface& moving, std::uint32_t* status, cudaStream_t stream) {
  const bool viscosities = plan.has(PassId::kPairViscosity);
  const bool one_viscosity =
      plan.has(PassId::kOneViscosity) && plan.explicit_viscosity() && !plan.has(PassId::kFluidStress);
  with_model(plan.model, [&]<class Parts>() {
    if constexpr (Parts::kCorrected) {
      with_team<kTensorTeams>(fluid.count, [&]<class Team>() {
        const auto kernel = plan.has(PassId::kFluidStress)
                                ? corrected_density_kernel<Team, Parts::kSolved, true, true>
                            : artificial ? corrected_density_kernel<Team, Parts::kSolved, true, false>
                                         : corrected_density_kernel<Team, Parts::kSolved, false, false>;
        launch_early(kernel, blocks_for(fluid.count * Team::kLanes), kThreads, stream, constants, kinds,
                     fluid, fixed, moving, one_viscosity, viscosities, status);
      });
    } else {
      with_team<kDensityTeams>(fluid.count, [&]<class Team>() {
        launch_early(density_kernel<Team, Parts>, blocks_for(fluid.count * Team::kLanes), kThreads, stream,
                     constants, kinds, fluid, viscosities, status);
      });
    }
  });
}

}  // namespace slosh::cuda
