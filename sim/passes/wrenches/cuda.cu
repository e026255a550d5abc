// Eq 10–12: the fluid's forces on body particles, and their sums about the bodies' centres of mass.
#include "sim/passes/walls/pair_mirrors.cuh"

namespace slosh::cuda {

namespace {

constexpr int kSumThreads = 256;
constexpr int kDragThreads = 128;  // 21 doubles each fit into a block's memory

template <class Team, class Parts, Viscosity viscosity, bool with_drag>
__global__ __launch_bounds__(kThreads) void surface_force_kernel(StepConstants c, float first_viscosity,
                                                                 SortedFluid fluid, SortedSurface surface,
                                                                 const std::uint8_t* wanted,
                                                                 LocalSurface local) {
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
    add_forces<Team, Parts, Parts::kOnBodies, viscosity>(
        c, self, columns(fluid), CellWalk<Team>{c.grid, fluid.cells, cell}, h, sum, wall.of_fluid);
    if constexpr (Parts::kCorrected && viscosity != Viscosity::kNone) {
      const auto as_it_is = [](std::uint32_t, const float4& v) { return make_float3(v.x, v.y, v.z); };
      if (surface.mirror.normal)
        add_forces_on_mirror<Team, Parts, viscosity>(c, surface, i, cell, first_viscosity, fluid, as_it_is,
                                                     sum);
    }
    if constexpr (with_drag) {
      for_each_dragged<Team, viscosity, Neighbours::kFluid>(
          c, self, columns(fluid), fluid.cells, cell, h, wall.of_fluid,
          [&](const ParticleView<float>& p, float reach) {
            add_pair_viscosity_rate<typename Parts::ForceKernel, Parts::kDrag>(self, p, reach, c.drag_shape,
                                                                               1.0f, rate);
          });
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

__device__ void add_to(DeviceWrench& sum, const DeviceWrench& part) {
  for (int k = 0; k < 3; ++k) {
    sum.force[k] += part.force[k];
    sum.torque[k] += part.torque[k];
  }
}
__device__ void add_to(BodyDrag& sum, const BodyDrag& part) {
  for (int k = 0; k < BodyDrag::kSize; ++k) sum.upper[k] += part.upper[k];
}

// Sums what each of `threads` threads has over the block; thread 0 returns the whole. The tree's shape
// depends on nothing.
template <int threads, class T>
__device__ T sum_block(const T& own) {
  __shared__ T shared[threads];
  shared[threadIdx.x] = own;
  __syncthreads();
  for (unsigned half = threads / 2; half > 0; half /= 2) {
    if (threadIdx.x < half) add_to(shared[threadIdx.x], shared[threadIdx.x + half]);
    __syncthreads();
  }
  return shared[0];
}

__global__ __launch_bounds__(kSumThreads) void chunk_kernel(LocalSurface fixed, LocalSurface moving,
                                                            const DeviceBody* bodies,
                                                            const WrenchChunk* chunks,
                                                            DeviceWrench* partial) {
  const WrenchChunk chunk = chunks[blockIdx.x];
  const LocalSurface& surface = chunk.moving ? moving : fixed;
  const glm::dvec3 center = bodies[chunk.body].position;
  glm::dvec3 force(0.0), torque(0.0);
  for (std::uint32_t i = chunk.begin + threadIdx.x; i < chunk.end; i += kSumThreads) {
    const float4 f = surface.force[i];
    const float4 c = surface.couple[i];
    const float4 x = surface.placed[i];
    const glm::dvec3 part(f.x, f.y, f.z);
    force += part;
    torque += glm::cross(glm::dvec3(x.x, x.y, x.z) - center, part) + glm::dvec3(c.x, c.y, c.z);
  }
  const DeviceWrench sum =
      sum_block<kSumThreads>(DeviceWrench{{force.x, force.y, force.z}, {torque.x, torque.y, torque.z}});
  if (threadIdx.x == 0) partial[blockIdx.x] = sum;
}

__global__ __launch_bounds__(kDragThreads) void chunk_drag_kernel(LocalSurface moving,
                                                                  const DeviceBody* bodies,
                                                                  const WrenchChunk* chunks,
                                                                  BodyDrag* partial) {
  const WrenchChunk chunk = chunks[blockIdx.x];
  const glm::dvec3 center = bodies[chunk.body].position;
  BodyDrag own;
  for (std::uint32_t i = chunk.begin + threadIdx.x; chunk.moving && i < chunk.end; i += kDragThreads) {
    const float4 a = moving.drag_a[i];
    const float2 b = moving.drag_b[i];
    const float4 x = moving.placed[i];
    own.add({a.x, a.y, a.z, a.w, b.x, b.y}, glm::dvec3(x.x, x.y, x.z) - center);
  }
  const BodyDrag sum = sum_block<kDragThreads>(own);
  if (threadIdx.x == 0) partial[blockIdx.x] = sum;
}

// From the chunks to the bodies.
template <int threads, class T>
__global__ __launch_bounds__(threads) void body_kernel(const T* partial, const WrenchRange* ranges, T* sums) {
  const WrenchRange range = ranges[blockIdx.x];
  T own;
  for (std::uint32_t i = range.begin + threadIdx.x; i < range.end; i += threads) add_to(own, partial[i]);
  const T sum = sum_block<threads>(own);
  if (threadIdx.x == 0) sums[blockIdx.x] = sum;
}

}  // namespace

void launch_surface_forces(const StepConstants& constants, const Plan& plan, float first_viscosity,
                           const SortedFluid& fluid, const SortedSurface& surface, const std::uint8_t* wanted,
                           const LocalSurface& local, bool with_drag, cudaStream_t stream) {
  with_physics(plan, [&]<class Parts, Viscosity viscosity>() {
    with_team<kTensorTeams>(surface.count, [&]<class Team>() {
      const auto launch = [&](auto kernel) {
        kernel<<<blocks_for(surface.count * Team::kLanes), kThreads, 0, stream>>>(
            constants, first_viscosity, fluid, surface, wanted, local);
      };
      if constexpr (viscosity != Viscosity::kNone) {
        if (with_drag) return launch(surface_force_kernel<Team, Parts, viscosity, true>);
      }
      launch(surface_force_kernel<Team, Parts, viscosity, false>);
    });
  });
}

void launch_wrenches(const LocalSurface& fixed, const LocalSurface& moving, const DeviceBody* bodies,
                     const WrenchChunk* chunks, std::uint32_t chunk_count, DeviceWrench* partial,
                     const WrenchRange* ranges, std::uint32_t range_count, DeviceWrench* wrenches,
                     cudaStream_t stream) {
  if (chunk_count == 0) return;
  chunk_kernel<<<chunk_count, kSumThreads, 0, stream>>>(fixed, moving, bodies, chunks, partial);
  body_kernel<kSumThreads><<<range_count, kSumThreads, 0, stream>>>(partial, ranges, wrenches);
}

void launch_body_drags(const LocalSurface& moving, const DeviceBody* bodies, const WrenchChunk* chunks,
                       std::uint32_t chunk_count, BodyDrag* partial, const WrenchRange* ranges,
                       std::uint32_t range_count, BodyDrag* drags, cudaStream_t stream) {
  if (chunk_count == 0) return;
  chunk_drag_kernel<<<chunk_count, kDragThreads, 0, stream>>>(moving, bodies, chunks, partial);
  body_kernel<kDragThreads><<<range_count, kDragThreads, 0, stream>>>(partial, ranges, drags);
}

}  // namespace slosh::cuda
