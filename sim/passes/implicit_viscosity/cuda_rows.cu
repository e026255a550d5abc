// Writes the viscous pairs down; the drag on bodies that stand still.
#include "sim/passes/implicit_viscosity/cuda_pairs.cuh"
#include "sim/passes/walls/pair_mirrors.cuh"

namespace slosh::cuda {

namespace {

template <Viscosity viscosity>
__global__ __launch_bounds__(kThreads) void rows_kernel(StepConstants c, const ParticleKind* kinds,
                                                        float first_viscosity, float dt, SortedFluid fluid,
                                                        SortedSurface fixed, SortedSurface moving,
                                                        LocalSurface local, ViscousView view) {
  const std::uint32_t e = thread_index();
  if (e >= view.fluid + view.surface) return;
  const float factor = kCentralDrag * dt * c.force_scale;
  Symmetric<float> rate{};
  std::uint32_t count = 0;
  const bool of_fluid = e < view.fluid;
  const bool there = !of_fluid || fluid.state.key[e] < c.grid.retired_key();
  if (there) {
    for_each_pair_of<viscosity>(
        c, kinds, first_viscosity, factor, fluid, moving, e, [&](std::uint32_t other, const float3& w) {
          add_outer(w, rate);
          if (count < view.rows.room)
            view.rows.pairs[view.rows.at(e, count)] = make_float4(w.x, w.y, w.z, __uint_as_float(other));
          ++count;
        });
  }
  view.rows.counts[e] = count;
  if (!of_fluid) {
    const std::uint32_t at = moving.order[e - view.fluid];
    const Symmetric<float> drag = scaled_and_shifted(rate, 1.0f / dt, 0.0f);
    local.drag_a[at] = make_float4(drag.xx, drag.xy, drag.xz, drag.yy);
    local.drag_b[at] = make_float2(drag.yz, drag.zz);
    return;
  }
  Symmetric<float> by_walls{};
  Symmetric<float> block{};
  if (there) {
    if (fixed.count) {
      for_each_pair<Viscosity::kPair, Neighbours::kWalls>(
          c, dragged(fluid, kinds, e), columns(fixed), fixed.cells, fluid.state.key[e], factor, 1.0f,
          [&](std::uint32_t, const float3& w) { add_outer(w, by_walls); });
      if (fixed.mirror.normal) {
        Symmetric<float> mirrored{};
        add_mirror_rates<Alone, SolvedParts>(c, dragged(fluid, kinds, e), fixed, fluid.state.key[e],
                                             mirrored);
        add_scaled(mirrored, dt * c.force_scale, by_walls);
      }
    }
    const float mass = kinds[fluid.state.kind[e]].mass;
    block = inverse_block(mass, 1.0f,
                          {rate.xx + by_walls.xx, rate.xy + by_walls.xy, rate.xz + by_walls.xz,
                           rate.yy + by_walls.yy, rate.yz + by_walls.yz, rate.zz + by_walls.zz});
  }
  set_tensor(view.by_walls, e, by_walls);
  set_tensor(view.block, e, block);
}

template <Viscosity viscosity>
__global__ __launch_bounds__(kThreads) void fixed_kernel(StepConstants c, float first_viscosity,
                                                         SortedFluid fluid, SortedSurface fixed,
                                                         const std::uint8_t* wanted, LocalSurface local,
                                                         ViscousView solved) {
  const std::uint32_t i = thread_index();
  if (i >= fixed.count || !wanted[fixed.body[i]]) return;
  const std::uint32_t cell = fixed.key[i];
  float3 force = make_float3(0.0f, 0.0f, 0.0f), couple = force;
  if (cell < c.grid.retired_key()) {
    const WallViscosity wall = wall_viscosity(fixed.viscosity[i]);
    const ParticleView<float> self = dragged<viscosity>(fixed, i, wall, first_viscosity);
    for_each_pair<viscosity, Neighbours::kFluid>(
        c, self, columns(fluid), fluid.cells, cell, kCentralDrag * c.force_scale, wall.of_fluid,
        [&](std::uint32_t j, const float3& w) {
          const float4 v = __ldg(fluid.state.v + j);
          const float4 u = __ldg(solved.change + j);
          const float along = w.x * (v.x + u.x) + w.y * (v.y + u.y) + w.z * (v.z + u.z);
          force.x += w.x * along;
          force.y += w.y * along;
          force.z += w.z * along;
        });
    if (fixed.mirror.normal) {
      SurfaceSum<float> on{};
      const auto ended = [&](std::uint32_t j, const float4& v) {
        const float4 u = __ldg(solved.change + j);
        return make_float3(v.x + u.x, v.y + u.y, v.z + u.z);
      };
      add_forces_on_mirror<Alone, SolvedParts, viscosity>(c, fixed, i, cell, first_viscosity, fluid, ended,
                                                          on);
      force.x += c.force_scale * on.x;
      force.y += c.force_scale * on.y;
      force.z += c.force_scale * on.z;
      couple = make_float3(c.force_scale * on.cx, c.force_scale * on.cy, c.force_scale * on.cz);
    }
  }
  local.force[fixed.order[i]] = make_float4(force.x, force.y, force.z, 0.0f);
  local.couple[fixed.order[i]] = make_float4(couple.x, couple.y, couple.z, 0.0f);
}

}  // namespace

void launch_viscous_rows(const StepConstants& constants, const Plan& plan, const ParticleKind* kinds,
                         float first_viscosity, float dt, const SortedFluid& fluid,
                         const SortedSurface& fixed, const SortedSurface& moving, const LocalSurface& local,
                         const ViscousView& view, cudaStream_t stream) {
  with_solved_viscosity(plan, [&]<Viscosity viscosity>() {
    rows_kernel<viscosity><<<blocks_for(view.fluid + view.surface), kThreads, 0, stream>>>(
        constants, kinds, first_viscosity, dt, fluid, fixed, moving, local, view);
  });
}

void launch_drag_on_fixed(const StepConstants& constants, const Plan& plan, float first_viscosity,
                          const SortedFluid& fluid, const SortedSurface& fixed, const std::uint8_t* wanted,
                          const LocalSurface& local, const ViscousView& view, cudaStream_t stream) {
  if (fixed.count == 0) return;
  with_solved_viscosity(plan, [&]<Viscosity viscosity>() {
    fixed_kernel<viscosity><<<blocks_for(fixed.count), kThreads, 0, stream>>>(
        constants, first_viscosity, fluid, fixed, wanted, local, view);
  });
}

}  // namespace slosh::cuda
