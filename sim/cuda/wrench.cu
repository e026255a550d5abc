// Eq 10–12: the fluid's forces on body particles, and their sums about the bodies' centres of mass.
#include "sim/cuda/pair_rows.cuh"

namespace slosh::cuda {

namespace {

constexpr int kSumThreads = 256;

template <class Parts, Viscosity viscosity>
__global__ __launch_bounds__(kThreads) void surface_force_kernel(StepConstants c, float first_viscosity,
                                                                 SortedFluid fluid, SortedSurface surface,
                                                                 const std::uint8_t* wanted, float4* force) {
  const std::uint32_t i = thread_index();
  if (i >= surface.count || !wanted[surface.body[i]]) return;
  const std::uint32_t cell = surface.key[i];
  ForceSum<float> sum{0.0f, 0.0f, 0.0f};
  if (cell < c.grid.retired_key()) {
    // Where the fluid has one viscosity its column is not filled: Eq 9's mean is known up front.
    const float own = surface.viscosity[i];
    const float used = viscosity == Viscosity::kOne ? 0.5f * (own + first_viscosity) : own;
    const ParticleView<float> self = view(surface.x[i], surface.v[i], used);
    add_forces<Parts, Parts::kOnBodies, viscosity>(c, self, columns(fluid), fluid.cells, cell, sum);
  }
  force[surface.order[i]] =
      make_float4(c.force_scale * sum.x, c.force_scale * sum.y, c.force_scale * sum.z, 0.0f);
}

// Sums six doubles a thread over the block; thread 0 returns the whole. The tree's shape depends on nothing.
__device__ DeviceWrench sum_block(DeviceWrench own) {
  __shared__ DeviceWrench shared[kSumThreads];
  shared[threadIdx.x] = own;
  __syncthreads();
  for (unsigned half = kSumThreads / 2; half > 0; half /= 2) {
    if (threadIdx.x < half) {
      for (int k = 0; k < 3; ++k) {
        shared[threadIdx.x].force[k] += shared[threadIdx.x + half].force[k];
        shared[threadIdx.x].torque[k] += shared[threadIdx.x + half].torque[k];
      }
    }
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
    const float4 x = surface.placed[i];
    const glm::dvec3 part(f.x, f.y, f.z);
    force += part;
    torque += glm::cross(glm::dvec3(x.x, x.y, x.z) - center, part);
  }
  const DeviceWrench sum = sum_block({{force.x, force.y, force.z}, {torque.x, torque.y, torque.z}});
  if (threadIdx.x == 0) partial[blockIdx.x] = sum;
}

__global__ __launch_bounds__(kSumThreads) void body_kernel(const DeviceWrench* partial,
                                                           const WrenchRange* ranges,
                                                           DeviceWrench* wrenches) {
  const WrenchRange range = ranges[blockIdx.x];
  DeviceWrench own;
  for (std::uint32_t i = range.begin + threadIdx.x; i < range.end; i += kSumThreads) {
    for (int k = 0; k < 3; ++k) {
      own.force[k] += partial[i].force[k];
      own.torque[k] += partial[i].torque[k];
    }
  }
  const DeviceWrench sum = sum_block(own);
  if (threadIdx.x == 0) wrenches[blockIdx.x] = sum;
}

}  // namespace

void launch_surface_forces(const StepConstants& constants, const Plan& plan, float first_viscosity,
                           const SortedFluid& fluid, const SortedSurface& surface, const std::uint8_t* wanted,
                           float4* force, cudaStream_t stream) {
  with_physics(plan, [&]<class Parts, Viscosity viscosity>() {
    surface_force_kernel<Parts, viscosity><<<blocks_for(surface.count), kThreads, 0, stream>>>(
        constants, first_viscosity, fluid, surface, wanted, force);
  });
}

void launch_wrenches(const LocalSurface& fixed, const LocalSurface& moving, const DeviceBody* bodies,
                     const WrenchChunk* chunks, std::uint32_t chunk_count, DeviceWrench* partial,
                     const WrenchRange* ranges, std::uint32_t range_count, DeviceWrench* wrenches,
                     cudaStream_t stream) {
  if (chunk_count == 0) return;
  chunk_kernel<<<chunk_count, kSumThreads, 0, stream>>>(fixed, moving, bodies, chunks, partial);
  body_kernel<<<range_count, kSumThreads, 0, stream>>>(partial, ranges, wrenches);
}

}  // namespace slosh::cuda
