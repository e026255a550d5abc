// Eq 2 and 7 for the corrected model, with what pressure and artificial viscosity need of the neighbours
// besides their number.
#include <algorithm>
#include <cstring>

#include "sim/cpu/passes.h"
#include "sim/model.h"
#include "sim/passes/fluid_stress/fluid_stress.h"
#include "sim/passes/pressure_solve/cpu_pairs.h"
#include "sim/passes/pressure_solve/solved_state.h"
#include "sim/snapshot.h"
#include "sim/walls/wall_particles.h"

namespace slosh {

namespace {

constexpr std::size_t kRunsPerChunk = 32;

// What the pass goes through.
struct Work {
  PassContext& context;
  FluidParticles& fluid;
  const BoundaryParticles &fixed, &moving;
  FluidPress& press;
};

FloatBatch load(const Column<float>& column, std::uint32_t j) {
  return FloatBatch::load_unaligned(column.data() + j);
}

// Where everybody is and goes, as the walks over rows take it.
void place(const Work& w, ThreadTeam& team) {
  constexpr std::size_t kParticlesPerChunk = 2048;
  const FluidParticles& fluid = w.fluid;
  // Nobody, who fills rows up, is out of everyone's reach.
  constexpr float kFar = 1e9f;
  w.press.places[fluid.index.particles()] = {kFar, kFar, kFar, 0.0f};
  team.run(fluid.index.particles(), kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      w.press.places[p] = {fluid.x[p], fluid.y[p], fluid.z[p], 0.0f};
      w.press.velocities[p] = {fluid.vx[p], fluid.vy[p], fluid.vz[p], 1.0f};
    }
  });
}

// Those of the candidates that p has in reach, itself left out, into p's row.
bool write_row(const Work& w, std::uint32_t p, const RowList& rows, PairRows::Writer& writer) {
  // Columns of one's own: what is written may lie anywhere, for all that the compiler knows.
  const float *const xs = w.fluid.x.data(), *const ys = w.fluid.y.data(), *const zs = w.fluid.z.data();
  const FloatBatch x(xs[p]), y(ys[p]), z(zs[p]);
  const float h = w.context.support_radius;
  const FloatBatch h_squared(h * h);
  std::uint32_t candidates = 0;
  for (int row = 0; row < rows.count; ++row) candidates += rows.rows[row].end - rows.rows[row].begin;
  std::int32_t* to = writer.begin(p, candidates);
  for (int row = 0; row < rows.count; ++row) {
    const ParticleRange range = rows.rows[row];
    for (std::uint32_t j = range.begin; j < range.end; j += kLanes) {
      const FloatBatch dx = x - FloatBatch::load_unaligned(xs + j);
      const FloatBatch dy = y - FloatBatch::load_unaligned(ys + j);
      const FloatBatch dz = z - FloatBatch::load_unaligned(zs + j);
      PickedLanes picked = lanes_less(dx * dx + dy * dy + dz * dz, h_squared);
      if (range.end - j < kLanes) picked &= (PickedLanes{1} << (range.end - j)) - 1;
      if (p - j < kLanes) picked &= ~(PickedLanes{1} << (p - j));
      store_picked_indices(j, picked, to);
      to += count_of(picked);
    }
  }
  return writer.end_at(to);
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
template <bool flows>
PairRows::Walk weigh(const Work& w, PairRows::Writer& writer, GroupSums& sum) {
  const float h = w.context.support_radius, floor = h * h * 1e-12f;
  const float* const places = &w.press.places[0].x;
  const float* const velocities = &w.press.velocities[0].x;
  Sixteen even = {}, odd = {}, slopes = {}, velocity = {};
  Sixteen offset = {}, carried = {}, carried_odd = {}, carried_back = {};
  const auto nobody = static_cast<std::uint32_t>(w.fluid.index.particles());
  const Sixteen self = PairRows::Walk::of_group<4>(places + std::size_t{4} * writer.first());
  const PairRows::Walk group = writer.put_weighed(nobody, [&](const PairRows::Others& others) {
    const Sixteen d = self - PairRows::Walk::of_others<4>(places, others);
    const Sixteen r_squared = sums(d * d) + floor, inverse_r = inverse_roots(r_squared);
    const Sixteen reach = at_least_zero(h - r_squared * inverse_r);
    const Sixteen squared = reach * reach, slope = squared * inverse_r, weighed = slope * d;
    even += weighed * d;
    odd += weighed * turned(d);
    slopes += weighed;
    const Sixteen near = squared * reach, v = PairRows::Walk::of_others<4>(velocities, others);
    velocity += near * v;
    if constexpr (flows) {
      offset += near * d;
      carried += weighed * v;
      carried_odd += weighed * turned(v);
      carried_back += weighed * turned_back(v);
    }
    return slope;
  });
  sum = {even, odd, slopes, velocity, offset, carried, carried_odd, carried_back};
  return group;
}

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

// One particle's four floats of each of its group's sums.
struct OwnSums {
  const float *even, *odd, *slope, *velocity, *offset, *carried, *carried_odd, *carried_back;
};

// From the sums over one particle's neighbours to its pressure tensor and damping.
template <bool flows, bool stresses>
class Finish {
 public:
  explicit Finish(const Work& work) : w_(work) {}

  // Returns the compression.
  float operator()(std::uint32_t p, const OwnSums& s, const NearRows& near) const {
    const FluidParticles& fluid = w_.fluid;
    const float own = own_;
    const float v[3] = {fluid.vx[p], fluid.vy[p], fluid.vz[p]};
    Neighborhood<float> n{};
    StressSums around;
    InverseMoment moment;
    n.number = n.fluid_number = s.velocity[3] + own;
    n.moment = {s.even[0], s.odd[0], s.odd[2], s.even[1], s.odd[1], s.even[2]};
    n.vx = s.velocity[0] + own * v[0];
    n.vy = s.velocity[1] + own * v[1];
    n.vz = s.velocity[2] + own * v[2];
    if constexpr (flows) {
      const FlowSums<float> flow{{s.offset[0], s.offset[1], s.offset[2]},
                                 {s.slope[0], s.slope[1], s.slope[2]},
                                 {{s.carried[0], s.carried_back[1], s.carried_odd[2]},
                                  {s.carried_odd[0], s.carried[1], s.carried_back[2]},
                                  {s.carried_back[0], s.carried_odd[1], s.carried[2]}}};
      const float rest = w_.context.correction.rest_moment;
      around = {flow_around(flow, v), s.velocity[3], apart(s, v)};
      moment = inverse_moment(n.moment, rest);
      follow_flow(around.flow, moment, rest, n);
    }
    float no_slip = 0.0f;
    const Vector3<float> by_fluid{s.slope[0], s.slope[1], s.slope[2]};
    Vector3<float> pushed = by_fluid;
    if (!near.empty()) {
      const FloatBatch z(0.0f);
      WallSums walls{{z, {z, z, z, z, z, z}, z, z, z, z, z, z, z}, {z, z, z}, z};
      add_walls<stresses>(w_, p, w_.fixed, near.fixed, walls);
      add_walls<stresses>(w_, p, w_.moving, near.moving, walls);
      if constexpr (stresses) no_slip = lane_sum(walls.no_slip) / w_.context.rest_volume;
      n.number += lane_sum(walls.sum.number);
      const auto& m = walls.sum.moment;
      n.moment.xx += lane_sum(m.xx);
      n.moment.xy += lane_sum(m.xy);
      n.moment.xz += lane_sum(m.xz);
      n.moment.yy += lane_sum(m.yy);
      n.moment.yz += lane_sum(m.yz);
      n.moment.zz += lane_sum(m.zz);
      pushed.x += lane_sum(walls.slope.x);
      pushed.y += lane_sum(walls.slope.y);
      pushed.z += lane_sum(walls.slope.z);
    }
    const ParticleKind& kind = w_.context.kinds[fluid.kind[p]];
    const float in_u = one_explicit_ ? kind.viscosity : 0.0f;
    if (solved_) {
      const SolvedState state = solved_state(n, w_.context.correction, kind.viscosity, in_u, v);
      keep(p, kind, state, state.expansion, pushed);
      if constexpr (stresses) pass_on(p, kind, around, moment, no_slip, by_fluid);
      return state.compression;
    }
    const CorrectedState state = corrected_state(n, w_.context.correction, kind.pressing_density,
                                                 kind.viscosity, in_u, fluid.volume[p], v);
    keep(p, kind, state, state.pressure, pushed);
    if constexpr (stresses) pass_on(p, kind, around, moment, no_slip, by_fluid);
    return state.compression;
  }

 private:
  // Σ W (v_p − v_i) over fluid.
  static Vector3<float> apart(const OwnSums& s, const float (&v)[3]) {
    return {s.velocity[3] * v[0] - s.velocity[0], s.velocity[3] * v[1] - s.velocity[1],
            s.velocity[3] * v[2] - s.velocity[2]};
  }

  // What the two models find alike.
  template <class State>
  void keep(std::uint32_t p, const ParticleKind& kind, const State& state, float pressure,
            const Vector3<float>& pushed) const {
    FluidParticles& fluid = w_.fluid;
    fluid.pressure[p] = pressure;
    fluid.volume[p] = state.volume;
    fluid.pxx[p] = state.push.xx;
    fluid.pxy[p] = state.push.xy;
    fluid.pxz[p] = state.push.xz;
    fluid.pyy[p] = state.push.yy;
    fluid.pyz[p] = state.push.yz;
    fluid.pzz[p] = state.push.zz;
    fluid.ux[p] = state.u[0];
    fluid.uy[p] = state.u[1];
    fluid.uz[p] = state.u[2];
    if (w_.context.plan.has(PassId::kPairViscosity)) fluid.viscosity[p] = kind.viscosity;
    const Symmetric<float> t = scaled_and_shifted(state.push, w_.context.force_scale, 0.0f);
    const Vector3<float> by_own = times(t, pushed.x, pushed.y, pushed.z);
    w_.press.tensors[p] = {t.xx, t.yy, t.zz, state.volume, t.xy, t.yz, t.xz, kind.viscosity};
    w_.press.own[p] = {by_own.x, by_own.y, by_own.z, 0.0f};
    w_.press.drags[p] = {state.u[0], state.u[1], state.u[2], state.volume};
  }

  // What it passes on of a stress, behind keep(). `by_fluid`: Σ d (−W'/r) over fluid.
  void pass_on(std::uint32_t p, const ParticleKind& kind, const StressSums& around,
               const InverseMoment& moment, float no_slip, const Vector3<float>& by_fluid) const {
    const float rest = w_.context.correction.rest_moment;
    const FluidStress found = fluid_stress(around, moment, share_of_stress(no_slip, rest), rest,
                                           w_.fluid.volume[p], kind.viscosity);
    const Matrix3<float>& t = found.push;
    const Vector3<float> own = times(t, by_fluid.x, by_fluid.y, by_fluid.z);
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

// One chunk of runs; returns the largest compression. All of it in one loop: left to itself the compiler
// calls functions where rows are written, and hands batches over in memory.
template <bool flows, bool stresses>
__attribute__((flatten)) float find_chunk(const Work& w, std::size_t begin, std::size_t end) {
  const std::vector<CellRun>& runs = w.fluid.index.runs();
  const CellGrid& grid = w.context.grid;
  const Finish<flows, stresses> finish(w);
  PairRows::Writer writer(w.press.rows, begin / kRunsPerChunk);
  float densest = 0.0f;
  std::size_t found = begin;  // runs whose NearRows are there
  const auto put = [&] {
    GroupSums sums;
    const PairRows::Walk group = weigh<flows>(w, writer, sums);
    float floats[sizeof sums / sizeof(Sixteen)][16];
    std::memcpy(floats, &sums, sizeof sums);
    for (std::uint32_t a = 0; a < group.count; ++a) {
      const std::uint32_t p = group.first + a;
      if (found == begin || p >= runs[found - 1].particles.end) {
        w.press.near[found].find(grid, w.fluid, runs[found], w.fixed, w.moving);
        ++found;
      }
      const auto own = [&](int sum) { return floats[sum] + 4 * a; };
      densest = std::max(densest, finish(p, {own(0), own(1), own(2), own(3), own(4), own(5), own(6), own(7)},
                                         w.press.near[found - 1]));
    }
  };
  for (std::size_t r = begin; r < end; ++r) {
    const RowList rows = w.fluid.index.rows(grid, runs[r].cell);
    for (std::uint32_t p = runs[r].particles.begin; p < runs[r].particles.end; ++p) {
      if (write_row(w, p, rows, writer)) put();
    }
  }
  if (writer.waits()) put();
  return densest;
}

}  // namespace

void compute_corrected_density(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                               const BoundaryParticles& fixed, const BoundaryParticles& moving,
                               FluidPress& press) {
  const Work work{context, fluid, fixed, moving, press};
  const std::size_t runs = fluid.index.runs().size();
  press.clear(fluid.index.particles(), chunk_count(runs, kRunsPerChunk));
  if (press.near.size() < runs) press.near.resize(runs);
  place(work, team);
  const bool flows = any_artificial_viscosity(context.kinds, context.correction.artificial_viscosity);
  const bool stresses = context.plan.has(PassId::kFluidStress);
  if (stresses) press.make_passed(fluid.index.particles());
  const auto find = stresses ? find_chunk<true, true>
                    : flows  ? find_chunk<true, false>
                             : find_chunk<false, false>;
  team.run(runs, kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
    if (find(work, begin, end) > kTooCompressed)
      context.status.fetch_or(kStatusCompressed, std::memory_order_relaxed);
  });
}

}  // namespace slosh
