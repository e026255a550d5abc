// Of the corrected model's density pass: from sums over neighbours to pressure tensors and damping, a batch
// of particles at a time.
#pragma once

#include <algorithm>
#include <cstring>
#include <iterator>

#include "sim/cpu/passes.h"
#include "sim/model.h"
#include "sim/passes/fluid_stress/fluid_stress.h"
#include "sim/passes/pressure_solve/cpu_pairs.h"
#include "sim/passes/pressure_solve/solved_state.h"
#include "sim/walls/wall_particles.h"

namespace slosh::corrected_density {

// What the pass goes through.
struct Work {
  PassContext& context;
  FluidParticles& fluid;
  const BoundaryParticles &fixed, &moving;
  FluidPress& press;
};

inline FloatBatch load(const Column<float>& column, std::uint32_t j) {
  return FloatBatch::load_unaligned(column.data() + j);
}

// What up to four particles' neighbours add up to; the rows get −W'/r, without the kernel's constant, as
// weights.
struct GroupSums {
  Sixteen even = {}, odd = {};  // Σ d ⊗ d (−W'/r): xx, yy, zz; xy, yz, xz
  Sixteen slope = {};           // Σ d (−W'/r)
  Sixteen velocity = {};        // Σ W v, and in the fourth Σ W
  // Where `flows`, of v ⊗ d (−W'/r): xx, yy, zz; yx, zy, xz; zx, xy, yz.
  Sixteen offset = {};  // Σ W d
  Sixteen carried = {}, carried_odd = {}, carried_back = {};
};

// What walls add for one particle.
struct WallSums {
  Neighborhood<FloatBatch> sum;
  Vector3<FloatBatch> slope;  // Σ d (−W'/r), walls with their share
  FloatBatch no_slip;         // Σ d² (−W'/r) V of no-slip walls
};
template <bool stresses>
void add_walls(const Work& w, std::uint32_t p, const BoundaryParticles& walls, const RowList& rows,
               WallSums& sums) {
  using Kernel = ModelParts<ParticleModel::kCorrected>::DensityKernel;
  const FluidParticles& fluid = w.fluid;
  const FloatBatch x(fluid.x[p]), y(fluid.y[p]), z(fluid.z[p]);
  const FloatBatch layer(w.context.correction.wall_layer);
  for_each_batch(rows, [&](std::uint32_t j, FloatBatch weight) {
    const FloatBatch share = load(walls.pressure, j), h = load(walls.reach, j);
    const FloatBatch dx = x - load(walls.x, j), dy = y - load(walls.y, j), dz = z - load(walls.z, j);
    add_wall_neighbor<Kernel>(dx, dy, dz, share, layer * share, h, weight, sums.sum);
    const FloatBatch r_squared = dx * dx + dy * dy + dz * dz;
    const FloatBatch single = Kernel::pair(r_squared, h, weight).slope_over_r;
    if constexpr (stresses) {
      const FloatBatch slips(static_cast<float>(kFreeSlip));
      const FloatBatch volume =
          xsimd::select(load(walls.viscosity, j) == slips, FloatBatch(0.0f), load(walls.volume, j));
      sums.no_slip += volume * r_squared * single;
    }
    const FloatBatch slope = share * single;
    sums.slope.x += slope * dx;
    sums.slope.y += slope * dy;
    sums.slope.z += slope * dz;
  });
}

// What particles one behind the other have from their neighbours, side by side: a batch of them is finished
// at once.
struct Block {
  std::uint32_t first = 0, count = 0;
  alignas(64) float sums[sizeof(GroupSums) / sizeof(Sixteen)][4][kLanes];  // four floats of GroupSums' each
  alignas(64) float number[kLanes], moment[6][kLanes], slope[3][kLanes], no_slip[kLanes];  // WallSums
  alignas(64) float viscosity[kLanes], density[kLanes];                                    // ParticleKind's

  // Those of a group, whose walls are to follow.
  void add(const GroupSums& group, std::uint32_t count_of_it) {
    float floats[std::size(decltype(sums){})][16];
    std::memcpy(floats, &group, sizeof floats);
    for (std::size_t sum = 0; sum < std::size(sums); ++sum) {
      for (std::uint32_t a = 0; a < 4 * count_of_it; ++a) sums[sum][a % 4][count + a / 4] = floats[sum][a];
    }
  }
};
enum GroupSum { kEven, kOdd, kSlope, kVelocity, kOffset, kCarried, kCarriedOdd, kCarriedBack };

// of(sum, k): the k-th float of a particle's, or of a batch of them.
template <class Real, class F>
Symmetric<Real> moment_of(F&& of) {
  return {of(kEven, 0), of(kOdd, 0), of(kOdd, 2), of(kEven, 1), of(kOdd, 1), of(kEven, 2)};
}
template <class Real, class F>
FlowSums<Real> flow_of(F&& of) {
  return {{of(kOffset, 0), of(kOffset, 1), of(kOffset, 2)},
          {of(kSlope, 0), of(kSlope, 1), of(kSlope, 2)},
          {{of(kCarried, 0), of(kCarriedBack, 1), of(kCarriedOdd, 2)},
           {of(kCarriedOdd, 0), of(kCarried, 1), of(kCarriedBack, 2)},
           {of(kCarriedBack, 0), of(kCarriedOdd, 1), of(kCarried, 2)}}};
}

// From the sums over particles' neighbours to their pressure tensors and damping.
template <bool flows, bool stresses>
class Finish {
 public:
  explicit Finish(const Work& work) : w_(work) {}

  // What walls add for p, in a lane of its block.
  void find_walls(std::uint32_t p, const NearRows& near, Block& block, std::size_t lane) const {
    const FloatBatch z(0.0f);
    WallSums walls{{z, {z, z, z, z, z, z}, z, z, z, z, z, z, z}, {z, z, z}, z};
    const auto& m = walls.sum.moment;
    const bool any = !near.empty();
    if (any) {
      add_walls<stresses>(w_, p, w_.fixed, near.fixed, walls);
      add_walls<stresses>(w_, p, w_.moving, near.moving, walls);
    }
    const auto put = [&](float(&to)[kLanes], const FloatBatch& sum) {
      to[lane] = any ? lane_sum(sum) : 0.0f;
    };
    put(block.number, walls.sum.number);
    put(block.moment[0], m.xx);
    put(block.moment[1], m.xy);
    put(block.moment[2], m.xz);
    put(block.moment[3], m.yy);
    put(block.moment[4], m.yz);
    put(block.moment[5], m.zz);
    put(block.slope[0], walls.slope.x);
    put(block.slope[1], walls.slope.y);
    put(block.slope[2], walls.slope.z);
    if constexpr (stresses) put(block.no_slip, walls.no_slip);
  }

  // Returns the largest compression.
  float operator()(const Block& block) const {
    const FluidParticles& fluid = w_.fluid;
    const CorrectionConstants& c = w_.context.correction;
    const auto of = [&](GroupSum sum, int k) { return FloatBatch::load_aligned(block.sums[sum][k]); };
    const FloatBatch v[3] = {load(fluid.vx, block.first), load(fluid.vy, block.first),
                             load(fluid.vz, block.first)};
    const FloatBatch none(0.0f), own(own_), viscosity = FloatBatch::load_aligned(block.viscosity);
    Neighborhood<FloatBatch> n{none, moment_of<FloatBatch>(of), none, none, none, none, none, none, none};
    n.number = n.fluid_number = of(kVelocity, 3) + own;
    n.vx = of(kVelocity, 0) + own * v[0];
    n.vy = of(kVelocity, 1) + own * v[1];
    n.vz = of(kVelocity, 2) + own * v[2];
    if constexpr (flows)
      follow_flow(flow_around(flow_of<FloatBatch>(of), v), inverse_moment(n.moment, c.rest_moment),
                  c.rest_moment, n);
    const auto wall = [](const float(&sum)[kLanes]) { return FloatBatch::load_aligned(sum); };
    n.number += wall(block.number);
    n.moment.xx += wall(block.moment[0]);
    n.moment.xy += wall(block.moment[1]);
    n.moment.xz += wall(block.moment[2]);
    n.moment.yy += wall(block.moment[3]);
    n.moment.yz += wall(block.moment[4]);
    n.moment.zz += wall(block.moment[5]);
    const Vector3<FloatBatch> pushed{of(kSlope, 0) + wall(block.slope[0]),
                                     of(kSlope, 1) + wall(block.slope[1]),
                                     of(kSlope, 2) + wall(block.slope[2])};
    const FloatBatch in_u = one_explicit_ ? viscosity : none;
    if (solved_) {
      const auto state = solved_state(n, c, viscosity, in_u, v);
      return keep(block, state, state.expansion, pushed);
    }
    const auto state = corrected_state(n, c, FloatBatch::load_aligned(block.density), viscosity, in_u,
                                       load(fluid.volume, block.first), v);
    return keep(block, state, state.pressure, pushed);
  }

 private:
  // What the two models find alike.
  template <class State>
  float keep(const Block& block, const State& state, FloatBatch pressure,
             const Vector3<FloatBatch>& pushed) const {
    FluidParticles& fluid = w_.fluid;
    const auto put = [&](Column<float>& column, FloatBatch x) {
      alignas(64) float floats[kLanes];
      x.store_aligned(floats);
      std::copy_n(floats, block.count, column.data() + block.first);
    };
    put(fluid.pressure, pressure);
    put(fluid.volume, state.volume);
    put(fluid.pxx, state.push.xx);
    put(fluid.pxy, state.push.xy);
    put(fluid.pxz, state.push.xz);
    put(fluid.pyy, state.push.yy);
    put(fluid.pyz, state.push.yz);
    put(fluid.pzz, state.push.zz);
    put(fluid.ux, state.u[0]);
    put(fluid.uy, state.u[1]);
    put(fluid.uz, state.u[2]);
    if (w_.context.plan.has(PassId::kPairViscosity))
      put(fluid.viscosity, FloatBatch::load_aligned(block.viscosity));
    const Symmetric<FloatBatch> t =
        scaled_and_shifted(state.push, FloatBatch(w_.context.force_scale), FloatBatch(0.0f));
    const Vector3<FloatBatch> by_own = times(t, pushed.x, pushed.y, pushed.z);
    const FloatBatch rows[] = {t.xx, t.yy,     t.zz,     t.xy,     t.yz,
                               t.xz, by_own.x, by_own.y, by_own.z, state.compression};
    alignas(64) float f[std::size(rows)][kLanes];
    for (std::size_t row = 0; row < std::size(rows); ++row) rows[row].store_aligned(f[row]);
    float densest = 0.0f;
    for (std::uint32_t a = 0; a < block.count; ++a) {
      const std::uint32_t p = block.first + a;
      w_.press.tensors[p] = {f[0][a], f[1][a], f[2][a], fluid.volume[p],
                             f[3][a], f[4][a], f[5][a], block.viscosity[a]};
      w_.press.own[p] = {f[6][a], f[7][a], f[8][a], 0.0f};
      w_.press.drags[p] = {fluid.ux[p], fluid.uy[p], fluid.uz[p], fluid.volume[p]};
      densest = std::max(densest, f[9][a]);
      if constexpr (stresses) pass_on(block, a);
    }
    return densest;
  }

  // What a particle passes on of a stress, behind keep().
  void pass_on(const Block& block, std::uint32_t a) const {
    const FluidParticles& fluid = w_.fluid;
    const std::uint32_t p = block.first + a;
    const float rest = w_.context.correction.rest_moment;
    const auto of = [&](GroupSum sum, int k) { return block.sums[sum][k][a]; };
    const float v[3] = {fluid.vx[p], fluid.vy[p], fluid.vz[p]}, number = of(kVelocity, 3);
    const auto apart = [&](int k) { return number * v[k] - of(kVelocity, k); };  // Σ W (v_p − v_i)
    const StressSums around{flow_around(flow_of<float>(of), v), number, {apart(0), apart(1), apart(2)}};
    const FluidStress found = fluid_stress(around, inverse_moment(moment_of<float>(of), rest),
                                           share_of_stress(block.no_slip[a] / w_.context.rest_volume, rest),
                                           rest, fluid.volume[p], block.viscosity[a]);
    const Matrix3<float>& t = found.push;
    const Vector3<float> own = times(t, of(kSlope, 0), of(kSlope, 1), of(kSlope, 2));
    w_.press.own_stress[p] = {own.x, own.y, own.z, 0.0f};
    Vector4& u = w_.press.drags[p];
    u = {u.x + found.rest.x, u.y + found.rest.y, u.z + found.rest.z, u.w};
    const PressureTensor k = solved_ ? PressureTensor{} : w_.press.tensors[p];
    w_.press.passed[p] = {{k.xx + t.x.x, k.yy + t.y.y, k.zz + t.z.z, u.w},
                          {k.xy + t.x.y, k.yz + t.y.z, k.xz + t.z.x, found.left},
                          {k.xz + t.x.z, k.xy + t.y.x, k.yz + t.z.y, 0.0f},
                          u};
  }

  using Kernel = ModelParts<ParticleModel::kCorrected>::DensityKernel;

  const Work& w_;
  // W(0) as pairs have it, with their floor: the pressure of a fluid at rest depends on the density's sixth
  // digit.
  const float own_ = Kernel::shape_of(Kernel::pair(0.0f, w_.context.support_radius, 1.0f));
  const bool solved_ = w_.context.plan.has(PassId::kPressureSolve);
  const bool one_explicit_ = w_.context.plan.explicit_viscosity() &&
                             w_.context.plan.has(PassId::kOneViscosity) &&
                             !w_.context.plan.has(PassId::kFluidStress);
};

}  // namespace slosh::corrected_density
