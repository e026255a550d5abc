// Conjugate gradients over the particles that press, in one launch, as sim/passes/pressure_solve/cpu.cpp; how
// blocks wait for each other and decide alike is in viscous_iterations.cu; here a sum has a part a block.
// The parts of an iteration are not inlined: in one function 64 registers would not do for their loops.
#include <cooperative_groups.h>

#include <algorithm>

#include "sim/passes/pressure_solve/cuda_bodies.cuh"

namespace slosh::cuda {

namespace {

namespace cg = cooperative_groups;

// Pressures that are cut off below 0 are put right when they come to more than this share of what is left.
constexpr double kMaxClipped = 0.02;

// Calls f(e) for the entries that are this thread's.
template <class F>
__device__ void for_each(std::uint32_t entries, F&& f) {
  for (std::uint32_t e = blockIdx.x * kSolveThreads + threadIdx.x; e < entries;
       e += gridDim.x * kSolveThreads)
    f(e);
}

// The velocities that there would be by the last step's pressures.
__device__ void start_velocities(const Press& s) {
  const PressureView& view = s.view;
  const glm::vec3 g = s.c.gravity;
  for_each(view.fluid, [&](std::uint32_t p) {
    float4 u = make_float4(0.0f, 0.0f, 0.0f, 0.0f);
    if (s.fluid.state.key[p] < s.c.grid.retired_key()) {
      const ParticleKind& kind = s.kinds[s.fluid.state.kind[p]];
      const float4 v = s.fluid.state.v[p], f = s.fluid.force[p];
      const float per_mass = kind.probe ? 0.0f : 1.0f / kind.mass;
      u = kind.probe ? make_float4(v.x, v.y, v.z, 0.0f)
                     : make_float4(v.x + s.dt * (per_mass * f.x + g.x), v.y + s.dt * (per_mass * f.y + g.y),
                                   v.z + s.dt * (per_mass * f.z + g.z), per_mass);
    }
    view.velocity[p] = u;
  });
  for (std::uint32_t b = blockIdx.x; b < view.bodies; b += gridDim.x) {
    if (threadIdx.x != 0) continue;
    const ViscousBody& body = view.body[b].body;
    PressedUnknown& u = view.unknown[b];
    u.factor = Matrix6{};
    u.twist = Vector6{};
    if (body.moves && cholesky(body.inertia, u.factor)) u.twist = cholesky_solve(u.factor, body.momentum);
  }
}

// What is left; a thread's share of the sums, or the whole.
struct Left {
  double step = 0.0, turned = 0.0, clipped = 0.0, squares = 0.0, pressing = 0.0;
};
__device__ float residual(float pressure, float flow) {
  return pressure > 0.0f || flow < 0.0f ? -flow : 0.0f;
}
// Adds p's; `before`: its residual of the iteration before. The next direction gets to know of it.
__device__ void look_at(const PressureView& view, std::uint32_t p, float pressure, float flow, float clipped,
                        float direction, float before, Left& left) {
  const auto [inverse, unit] = view.scale[p];
  const bool presses = pressure > 0.0f || flow < 0.0f;
  const float r = residual(pressure, flow), z = inverse * r;
  left.step += static_cast<double>(z) * r;
  left.turned += static_cast<double>(z) * before;
  left.squares += static_cast<double>(r) * r;
  left.pressing += presses;
  if (clipped > 0.0f) left.clipped += static_cast<double>(clipped) * clipped / inverse;
  view.pressing[p] = make_float2(unit * z, presses ? unit * direction : 0.0f);
}
__device__ void write_parts(const PressureView& view, const Left& left) {
  double sums[5] = {left.step, left.turned, left.clipped, left.squares, left.pressing};
  sum_block(sums);
  if (threadIdx.x != 0) return;
  view.parts.step[blockIdx.x] = sums[0];
  view.parts.turned[blockIdx.x] = sums[1];
  view.parts.clipped[blockIdx.x] = sums[2];
  view.parts.squares[blockIdx.x] = sums[3];
  view.parts.pressing[blockIdx.x] = sums[4];
}
__device__ Left whole(const PressureView& view) {
  double sums[5] = {part_of(view.parts.step, gridDim.x), part_of(view.parts.turned, gridDim.x),
                    part_of(view.parts.clipped, gridDim.x), part_of(view.parts.squares, gridDim.x),
                    part_of(view.parts.pressing, gridDim.x)};
  sum_block(sums);
  return {sums[0], sums[1], sums[2], sums[3], sums[4]};
}

template <class Team>
__device__ __noinline__ void start_flows(const Press& s) {
  const PressureView& view = s.view;
  const float wanted = s.c.rest_volume / s.density_time;
  Left left;
  for_each(view.fluid * Team::kLanes, [&](std::uint32_t thread) {
    const std::uint32_t p = thread / Team::kLanes;
    const bool there = s.fluid.state.key[p] < s.c.grid.retired_key();
    float flow = there ? flow_of<Team>(s, thread) : 0.0f;
    if (Team::lane() != 0) return;
    double diagonal = 0.0;
    if (there) {
      const float4 own = view.own[p];
      const float squared = own.w * own.w * dot(vec3(own), vec3(own));
      diagonal = static_cast<double>(s.dt * (squared * view.velocity[p].w + view.scale[p].x));
      if (view.bodies) diagonal += static_cast<double>(s.dt) * diagonal_by_bodies(s, p);
      flow -= wanted * s.fluid.expansion[p];
    }
    const float pressure = diagonal > 0.0 ? s.fluid.state.solved[p] : 0.0f;
    view.scale[p].x = diagonal > 0.0 ? static_cast<float>(1.0 / diagonal) : 0.0f;
    view.flow[p] = flow;
    view.pressure[p] = pressure;
    view.clipped[p] = 0.0f;
    look_at(view, p, pressure, flow, 0.0f, 0.0f, 0.0f, left);
  });
  write_parts(view, left);
}

__device__ __noinline__ void push_bodies(const Press& s) {
  for_each_pressed_body(s, [&](std::uint32_t b, const Vector6& on_body) {
    Vector6 impulse = on_body;
    for (double& part : impulse) part *= static_cast<double>(s.dt);
    PressedUnknown& u = s.view.unknown[b];
    u.twist = s.view.body[b].body.moves ? cholesky_solve(u.factor, impulse) : Vector6{};
  });
}

// direction = preconditioned residual + keep · direction, of those that press; velocity and twists: what the
// direction, as pressures, changes them by over the sub-step.
template <class Team>
__device__ __noinline__ void push(const Press& s, float keep, const cg::grid_group& grid) {
  const PressureView& view = s.view;
  const std::uint32_t on_fluid = view.fluid * Team::kLanes;
  for_each(on_fluid + view.surface, [&](std::uint32_t e) {
    if (e >= on_fluid) return push_on_surface(s, e - on_fluid, keep);
    const std::uint32_t p = e / Team::kLanes;
    const float4 own = view.own[p];
    const float3 f = push_on_fluid<Team>(s, e, own, keep);
    if (Team::lane() != 0) return;
    const float per_mass = view.velocity[p].w, by = s.dt * per_mass;
    view.velocity[p] = make_float4(by * f.x, by * f.y, by * f.z, per_mass);
    view.direction[p] = inverse_of(own.w) * pressing(view.pressing[p], keep);
  });
  grid.sync();
  if (view.bodies == 0) return;
  push_bodies(s);
  grid.sync();
}

// product = system · direction, after push().
template <class Team>
__device__ __noinline__ void multiply(const Press& s) {
  const PressureView& view = s.view;
  double sum[1] = {};
  for_each(view.fluid * Team::kLanes, [&](std::uint32_t thread) {
    const float flow = flow_of<Team>(s, thread);
    if (Team::lane() != 0) return;
    const std::uint32_t p = thread / Team::kLanes;
    view.product[p] = flow;
    sum[0] += static_cast<double>(view.direction[p]) * flow;
  });
  sum_block(sum);
  if (threadIdx.x == 0) view.parts.curvature[blockIdx.x] = sum[0];
}

// One iteration's step along the direction, no pressure below 0, and what is left.
__device__ __noinline__ void advance(const PressureView& view, float length) {
  Left left;
  for_each(view.fluid, [&](std::uint32_t p) {
    const float pressure = view.pressure[p], flow = view.flow[p], direction = view.direction[p];
    const float to = pressure + length * direction, kept = to > 0.0f ? to : 0.0f;
    const float clipped = view.clipped[p] + (kept - to), then = flow + length * view.product[p];
    view.pressure[p] = kept;
    view.flow[p] = then;
    if (kept != to) view.clipped[p] = clipped;
    look_at(view, p, kept, then, clipped, direction, residual(pressure, flow), left);
  });
  write_parts(view, left);
}

// The flows get to know of what was cut off.
template <class Team>
__device__ __noinline__ void undo_clips(const Press& s, const cg::grid_group& grid) {
  const PressureView& view = s.view;
  for_each(view.fluid,
           [&](std::uint32_t p) { view.pressing[p] = make_float2(view.scale[p].y * view.clipped[p], 0.0f); });
  grid.sync();
  push<Team>(s, 0.0f, grid);
  Left left;
  for_each(view.fluid * Team::kLanes, [&](std::uint32_t thread) {
    const float more = flow_of<Team>(s, thread);
    if (Team::lane() != 0) return;
    const std::uint32_t p = thread / Team::kLanes;
    const float flow = view.flow[p] + more;
    view.flow[p] = flow;
    view.clipped[p] = 0.0f;
    look_at(view, p, view.pressure[p], flow, 0.0f, 0.0f, 0.0f, left);
  });
  write_parts(view, left);
  grid.sync();
}

template <class Team>
__device__ __noinline__ void finish(const Press& s, const cg::grid_group& grid) {
  const PressureView& view = s.view;
  for_each(view.fluid, [&](std::uint32_t p) {
    const float more = view.pressure[p] - s.fluid.state.solved[p];
    view.pressing[p] = make_float2(view.scale[p].y * more, 0.0f);
  });
  grid.sync();
  const std::uint32_t on_fluid = view.fluid * Team::kLanes;
  for_each(on_fluid + view.surface, [&](std::uint32_t e) {
    if (e >= on_fluid) return push_on_surface(s, e - on_fluid, 0.0f);
    const std::uint32_t p = e / Team::kLanes;
    const float3 f = push_on_fluid<Team>(s, e, view.own[p], 0.0f);
    if (Team::lane() != 0) return;
    add_force(s.fluid, p, f);
    s.fluid.state.solved[p] = view.pressure[p];
    if (view.probes && s.fluid.state.id[p] >= view.first_probe)
      view.probes[s.fluid.state.id[p] - view.first_probe] = s.fluid.force[p];
  });
  if (view.bodies == 0) return;
  grid.sync();
  for_each_pressed_body(s, [&](std::uint32_t b, const Vector6& w) {
    view.wrenches[b] = {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
  });
}

template <class Team>
__global__ __launch_bounds__(kSolveThreads, 4) void press_kernel(const __grid_constant__ Press s) {
  const cg::grid_group grid = cg::this_grid();
  const PressureView& view = s.view;
  const double per_flow = static_cast<double>(s.dt) / static_cast<double>(s.c.rest_volume);
  const auto left = [&](const Left& sums) {
    return per_flow * sqrt(sums.squares / (sums.pressing > 1.0 ? sums.pressing : 1.0));
  };
  start_velocities(s);
  grid.sync();
  start_flows<Team>(s);
  grid.sync();
  Left now = whole(view);
  const double share = kPressureTolerance * left(now);
  const double enough = share > kPressureFloor ? share : kPressureFloor;
  double keep = 0.0;
  for (int iterations = 0; iterations < kMaxPressureIterations && now.step > 0.0 && left(now) > enough;
       ++iterations) {
    const double before = now.step;
    push<Team>(s, static_cast<float>(keep), grid);
    multiply<Team>(s);
    grid.sync();
    double curvature[1] = {part_of(view.parts.curvature, gridDim.x)};
    sum_block(curvature);
    if (!(curvature[0] > 0.0)) break;
    advance(view, static_cast<float>(before / curvature[0]));
    grid.sync();
    now = whole(view);
    keep = (now.step - now.turned) / before;
    if (!(keep > 0.0)) keep = 0.0;
    if (now.clipped > kMaxClipped * now.step && iterations + 2 < kMaxPressureIterations) {
      undo_clips<Team>(s, grid);
      ++iterations;
      now = whole(view);
      keep = 0.0;
    }
  }
  finish<Team>(s, grid);
}

template <class Team>
cudaError_t launch_solve(Press solve, std::uint32_t blocks, cudaStream_t stream) {
  void* arguments[] = {&solve};
  const unsigned grid =
      std::min(blocks, blocks_for(solve.view.fluid * Team::kLanes + solve.view.surface, kSolveThreads));
  return cudaLaunchCooperativeKernel(reinterpret_cast<const void*>(press_kernel<Team>), dim3(grid),
                                     dim3(kSolveThreads), arguments, 0, stream);
}

}  // namespace

cudaError_t most_pressure_blocks(std::uint32_t fluid, int& blocks) {
  int device = 0, multiprocessors = 0, each = 0;
  cudaError_t code = cudaGetDevice(&device);
  if (code == cudaSuccess)
    code = cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device);
  with_team<kTensorTeams>(fluid, [&]<class Team>() {
    if (code == cudaSuccess)
      code = cudaOccupancyMaxActiveBlocksPerMultiprocessor(
          &each, reinterpret_cast<const void*>(press_kernel<Team>), kSolveThreads, 0);
  });
  blocks = each * multiprocessors;
  return code == cudaSuccess && blocks <= 0 ? cudaErrorCooperativeLaunchTooLarge : code;
}

cudaError_t launch_pressure_solve(const StepConstants& constants, const ParticleKind* kinds, float dt,
                                  float density_time, const SortedFluid& fluid, const SortedSurface& moving,
                                  const LocalSurface& local, const PressureView& view, int blocks,
                                  cudaStream_t stream) {
  const Press solve{constants, kinds, dt, density_time, fluid, moving, local, view};
  cudaError_t code = cudaSuccess;
  with_team<kTensorTeams>(view.fluid, [&]<class Team>() {
    code = launch_solve<Team>(solve, static_cast<std::uint32_t>(blocks), stream);
  });
  return code;
}

}  // namespace slosh::cuda
