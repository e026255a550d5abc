// Conjugate gradients over the particles that press, in one launch, as sim/passes/pressure_solve/cpu.cpp; how
// blocks wait for each other and decide alike is in viscous_iterations.cu.
#include <cooperative_groups.h>

#include "sim/passes/pressure_solve/cuda_bodies.cuh"

namespace slosh::cuda {

namespace {

namespace cg = cooperative_groups;

// Pressures that are cut off below 0 are put right when they come to more than this share of what is left.
constexpr double kMaxClipped = 0.02;

__device__ std::uint32_t groups_of(std::uint32_t entries) {
  return (entries + kSolveThreads - 1) / kSolveThreads;
}

// Calls f(e, g) for this thread's entry of each group g of entries that is this block's; e may lie behind the
// last one.
template <class F>
__device__ void for_each_group(std::uint32_t entries, F&& f) {
  const std::uint32_t groups = groups_of(entries);
  for (std::uint32_t g = blockIdx.x; g < groups; g += gridDim.x) f(g * kSolveThreads + threadIdx.x, g);
}

// The velocities that there would be by the last step's pressures.
__device__ void start_velocities(const Press& s) {
  const PressureView& view = s.view;
  const glm::vec3 g = s.c.gravity;
  for_each_group(view.fluid, [&](std::uint32_t p, std::uint32_t) {
    if (p >= view.fluid) return;
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

// What is left of p; its share of the sums.
struct Left {
  double step = 0.0, turned = 0.0, clipped = 0.0, squares = 0.0, pressing = 0.0;
};
__device__ Left look_at(const PressureView& view, std::uint32_t p) {
  Left left;
  const bool presses = view.pressure[p] > 0.0f || view.flow[p] < 0.0f;
  const float r = presses ? -view.flow[p] : 0.0f;
  const float z = view.inverse[p] * r;
  left.step = static_cast<double>(z) * r;
  left.turned = static_cast<double>(z) * view.residual[p];
  left.squares = static_cast<double>(r) * r;
  left.pressing = presses;
  const float clipped = view.clipped[p];
  if (clipped > 0.0f) left.clipped = static_cast<double>(clipped) * clipped / view.inverse[p];
  view.residual[p] = r;
  return left;
}
__device__ void write_parts(const PressureView& view, std::uint32_t g, const Left& left) {
  double sums[5] = {left.step, left.turned, left.clipped, left.squares, left.pressing};
  sum_block(sums);
  if (threadIdx.x != 0) return;
  view.parts.step[g] = sums[0];
  view.parts.turned[g] = sums[1];
  view.parts.clipped[g] = sums[2];
  view.parts.squares[g] = sums[3];
  view.parts.pressing[g] = sums[4];
}
__device__ Left whole(const PressureView& view) {
  const std::uint32_t groups = groups_of(view.fluid);
  double sums[5] = {part_of(view.parts.step, groups), part_of(view.parts.turned, groups),
                    part_of(view.parts.clipped, groups), part_of(view.parts.squares, groups),
                    part_of(view.parts.pressing, groups)};
  sum_block(sums);
  return {sums[0], sums[1], sums[2], sums[3], sums[4]};
}

__device__ void start_flows(const Press& s) {
  const PressureView& view = s.view;
  const float wanted = s.c.rest_volume / s.density_time;
  for_each_group(view.fluid, [&](std::uint32_t p, std::uint32_t g) {
    Left left;
    if (p < view.fluid) {
      const bool there = s.fluid.state.key[p] < s.c.grid.retired_key();
      const float4 own = view.own[p];
      double diagonal = 0.0;
      float flow = 0.0f;
      if (there) {
        diagonal = static_cast<double>(s.dt * (dot(vec3(own), vec3(own)) * view.velocity[p].w + own.w));
        if (view.bodies) diagonal += static_cast<double>(s.dt) * diagonal_by_bodies(s, p);
        flow = flow_of(s, p) - wanted * s.fluid.expansion[p];
      }
      view.flow[p] = flow;
      view.inverse[p] = diagonal > 0.0 ? static_cast<float>(1.0 / diagonal) : 0.0f;
      view.pressure[p] = diagonal > 0.0 ? s.fluid.state.solved[p] : 0.0f;
      view.clipped[p] = view.residual[p] = view.direction[p] = 0.0f;
      left = look_at(view, p);
    }
    write_parts(view, g, left);
  });
}

// What is left, of those that press or are pushed together.
__device__ void look(const Press& s) {
  const PressureView& view = s.view;
  for_each_group(view.fluid, [&](std::uint32_t p, std::uint32_t g) {
    Left left;
    if (p < view.fluid) left = look_at(view, p);
    write_parts(view, g, left);
  });
}

// direction = preconditioned residual + keep · direction, of those that press.
__device__ void follow(const PressureView& view, float keep) {
  for_each_group(view.fluid, [&](std::uint32_t p, std::uint32_t) {
    if (p >= view.fluid) return;
    const bool presses = view.pressure[p] > 0.0f || view.flow[p] < 0.0f;
    const float before = keep > 0.0f ? keep * view.direction[p] : 0.0f;
    view.direction[p] = presses ? view.inverse[p] * view.residual[p] + before : 0.0f;
  });
}

// velocity and twists: what the direction, as pressures, changes them by over the sub-step.
__device__ void push(const Press& s, const cg::grid_group& grid) {
  const PressureView& view = s.view;
  for_each_group(view.fluid + view.surface, [&](std::uint32_t e, std::uint32_t) {
    if (e < view.fluid) {
      const float per_mass = view.velocity[e].w;
      const float3 f = push_on_fluid(s, e);
      const float by = s.dt * per_mass;
      view.velocity[e] = make_float4(by * f.x, by * f.y, by * f.z, per_mass);
    } else if (e < view.fluid + view.surface) {
      push_on_surface(s, e);
    }
  });
  grid.sync();
  if (view.bodies == 0) return;
  for_each_pressed_body(s, [&](std::uint32_t b, const Vector6& on_body) {
    Vector6 impulse = on_body;
    for (double& part : impulse) part *= static_cast<double>(s.dt);
    PressedUnknown& u = view.unknown[b];
    u.twist = view.body[b].body.moves ? cholesky_solve(u.factor, impulse) : Vector6{};
  });
  grid.sync();
}

// product = system · direction, after push().
__device__ void multiply(const Press& s) {
  const PressureView& view = s.view;
  for_each_group(view.fluid, [&](std::uint32_t p, std::uint32_t g) {
    double sum[1] = {};
    if (p < view.fluid) {
      const float flow = flow_of(s, p);
      view.product[p] = flow;
      sum[0] = static_cast<double>(view.direction[p]) * flow;
    }
    sum_block(sum);
    if (threadIdx.x == 0) view.parts.curvature[g] = sum[0];
  });
}

// One iteration's step along the direction, no pressure below 0, and the residual.
__device__ void advance(const PressureView& view, float length) {
  for_each_group(view.fluid, [&](std::uint32_t p, std::uint32_t g) {
    Left left;
    if (p < view.fluid) {
      const float to = view.pressure[p] + length * view.direction[p];
      const float kept = to > 0.0f ? to : 0.0f;
      view.pressure[p] = kept;
      view.clipped[p] += kept - to;
      view.flow[p] += length * view.product[p];
      left = look_at(view, p);
    }
    write_parts(view, g, left);
  });
}

// The flows get to know of what was cut off.
__device__ void undo_clips(const Press& s, const cg::grid_group& grid) {
  const PressureView& view = s.view;
  for_each_group(view.fluid, [&](std::uint32_t p, std::uint32_t) {
    if (p < view.fluid) view.direction[p] = view.clipped[p];
  });
  grid.sync();
  push(s, grid);
  for_each_group(view.fluid, [&](std::uint32_t p, std::uint32_t) {
    if (p >= view.fluid) return;
    view.flow[p] += flow_of(s, p);
    view.clipped[p] = 0.0f;
  });
  grid.sync();
}

__device__ void add_force(const SortedFluid& fluid, std::uint32_t p, const float3& more) {
  const float4 f = fluid.force[p];
  fluid.force[p] = make_float4(f.x + more.x, f.y + more.y, f.z + more.z, f.w);
}

__device__ void finish(const Press& s, const cg::grid_group& grid) {
  const PressureView& view = s.view;
  for_each_group(view.fluid, [&](std::uint32_t p, std::uint32_t) {
    if (p < view.fluid) view.direction[p] = view.pressure[p] - s.fluid.state.solved[p];
  });
  grid.sync();
  for_each_group(view.fluid + view.surface, [&](std::uint32_t e, std::uint32_t) {
    if (e < view.fluid) {
      add_force(s.fluid, e, push_on_fluid(s, e));
      s.fluid.state.solved[e] = view.pressure[e];
      if (view.probes && s.fluid.state.id[e] >= view.first_probe)
        view.probes[s.fluid.state.id[e] - view.first_probe] = s.fluid.force[e];
    } else if (e < view.fluid + view.surface) {
      push_on_surface(s, e);
    }
  });
  if (view.bodies == 0) return;
  grid.sync();
  for_each_pressed_body(s, [&](std::uint32_t b, const Vector6& w) {
    view.wrenches[b] = {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
  });
}

__global__ __launch_bounds__(kSolveThreads, 4) void press_kernel(const __grid_constant__ Press s) {
  const cg::grid_group grid = cg::this_grid();
  const PressureView& view = s.view;
  const std::uint32_t groups = groups_of(view.fluid);
  const double per_flow = static_cast<double>(s.dt) / static_cast<double>(s.c.rest_volume);
  const auto left = [&](const Left& sums) {
    return per_flow * sqrt(sums.squares / (sums.pressing > 1.0 ? sums.pressing : 1.0));
  };
  start_velocities(s);
  grid.sync();
  start_flows(s);
  grid.sync();
  Left now = whole(view);
  const double share = kPressureTolerance * left(now);
  const double enough = share > kPressureFloor ? share : kPressureFloor;
  double keep = 0.0;
  for (int iterations = 0; iterations < kMaxPressureIterations && now.step > 0.0 && left(now) > enough;
       ++iterations) {
    const double before = now.step;
    follow(view, static_cast<float>(keep));
    grid.sync();
    push(s, grid);
    multiply(s);
    grid.sync();
    double curvature[1] = {part_of(view.parts.curvature, groups)};
    sum_block(curvature);
    if (!(curvature[0] > 0.0)) break;
    advance(view, static_cast<float>(before / curvature[0]));
    grid.sync();
    now = whole(view);
    keep = (now.step - now.turned) / before;
    if (!(keep > 0.0)) keep = 0.0;
    if (now.clipped > kMaxClipped * now.step && iterations + 2 < kMaxPressureIterations) {
      undo_clips(s, grid);
      ++iterations;
      look(s);
      grid.sync();
      now = whole(view);
      keep = 0.0;
    }
  }
  finish(s, grid);
}

__global__ __launch_bounds__(kThreads) void push_by_last_kernel(Press s) {
  const std::uint32_t p = thread_index();
  if (p >= s.view.fluid) return;
  add_force(s.fluid, p, push_on_fluid(s, p));
}

}  // namespace

void launch_push_by_last(const StepConstants& constants, const SortedFluid& fluid,
                         const SortedSurface& moving, const PressureView& view, cudaStream_t stream) {
  Press press{constants, nullptr, 0.0f, 0.0f, fluid, moving, {}, view};
  press.view.direction = fluid.state.solved;
  push_by_last_kernel<<<blocks_for(view.fluid), kThreads, 0, stream>>>(press);
}

cudaError_t most_pressure_blocks(int& blocks) {
  int device = 0, multiprocessors = 0, each = 0;
  cudaError_t code = cudaGetDevice(&device);
  if (code == cudaSuccess)
    code = cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device);
  if (code == cudaSuccess)
    code = cudaOccupancyMaxActiveBlocksPerMultiprocessor(&each, reinterpret_cast<const void*>(press_kernel),
                                                         kSolveThreads, 0);
  blocks = each * multiprocessors;
  return code == cudaSuccess && blocks <= 0 ? cudaErrorCooperativeLaunchTooLarge : code;
}

cudaError_t launch_pressure_solve(const StepConstants& constants, const ParticleKind* kinds, float dt,
                                  float density_time, const SortedFluid& fluid, const SortedSurface& moving,
                                  const LocalSurface& local, const PressureView& view, int blocks,
                                  cudaStream_t stream) {
  Press solve{constants, kinds, dt, density_time, fluid, moving, local, view};
  void* arguments[] = {&solve};
  const unsigned groups = blocks_for(view.fluid + view.surface, kSolveThreads);
  const unsigned grid = groups < static_cast<unsigned>(blocks) ? groups : static_cast<unsigned>(blocks);
  return cudaLaunchCooperativeKernel(reinterpret_cast<const void*>(press_kernel), dim3(grid),
                                     dim3(kSolveThreads), arguments, 0, stream);
}

}  // namespace slosh::cuda
