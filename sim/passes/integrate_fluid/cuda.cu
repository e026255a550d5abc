// Leap-frog for fluid particles.
#include "sim/cuda/rows.cuh"
#include "sim/passes/integrate_fluid/leap_frog.h"
#include "sim/snapshot.h"

namespace slosh::cuda {

namespace {

// Integers, so that the sums do not depend on who comes first. True as on the CPU: when it would have been
// past the wall's own particles.
__device__ bool keep_from_walls(const ClampView& clamps, float mass, bool near, const glm::vec3& from,
                                glm::vec3& x, glm::vec3& v) {
  const auto sphere = [&](std::uint32_t b) -> const BoundingSphere& { return clamps.bodies[b].sphere; };
  const auto body = [&](std::uint32_t b) -> const ClampBody& { return clamps.bodies[b].body; };
  bool past = false;
  const bool bent = clamp_against_all(sphere, body, clamps.count, near, from, x, v,
                                      [&](std::uint32_t b, const glm::vec3& to, const glm::vec3& before) {
                                        past |= glm::distance(to, x) > body(b).depth;
                                        const std::size_t first = kImpulseWords * clamps.bodies[b].number;
                                        impulse_on_body({mass, to, x, before, v}, clamps.bodies[b].center,
                                                        clamps.units, [&](int word, std::int64_t value) {
                                                          atomicAdd(clamps.impulses + first + word,
                                                                    static_cast<unsigned long long>(value));
                                                        });
                                      });
  if (bent) atomicAdd(clamps.impulses + kImpulseWords * clamps.all, 1ull);
  return past;
}

__global__ __launch_bounds__(kThreads) void integrate_kernel(StepConstants c, const ParticleKind* kinds,
                                                             SortedFluid fluid, float dt, float max_speed,
                                                             ClampView clamps, ProbeOutput probes,
                                                             SortView sort, std::uint32_t* out_status) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (p >= fluid.count) return;
  const std::uint32_t retired = c.grid.retired_key();
  if (fluid.state.key[p] >= retired) {
    if (sort.tickets) sort.tickets[p] = SortView::kStays;
    return;
  }
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
  const bool near = force.w != 0.0f;
  if (clamps.count && (near || clamps.any_fast) && c.grid.contains(x.x, x.y, x.z) &&
      keep_from_walls(clamps, kind.mass, near, {x4.x, x4.y, x4.z}, x, v)) {
    status |= kStatusClamped;
  }
  std::uint32_t key = retired;
  if (c.grid.contains(x.x, x.y, x.z)) {
    key = c.grid.cell_of(x.x, x.y, x.z);
  } else {
    status |= isfinite(x.x) && isfinite(x.y) && isfinite(x.z) ? kStatusEscaped : kStatusNonFinite;
  }
  fluid.state.key[p] = key;
  if (sort.tickets) sort.tickets[p] = take_ticket(sort, key, retired);
  fluid.state.x[p] = make_float4(x.x, x.y, x.z, 0.0f);
  fluid.state.v[p] = make_float4(v.x, v.y, v.z, v4.w);
  if (status) atomicOr(out_status, status);
}

__global__ void hand_over_kernel(std::int64_t* impulses, std::int64_t* out, std::uint32_t words) {
  wait_for_last_kernel();
  const std::uint32_t i = thread_index();
  if (i >= words) return;
  out[i] = impulses[i];
  impulses[i] = 0;
}

}  // namespace

void launch_hand_over(std::int64_t* impulses, std::int64_t* out, std::size_t words, cudaStream_t stream) {
  const auto count = static_cast<std::uint32_t>(words);
  if (count > 0) launch_early(hand_over_kernel, blocks_for(count), kThreads, stream, impulses, out, count);
}

void launch_integrate(const StepConstants& constants, const ParticleKind* kinds, const SortedFluid& fluid,
                      float dt, float max_speed, const ClampView& clamps, const ProbeOutput& probes,
                      const SortView& sort, std::uint32_t* status, cudaStream_t stream) {
  launch_early(integrate_kernel, blocks_for(fluid.count), kThreads, stream, constants, kinds, fluid, dt,
               max_speed, clamps, probes, sort, status);
}

}  // namespace slosh::cuda
