// The force of the neighbours of one kind on one particle: the inner loop of both force passes, as
// sim/passes/pressure_force/row_force.h.
#pragma once

#include "sim/cuda/rows.cuh"
#include "sim/model.h"

namespace slosh::cuda {

/// Columns of the neighbours; `viscosity` may be null unless kPair.
struct NeighborColumns {
  const float4* x;  ///< w: pressure
  const float4* v;  ///< w: volume
  const float* viscosity;
  // The corrected model's, of fluid:
  const float4* push_a = nullptr;
  const float4* push_b = nullptr;
  const float* drag_z = nullptr;
  const float* solved = nullptr;
  const float* reach = nullptr;  // of bodies
  // kFluidStress, of fluid:
  const float4* passed_x = nullptr;
  const float4* passed_y = nullptr;
  const float4* passed_z = nullptr;
  const float* left = nullptr;
};

__device__ inline NeighborColumns columns(const SortedFluid& fluid) {
  return {fluid.pressed,      fluid.state.v, fluid.viscosity, fluid.push_a,   fluid.push_b,   fluid.drag_z,
          fluid.state.solved, nullptr,       fluid.passed_x,  fluid.passed_y, fluid.passed_z, fluid.left};
}
__device__ inline NeighborColumns columns(const SortedSurface& surface) {
  return {surface.x, surface.v, surface.viscosity, nullptr, nullptr, nullptr, nullptr, surface.reach};
}

/// Pressure tensor and damping of the corrected model's fluid.
__device__ inline void read_corrected(const NeighborColumns& n, std::uint32_t j, ParticleView<float>& p) {
  const float4 a = __ldg(n.push_a + j);
  const float4 b = __ldg(n.push_b + j);
  p.push = {a.x, a.y, a.z, a.w, b.x, b.y};
  p.ux = b.z;
  p.uy = b.w;
  p.uz = __ldg(n.drag_z + j);
}

/// With particle stresses: j's pressure and stress tensor; to `p` its viscosity times velocity.
__device__ inline Matrix3<float> read_passed(const NeighborColumns& n, std::uint32_t j,
                                             ParticleView<float>& p) {
  const float4 x = __ldg(n.passed_x + j), y = __ldg(n.passed_y + j), z = __ldg(n.passed_z + j);
  p.ux = x.w;
  p.uy = y.w;
  p.uz = z.w;
  p.viscosity = __ldg(n.left + j);
  return {{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}};
}

enum class Neighbours { kFluid, kWalls };

/// A neighbour's side of Eq 9. `of_fluid`: WallViscosity's where p is a wall's particle, else 1.
template <Viscosity viscosity, Neighbours neighbours>
__device__ inline float viscosity_of(const ParticleView<float>& p, const NeighborColumns& n, std::uint32_t j,
                                     float of_fluid) {
  if constexpr (viscosity != Viscosity::kPair) {
    return p.viscosity;
  } else if constexpr (neighbours == Neighbours::kWalls) {
    return side_of_wall(__ldg(n.viscosity + j), p.viscosity);
  } else {
    return of_fluid * __ldg(n.viscosity + j);
  }
}

/// Within which p and its neighbour j meet: what walls' particles have, of fluid `h`, m.
template <Neighbours neighbours>
__device__ inline float reach_of(const NeighborColumns& n, std::uint32_t j, float h) {
  if constexpr (neighbours == Neighbours::kWalls) return __ldg(n.reach + j);
  return h;
}

struct NothingBesides {
  __device__ void operator()(const ParticleView<float>&, float) const {}
};

/// Adds the forces of the neighbours, or of the thread's share of them, and calls also(i, reach) of each.
/// `h`: within which p meets fluid, m.
template <class Team, class Parts, PairRule rule, Viscosity viscosity,
          Neighbours neighbours = Neighbours::kFluid, class Walk, class Sum = ForceSum<float>,
          class Also = NothingBesides>
__device__ inline void add_forces(const StepConstants& c, const ParticleView<float>& p,
                                  const NeighborColumns& n, const Walk& walk, float h, Sum& sum,
                                  float of_fluid = 1.0f, const Also& also = {}) {
  constexpr bool kOfFluid = is_corrected_fluid(rule) || is_corrected_body(rule);
  // With one viscosity, viscosity times velocity is in u already.
  constexpr bool kViscous =
      is_corrected_fluid(rule) ? viscosity == Viscosity::kPair : viscosity != Viscosity::kNone;
  walk([&](std::uint32_t j) {
    ParticleView<float> i;
    const float4 x = __ldg(n.x + j);
    i.x = x.x;
    i.y = x.y;
    i.z = x.z;
    // Of 162 candidates 34 are in reach: of the others nothing more is fetched. Where four threads share a
    // particle, waiting for its place first costs more than a velocity that nobody needs.
    if constexpr (!Walk::kListed && (kOfFluid || Team::kLanes < 4)) {
      const float dx = p.x - x.x;
      const float dy = p.y - x.y;
      const float dz = p.z - x.z;
      if (dx * dx + dy * dy + dz * dz >= c.support_radius * c.support_radius) return;
    }
    if constexpr (kOfFluid) {
      i.volume = x.w;
      read_corrected(n, j, i);
      if constexpr (rule == PairRule::kSolvedBody) i.pressure = __ldg(n.solved + j);
    } else {
      i.pressure = x.w;
    }
    if constexpr (kViscous || rule == PairRule::kPaper) {
      const float4 v = __ldg(n.v + j);
      i.vx = v.x;
      i.vy = v.y;
      i.vz = v.z;
      i.volume = v.w;
    }
    if constexpr (kViscous) i.viscosity = viscosity_of<viscosity, neighbours>(p, n, j, of_fluid);
    add_pair_force<typename Parts::ForceKernel, rule, Parts::kDrag, kViscous>(
        p, i, reach_of<neighbours>(n, j, h), c.drag_shape, 1.0f, sum);
    also(i, reach_of<neighbours>(n, j, h));
  });
}

__device__ inline ParticleView<float> view(const float4& x, const float4& v, float viscosity) {
  return {x.x, x.y, x.z, v.x, v.y, v.z, x.w, v.w, viscosity, {}, 0.0f, 0.0f, 0.0f};
}

/// Calls f(i, reach) for the bodies' particles around p as the viscous force sees them, or the thread's share
/// of them.
template <class Team, class F>
__device__ inline void for_each_dragging(const StepConstants& c, const ParticleView<float>& p,
                                         const NeighborColumns& n, const CellTable& cells, std::uint32_t cell,
                                         F&& f) {
  for_neighbors<Team>(c.grid, cells, cell, [&](std::uint32_t j) {
    const float viscosity = viscosity_of<Viscosity::kPair, Neighbours::kWalls>(p, n, j, 1.0f);
    f(view(__ldg(n.x + j), __ldg(n.v + j), viscosity), __ldg(n.reach + j));
  });
}

}  // namespace slosh::cuda
