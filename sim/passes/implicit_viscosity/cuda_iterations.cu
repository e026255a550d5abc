// Conjugate gradients in one launch: every block stays on the GPU, they wait for each other between an
// iteration's parts, and each of them sums the parts of a sum by itself, in one fixed shape, so that all
// decide alike whether to go on. Nothing depends on how many blocks there are.
#include <cooperative_groups.h>

#include "sim/passes/implicit_viscosity/cuda_bodies.cuh"
#include "sim/passes/implicit_viscosity/cuda_pairs.cuh"
#include "sim/snapshot.h"

namespace slosh::cuda {

namespace {

namespace cg = cooperative_groups;

__device__ std::uint32_t groups_of(const ViscousView& view) {
  return (view.fluid + view.surface + kSolveThreads - 1) / kSolveThreads;
}

// Calls f(e, g) for this thread's entry of each group g of entries that is this block's; e may lie behind the
// last one.
template <class F>
__device__ void for_each_group(const ViscousView& view, F&& f) {
  const std::uint32_t groups = groups_of(view);
  for (std::uint32_t g = blockIdx.x; g < groups; g += gridDim.x) f(g * kSolveThreads + threadIdx.x, g);
}

__device__ float3 less(const float4& a, const float4& b) {
  return make_float3(a.x - b.x, a.y - b.y, a.z - b.z);
}

__device__ void drag_by(const float3& w, const float3& faster, float3& sum) {
  const float along = w.x * faster.x + w.y * faster.y + w.z * faster.z;
  sum.x += w.x * along;
  sum.y += w.y * along;
  sum.z += w.z * along;
}

// For those who have more pairs than there is room for.
template <Viscosity viscosity>
__device__ __noinline__ float3 walked_drag(const Solve& s, std::uint32_t e) {
  const float4 own = s.view.direction[e];
  float3 sum = make_float3(0.0f, 0.0f, 0.0f);
  for_each_pair_of<viscosity>(
      s.c, s.kinds, s.first_viscosity, kCentralDrag * s.dt * s.c.force_scale, s.fluid, s.moving, e,
      [&](std::uint32_t other, const float3& w) { drag_by(w, less(s.view.direction[other], own), sum); });
  return sum;
}

// N·s on an entry by the others, all moving as `direction` says.
template <Viscosity viscosity>
__device__ float3 drag_on(const Solve& s, std::uint32_t e) {
  const ViscousView& view = s.view;
  const std::uint32_t count = view.rows.counts[e];
  if (count > view.rows.room) return walked_drag<viscosity>(s, e);
  const float4 own = view.direction[e];
  const float4* pairs = view.rows.pairs + view.rows.at(e, 0);
  float3 sum = make_float3(0.0f, 0.0f, 0.0f);
#pragma unroll 4
  for (std::uint32_t k = 0; k < count; ++k) {
    const float4 pair = __ldcs(pairs + std::size_t{32} * k);
    drag_by(make_float3(pair.x, pair.y, pair.z), less(view.direction[__float_as_uint(pair.w)], own), sum);
  }
  return sum;
}

// The velocities that the sub-step begins with.
__device__ void start_velocities(const Solve& s) {
  const ViscousView& view = s.view;
  for_each_group(view, [&](std::uint32_t e, std::uint32_t) {
    if (e < view.fluid) {
      const bool there = s.fluid.state.key[e] < s.c.grid.retired_key();
      const float4 v = s.fluid.state.v[e];
      view.direction[e] = there ? make_float4(v.x, v.y, v.z, s.kinds[s.fluid.state.kind[e]].mass)
                                : make_float4(0.0f, 0.0f, 0.0f, 0.0f);
    } else if (e < view.fluid + view.surface) {
      const std::uint32_t i = e - view.fluid;
      view.direction[e] = carried(s, i, vector_of(view.body[s.moving.body[i]].body.twist));
    }
  });
  for (std::uint32_t b = blockIdx.x; b < view.bodies; b += gridDim.x) {
    if (threadIdx.x == 0) view.parts.body_step[b] = view.parts.body_curvature[b] = 0.0;
  }
}

// Their residual.
template <Viscosity viscosity>
__device__ void start_residual(const Solve& s) {
  const ViscousView& view = s.view;
  for_each_group(view, [&](std::uint32_t e, std::uint32_t g) {
    double sums[2] = {};  // step, mass
    if (e < view.fluid) {
      const float4 v = view.direction[e];
      float3 r = make_float3(0.0f, 0.0f, 0.0f), z = r;
      if (v.w > 0.0f) {
        const float4 force = s.fluid.force[e];
        const float3 drag = drag_on<viscosity>(s, e);
        const float3 walls = scaled_by(tensor(view.by_walls, e), make_float3(v.x, v.y, v.z));
        r = make_float3(s.dt * (force.x + v.w * s.c.gravity.x) + drag.x - walls.x,
                        s.dt * (force.y + v.w * s.c.gravity.y) + drag.y - walls.y,
                        s.dt * (force.z + v.w * s.c.gravity.z) + drag.z - walls.z);
        z = scaled_by(tensor(view.block, e), r);
      }
      view.change[e] = make_float4(0.0f, 0.0f, 0.0f, 0.0f);
      view.residual[e] = make_float4(r.x, r.y, r.z, 0.0f);
      view.product[e] = make_float4(z.x, z.y, z.z, 0.0f);
      sums[0] = static_cast<double>(r.x * z.x + r.y * z.y + r.z * z.z);
      sums[1] = static_cast<double>(v.w);
    } else if (e < view.fluid + view.surface) {
      const float3 drag = drag_on<viscosity>(s, e);
      view.on_surface[s.moving.order[e - view.fluid]] = make_float4(drag.x, drag.y, drag.z, 0.0f);
    }
    sum_block(sums);
    if (threadIdx.x == 0) {
      view.parts.step[g] = sums[0];
      view.parts.mass[g] = sums[1];
    }
  });
}

// direction = product + keep · direction; `last` of the bodies' two directions is read.
__device__ void follow(const Solve& s, float keep, double body_keep, int last) {
  const ViscousView& view = s.view;
  const auto next = [&](std::uint32_t b, int k) {
    const ViscousUnknown& u = view.unknown[b];
    return view.body[b].body.moves ? u.product[k] + body_keep * u.direction[last][k] : 0.0;
  };
  for_each_group(view, [&](std::uint32_t e, std::uint32_t) {
    if (e < view.fluid) {
      const float4 z = view.product[e];
      const float4 d = view.direction[e];
      view.direction[e] = keep == 0.0f
                              ? make_float4(z.x, z.y, z.z, d.w)
                              : make_float4(z.x + keep * d.x, z.y + keep * d.y, z.z + keep * d.z, d.w);
    } else if (e < view.fluid + view.surface) {
      const std::uint32_t i = e - view.fluid;
      Vector6 twist;
      for (int k = 0; k < 6; ++k) twist[k] = next(s.moving.body[i], k);
      view.direction[e] = carried(s, i, twist);
    }
  });
  for (std::uint32_t b = blockIdx.x; b < view.bodies; b += gridDim.x) {
    if (view.body[b].body.moves && threadIdx.x < 6)
      view.unknown[b].direction[1 - last][threadIdx.x] = next(b, static_cast<int>(threadIdx.x));
  }
}

// product = (M + dt D) direction.
template <Viscosity viscosity>
__device__ void multiply(const Solve& s) {
  const ViscousView& view = s.view;
  for_each_group(view, [&](std::uint32_t e, std::uint32_t g) {
    double sum[1] = {};
    if (e < view.fluid + view.surface) {
      const float3 drag = drag_on<viscosity>(s, e);
      if (e < view.fluid) {
        const float4 d = view.direction[e];
        const float3 walls = scaled_by(tensor(view.by_walls, e), make_float3(d.x, d.y, d.z));
        const float3 q = make_float3(d.w * d.x + walls.x - drag.x, d.w * d.y + walls.y - drag.y,
                                     d.w * d.z + walls.z - drag.z);
        view.product[e] = make_float4(q.x, q.y, q.z, 0.0f);
        sum[0] = static_cast<double>(d.x * q.x + d.y * q.y + d.z * q.z);
      } else {
        view.on_surface[s.moving.order[e - view.fluid]] = make_float4(drag.x, drag.y, drag.z, 0.0f);
      }
    }
    sum_block(sum);
    if (threadIdx.x == 0) view.parts.curvature[g] = sum[0];
  });
}

// One iteration's step along the direction, and the residual made ready for the next.
__device__ void advance(const Solve& s, float length) {
  const ViscousView& view = s.view;
  for_each_group(view, [&](std::uint32_t e, std::uint32_t g) {
    double sums[3] = {};  // left, changed, step
    if (e < view.fluid) {
      const float4 d = view.direction[e];
      if (d.w > 0.0f) {
        float4 u = view.change[e], r = view.residual[e];
        const float4 q = view.product[e];
        const auto along = [&](float& change, float& residual, float direction, float product) {
          change += length * direction;
          residual -= length * product;
          sums[0] += static_cast<double>(residual * residual / d.w);
          sums[1] += static_cast<double>(d.w * change * change);
        };
        along(u.x, r.x, d.x, q.x);
        along(u.y, r.y, d.y, q.y);
        along(u.z, r.z, d.z, q.z);
        const float3 z = scaled_by(tensor(view.block, e), make_float3(r.x, r.y, r.z));
        sums[2] = static_cast<double>(r.x * z.x + r.y * z.y + r.z * z.z);
        view.change[e] = u;
        view.residual[e] = r;
        view.product[e] = make_float4(z.x, z.y, z.z, 0.0f);
      }
    }
    sum_block(sums);
    if (threadIdx.x == 0) {
      view.parts.left[g] = sums[0];
      view.parts.changed[g] = sums[1];
      view.parts.step[g] = sums[2];
    }
  });
}

// What is left over goes to each by its mass, so that the pair keeps its momentum.
__device__ void finish(const Solve& s) {
  const ViscousView& view = s.view;
  const glm::vec3 g = s.c.gravity;
  const float per_step = 1.0f / s.dt;
  for_each_group(view, [&](std::uint32_t e, std::uint32_t) {
    if (e >= view.fluid) return;
    const float mass = view.direction[e].w;
    if (!(mass > 0.0f)) return;
    const float4 u = view.change[e], r = view.residual[e];
    const float near = s.fluid.force[e].w;
    s.fluid.force[e] =
        make_float4(per_step * (mass * u.x + r.x) - mass * g.x, per_step * (mass * u.y + r.y) - mass * g.y,
                    per_step * (mass * u.z + r.z) - mass * g.z, near);
  });
}

template <Viscosity viscosity>
__global__ __launch_bounds__(kSolveThreads, 4) void solve_kernel(const __grid_constant__ Solve s,
                                                                 std::uint32_t* status) {
  const cg::grid_group grid = cg::this_grid();
  const ViscousView& view = s.view;
  const std::uint32_t groups = groups_of(view);
  // A part's sum over all groups, and behind them over the bodies (those that do not move stay at 0).
  const auto whole = [&](const double* parts, const double* of_bodies) {
    return part_of(parts, groups) + part_of(of_bodies, view.bodies);
  };
  start_velocities(s);
  grid.sync();
  start_residual<viscosity>(s);
  grid.sync();
  if (view.bodies) {
    for_each_body(s, [&](std::uint32_t b, const Vector6& on_body) { start_body(s, b, on_body); });
    grid.sync();
  }
  double start[2] = {whole(view.parts.step, view.parts.body_step), part_of(view.parts.mass, groups)};
  sum_block(start);
  const double gravity = static_cast<double>(glm::length(s.c.gravity));
  const double floor = kViscousFloor * gravity * static_cast<double>(s.dt);
  const double enough = floor * floor * start[1];
  double now = start[0], before = 0.0;
  int current = 0;  // of the bodies' two directions
  ViscousOutcome outcome;
  while (outcome.iterations < static_cast<std::uint32_t>(kMaxViscosityIterations)) {
    if (!(now > 0.0)) {
      outcome.converged = now == 0.0;
      break;
    }
    const double keep = before > 0.0 ? now / before : 0.0;
    follow(s, static_cast<float>(keep), keep, current);
    current = 1 - current;
    before = now;
    grid.sync();
    multiply<viscosity>(s);
    grid.sync();
    if (view.bodies) {
      for_each_body(s,
                    [&](std::uint32_t b, const Vector6& on_body) { multiply_body(s, b, on_body, current); });
      grid.sync();
    }
    double curvature[1] = {whole(view.parts.curvature, view.parts.body_curvature)};
    sum_block(curvature);
    if (!(curvature[0] > 0.0)) break;
    const double length = now / curvature[0];
    advance(s, static_cast<float>(length));
    by_first_thread(view, [&](std::uint32_t b) { advance_body(s, b, length, current); });
    grid.sync();
    ++outcome.iterations;
    double sums[3] = {part_of(view.parts.left, groups), part_of(view.parts.changed, groups),
                      whole(view.parts.step, view.parts.body_step)};
    sum_block(sums);
    if (sums[0] <= kViscousTolerance * kViscousTolerance * sums[1] + enough) {
      outcome.converged = 1;
      break;
    }
    now = sums[2];
  }
  finish(s);
  by_first_thread(view, [&](std::uint32_t b) { finish_body(s, b); });
  if (blockIdx.x == 0 && threadIdx.x == 0) {
    *view.outcome = outcome;
    if (!outcome.converged) atomicOr(status, kStatusViscosityCut);
  }
}

}  // namespace

cudaError_t most_solve_blocks(int& blocks) {
  int device = 0, multiprocessors = 0, each = 0;
  cudaError_t code = cudaGetDevice(&device);
  if (code == cudaSuccess)
    code = cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device);
  int fewest = 0;
  for (const void* kernel : {reinterpret_cast<const void*>(solve_kernel<Viscosity::kOne>),
                             reinterpret_cast<const void*>(solve_kernel<Viscosity::kPair>)}) {
    if (code == cudaSuccess)
      code = cudaOccupancyMaxActiveBlocksPerMultiprocessor(&each, kernel, kSolveThreads, 0);
    fewest = fewest == 0 ? each : (each < fewest ? each : fewest);
  }
  blocks = fewest * multiprocessors;
  return code == cudaSuccess && blocks <= 0 ? cudaErrorCooperativeLaunchTooLarge : code;
}

cudaError_t launch_viscous_solve(const StepConstants& constants, const Plan& plan, const ParticleKind* kinds,
                                 float first_viscosity, float dt, const SortedFluid& fluid,
                                 const SortedSurface& moving, const LocalSurface& local,
                                 const ViscousView& view, int blocks, std::uint32_t* status,
                                 cudaStream_t stream) {
  Solve solve{constants, kinds, first_viscosity, dt, fluid, moving, local, view};
  void* arguments[] = {&solve, &status};
  const unsigned groups = blocks_for(view.fluid + view.surface, kSolveThreads);
  const unsigned grid = groups < static_cast<unsigned>(blocks) ? groups : static_cast<unsigned>(blocks);
  return with_solved_viscosity(plan, [&]<Viscosity viscosity>() {
    return cudaLaunchCooperativeKernel(reinterpret_cast<const void*>(solve_kernel<viscosity>), dim3(grid),
                                       dim3(kSolveThreads), arguments, 0, stream);
  });
}

}  // namespace slosh::cuda
