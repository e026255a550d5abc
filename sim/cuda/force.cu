// Eq 5, 6 and 9 on fluid particles and the leap-frog, in one pass: the force need not go to memory.
#include "sim/cuda/pair_rows.cuh"
#include "sim/snapshot.h"

namespace slosh::cuda {

namespace {

template <bool consistent, Viscosity viscosity>
__global__ __launch_bounds__(kThreads) void force_kernel(StepConstants c, const ParticleKind* kinds,
                                                         SortedFluid fluid, SortedSurface fixed,
                                                         SortedSurface moving, ForceOutput out) {
  const std::uint32_t p = thread_index();
  if (p >= fluid.count) return;
  const std::uint32_t id = fluid.state.id[p];
  const std::uint8_t kind_index = fluid.state.kind[p];
  const std::uint32_t cell = fluid.state.key[p];
  const std::uint32_t retired = c.grid.retired_key();
  out.next.id[p] = id;
  out.next.kind[p] = kind_index;
  out.next.key[p] = cell;
  if (cell >= retired) return;

  constexpr PairRule kFluids = consistent ? PairRule::kConsistent : PairRule::kPaper;
  constexpr PairRule kWalls = consistent ? PairRule::kWall : PairRule::kPaper;
  // Body particles have viscosities of their own, so against them Eq 9 holds even where one fluid has Eq 6.
  constexpr Viscosity kAgainstBodies = viscosity == Viscosity::kNone ? Viscosity::kNone : Viscosity::kPair;
  const ParticleKind kind = kinds[kind_index];
  const float4 x4 = fluid.pressed[p];
  const float4 v4 = fluid.state.v[p];
  const ParticleView<float> self = view(x4, v4, kind.viscosity);
  ForceSum<float> sum{0.0f, 0.0f, 0.0f};
  add_forces<kFluids, viscosity>(c, self, {fluid.pressed, fluid.state.v, fluid.viscosity}, fluid.cells, cell,
                                 sum);
  if (fixed.count) {
    add_forces<kWalls, kAgainstBodies>(c, self, {fixed.x, fixed.v, fixed.viscosity}, fixed.cells, cell, sum);
  }
  if (moving.count) {
    add_forces<kWalls, kAgainstBodies>(c, self, {moving.x, moving.v, moving.viscosity}, moving.cells, cell,
                                       sum);
  }
  const glm::vec3 force(c.spiky * sum.x, c.spiky * sum.y, c.spiky * sum.z);

  if (kind.probe) {  // its body moves it
    out.probe_forces[id - out.first_probe] = make_float4(force.x, force.y, force.z, 0.0f);
    out.probe_slots[id - out.first_probe] = p;
    out.next.x[p] = x4;
    out.next.v[p] = v4;
    return;
  }
  glm::vec3 x(x4.x, x4.y, x4.z);
  glm::vec3 v(v4.x, v4.y, v4.z);
  std::uint32_t status = 0;
  if (advance_particle(force, c.time_step / kind.mass, c.gravity, c.time_step, c.max_speed, x, v)) {
    status |= kStatusSpeedLimited;
  }
  if (c.grid.contains(x.x, x.y, x.z)) {
    out.next.key[p] = c.grid.cell_of(x.x, x.y, x.z);
  } else {
    out.next.key[p] = retired;
    status |= isfinite(x.x) && isfinite(x.y) && isfinite(x.z) ? kStatusEscaped : kStatusNonFinite;
  }
  out.next.x[p] = make_float4(x.x, x.y, x.z, 0.0f);
  out.next.v[p] = make_float4(v.x, v.y, v.z, v4.w);
  if (status) atomicOr(out.status, status);
}

}  // namespace

void launch_force(const StepConstants& constants, const Plan& plan, const ParticleKind* kinds,
                  const SortedFluid& fluid, const SortedSurface& fixed, const SortedSurface& moving,
                  const ForceOutput& output, cudaStream_t stream) {
  with_physics(plan, plan.one_viscosity, [&]<bool consistent, Viscosity viscosity>() {
    force_kernel<consistent, viscosity>
        <<<blocks_for(fluid.count), kThreads, 0, stream>>>(constants, kinds, fluid, fixed, moving, output);
  });
}

}  // namespace slosh::cuda
