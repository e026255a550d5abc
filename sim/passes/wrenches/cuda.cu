// Eq 10–12: the fluid's forces on body particles, and their sums about the bodies' centres of mass.
#include "sim/passes/walls/pair_mirrors.cuh"

namespace slosh::cuda {

namespace {

constexpr int kSumThreads = 128;

template <class Team, class Parts, Viscosity viscosity, bool with_drag>
__global__ __launch_bounds__(kThreads) void surface_force_kernel(StepConstants c, float first_viscosity,
                                                                 SortedFluid fluid, SortedSurface surface,
                                                                 const std::uint8_t* wanted,
                                                                 LocalSurface local) {
  wait_for_last_kernel();
  const std::uint32_t i = Team::particle();
  if (i >= surface.count || !wanted[surface.body[i]]) return;
  const std::uint32_t cell = surface.key[i];
  SurfaceSum<float> sum{};
  sum.beyond = 1.0f - c.correction.wall_layer;
  Symmetric<float> rate{};
  if (cell < c.grid.retired_key()) {
    // Where the fluid has one viscosity its column is not filled: Eq 9's mean is known up front.
    const WallViscosity wall = wall_viscosity(surface.viscosity[i]);
    const float used =
        viscosity == Viscosity::kOne ? 0.5f * (wall.own + wall.of_fluid * first_viscosity) : wall.own;
    const ParticleView<float> self = view(surface.x[i], surface.v[i], used);
    const float h = surface.reach[i];
    const auto rates = [&](const ParticleView<float>& p, float reach) {
      if constexpr (with_drag) {
        add_pair_viscosity_rate<typename Parts::ForceKernel, Parts::kDrag>(self, p, reach, c.drag_shape, 1.0f,
                                                                           rate);
      }
    };
    add_forces<Team, Parts, Parts::kOnBodies, viscosity>(
        c, self, columns(fluid), CellWalk<Team>{c.grid, fluid.cells, cell}, h, sum, wall.of_fluid, rates);
    if constexpr (Parts::kCorrected && viscosity != Viscosity::kNone) {
      const auto as_it_is = [](std::uint32_t, const float4& v) { return make_float3(v.x, v.y, v.z); };
      if (surface.mirror.normal)
        add_forces_on_mirror<Team, Parts, viscosity>(c, surface, i, cell, first_viscosity, fluid, as_it_is,
                                                     sum);
    }
  }
  Team::sum(sum.x, sum.y, sum.z, sum.cx, sum.cy, sum.cz);
  if constexpr (with_drag) Team::sum(rate);
  if (Team::lane() != 0) return;
  const std::uint32_t at = surface.order[i];
  local.force[at] = make_float4(c.force_scale * sum.x, c.force_scale * sum.y, c.force_scale * sum.z, 0.0f);
  local.couple[at] =
      make_float4(c.force_scale * sum.cx, c.force_scale * sum.cy, c.force_scale * sum.cz, 0.0f);
  if constexpr (with_drag) {
    const Symmetric<float> scaled = scaled_and_shifted(rate, c.force_scale, 0.0f);
    local.drag_a[at] = make_float4(scaled.xx, scaled.xy, scaled.xz, scaled.yy);
    local.drag_b[at] = make_float2(scaled.yz, scaled.zz);
  }
}

// What one thread has.
struct BodySum {
  DeviceWrench wrench;
  BodyDrag drag;
};

// Eq 10–12 for the particles of one chunk; a body's last block adds its chunks up. The order of the sums
// hangs on nothing.
template <bool with_wrench, bool with_drag>
__global__ __launch_bounds__(kSumThreads) void sum_kernel(LocalSurface fixed, LocalSurface moving,
                                                          const DeviceBody* bodies, SumPlan plan,
                                                          DeviceWrench* wrenches, BodyDrag* drags) {
  wait_for_last_kernel();
  constexpr int kFirst = with_wrench ? 0 : SumPlan::kWrench;
  constexpr int kCount = (with_drag ? SumPlan::kAll : SumPlan::kWrench) - kFirst;
  constexpr std::uint32_t kWarps = kSumThreads / 32;
  static_assert(kCount <= 32);
  __shared__ double shared[kWarps][kCount];
  __shared__ bool last;
  const WrenchChunk chunk = plan.chunks[blockIdx.x];
  const LocalSurface& surface = chunk.moving ? moving : fixed;
  const glm::dvec3 center = bodies[chunk.body].position;
  const std::uint32_t lane = threadIdx.x % 32, warp = threadIdx.x / 32;
  BodySum own;
  for (std::uint32_t i = chunk.begin + threadIdx.x; i < chunk.end; i += kSumThreads) {
    const float4 x = surface.placed[i];
    const glm::dvec3 arm = glm::dvec3(x.x, x.y, x.z) - center;
    if constexpr (with_wrench) {
      const float4 f = surface.force[i];
      const float4 c = surface.couple[i];
      const glm::dvec3 force(f.x, f.y, f.z);
      const glm::dvec3 torque = glm::cross(arm, force) + glm::dvec3(c.x, c.y, c.z);
      for (int k = 0; k < 3; ++k) {
        own.wrench.force[k] += force[k];
        own.wrench.torque[k] += torque[k];
      }
    }
    if constexpr (with_drag) {
      if (!chunk.moving) continue;
      const float4 a = surface.drag_a[i];
      const float2 b = surface.drag_b[i];
      own.drag.add({a.x, a.y, a.z, a.w, b.x, b.y}, arm);
    }
  }
#pragma unroll
  for (int k = 0; k < kCount; ++k) {
    const int n = kFirst + k;
    double value = n < 3                  ? own.wrench.force[n]
                   : n < SumPlan::kWrench ? own.wrench.torque[n - 3]
                                          : own.drag.upper[n - SumPlan::kWrench];
    for (int half = 16; half > 0; half /= 2) value += __shfl_down_sync(0xffffffffu, value, half);
    if (lane == 0) shared[warp][k] = value;
  }
  __syncthreads();
  const auto over_warps = [&] {
    double sum = 0.0;
    for (std::uint32_t w = 0; w < kWarps; ++w) sum += shared[w][threadIdx.x];
    return sum;
  };
  if (threadIdx.x < kCount) plan.partial[blockIdx.x * SumPlan::kAll + threadIdx.x] = over_warps();
  __threadfence();
  __syncthreads();
  const WrenchRange range = plan.ranges[chunk.range];
  if (threadIdx.x == 0) {
    last = atomicAdd(plan.done + chunk.range, 1u) + 1 == range.end - range.begin;
    if (last) plan.done[chunk.range] = 0;
  }
  __syncthreads();
  if (!last) return;
  __threadfence();
  if (lane < kCount) {
    double sum = 0.0;
#pragma unroll 4
    for (std::uint32_t c = range.begin + warp; c < range.end; c += kWarps)
      sum += __ldcg(plan.partial + c * SumPlan::kAll + lane);
    shared[warp][lane] = sum;
  }
  __syncthreads();
  if (threadIdx.x >= kCount) return;
  const int n = kFirst + static_cast<int>(threadIdx.x);
  const double sum = over_warps();
  if (n < 3) {
    wrenches[chunk.range].force[n] = sum;
  } else if (n < SumPlan::kWrench) {
    wrenches[chunk.range].torque[n - 3] = sum;
  } else {
    drags[chunk.range].upper[n - SumPlan::kWrench] = sum;
  }
}

}  // namespace

void launch_surface_forces(const StepConstants& constants, const Plan& plan, float first_viscosity,
                           const SortedFluid& fluid, const SortedSurface& surface, const std::uint8_t* wanted,
                           const LocalSurface& local, bool with_drag, cudaStream_t stream) {
  with_physics(plan, [&]<class Parts, Viscosity viscosity>() {
    with_team<kTensorTeams>(surface.count, [&]<class Team>() {
      const auto launch = [&](auto kernel) {
        launch_early(kernel, blocks_for(surface.count * Team::kLanes), kThreads, stream, constants,
                     first_viscosity, fluid, surface, wanted, local);
      };
      if constexpr (viscosity != Viscosity::kNone) {
        if (with_drag) return launch(surface_force_kernel<Team, Parts, viscosity, true>);
      }
      launch(surface_force_kernel<Team, Parts, viscosity, false>);
    });
  });
}

void launch_sums(const LocalSurface& fixed, const LocalSurface& moving, const DeviceBody* bodies,
                 const SumPlan& plan, DeviceWrench* wrenches, BodyDrag* drags, cudaStream_t stream) {
  const auto kernel = !drags     ? sum_kernel<true, false>
                      : wrenches ? sum_kernel<true, true>
                                 : sum_kernel<false, true>;
  launch_early(kernel, plan.chunk_count, kSumThreads, stream, fixed, moving, bodies, plan, wrenches, drags);
}

}  // namespace slosh::cuda
