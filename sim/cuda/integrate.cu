// Leap-frog for fluid particles.
#include "sim/cuda/rows.cuh"
#include "sim/leap_frog.h"
#include "sim/snapshot.h"

namespace slosh::cuda {

namespace {

__global__ __launch_bounds__(kThreads) void integrate_kernel(StepConstants c, const ParticleKind* kinds,
                                                             SortedFluid fluid, float dt, float max_speed,
                                                             ProbeOutput probes, std::uint32_t* out_status) {
  const std::uint32_t p = thread_index();
  if (p >= fluid.count) return;
  const std::uint32_t retired = c.grid.retired_key();
  if (fluid.state.key[p] >= retired) return;
  const ParticleKind kind = kinds[fluid.state.kind[p]];
  const float4 force = fluid.force[p];
  if (kind.probe) {  // its body moves it
    const std::uint32_t probe = fluid.state.id[p] - probes.first;
    probes.forces[probe] = force;
    probes.slots[probe] = p;
    return;
  }
  const float4 x4 = fluid.state.x[p];
  const float4 v4 = fluid.state.v[p];
  glm::vec3 x(x4.x, x4.y, x4.z);
  glm::vec3 v(v4.x, v4.y, v4.z);
  std::uint32_t status = 0;
  if (advance_particle({force.x, force.y, force.z}, dt / kind.mass, c.gravity, dt, max_speed, x, v)) {
    status |= kStatusSpeedLimited;
  }
  std::uint32_t key = retired;
  if (c.grid.contains(x.x, x.y, x.z)) {
    key = c.grid.cell_of(x.x, x.y, x.z);
  } else {
    status |= isfinite(x.x) && isfinite(x.y) && isfinite(x.z) ? kStatusEscaped : kStatusNonFinite;
  }
  fluid.state.key[p] = key;
  fluid.state.x[p] = make_float4(x.x, x.y, x.z, 0.0f);
  fluid.state.v[p] = make_float4(v.x, v.y, v.z, v4.w);
  if (status) atomicOr(out_status, status);
}

}  // namespace

void launch_integrate(const StepConstants& constants, const ParticleKind* kinds, const SortedFluid& fluid,
                      float dt, float max_speed, const ProbeOutput& probes, std::uint32_t* status,
                      cudaStream_t stream) {
  integrate_kernel<<<blocks_for(fluid.count), kThreads, 0, stream>>>(constants, kinds, fluid, dt, max_speed,
                                                                     probes, status);
}

}  // namespace slosh::cuda
