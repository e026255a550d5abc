// Eq 2 and 7 for the corrected model, with what pressure and noise need of the neighbours besides their
// number.
#include <algorithm>

#include "sim/cpu/passes.h"
#include "sim/cpu/pressure_rows.h"
#include "sim/cpu/row_batches.h"
#include "sim/model.h"
#include "sim/pressure/solved_state.h"
#include "sim/snapshot.h"
#include "sim/walls/wall_particles.h"

namespace slosh {

namespace {

constexpr std::size_t kRunsPerChunk = 32;

// What is written down beside the sums: nothing, or
struct NoRow {
  struct Writer {
    Writer(FluidPress&, std::size_t) {}
  };
  NoRow(Writer&, std::uint32_t) {}
  void add(std::uint32_t, const Vector3<FloatBatch>&, FloatBatch, FloatBatch) {}
  void add_wall(const Vector3<FloatBatch>&, FloatBatch, FloatBatch, FloatBatch) {}
  void end(const PassContext&, const FluidParticles&) {}
};

// who presses on whom, where pressures or drag are solved for: by fluid in rows, by all in the own vector.
class PressRow {
 public:
  struct Writer {
    Writer(FluidPress& p, std::size_t chunk) : press(p), rows(p.rows, chunk) {}
    FluidPress& press;
    PairRows::Writer rows;
  };
  PressRow(Writer& writer, std::uint32_t p) : writer_(writer), p_(p) { writer_.rows.begin(p); }
  void add(std::uint32_t j, const Vector3<FloatBatch>& d, FloatBatch h, FloatBatch weight) {
    const FloatBatch r_squared = d.x * d.x + d.y * d.y + d.z * d.z;
    const FloatBatch slope = Spiky::pair(r_squared, h, weight).slope_over_r;
    writer_.rows.add(j, slope, r_squared * slope);
    add(d, slope);
  }
  void add_wall(const Vector3<FloatBatch>& d, FloatBatch share, FloatBatch h, FloatBatch weight) {
    add(d, share * Spiky::pair(d.x * d.x + d.y * d.y + d.z * d.z, h, weight).slope_over_r);
  }
  void end(const PassContext& context, const FluidParticles& fluid) {
    writer_.rows.end();
    const float scale = context.force_scale;
    const PressTensor t{scale * fluid.pxx[p_],
                        scale * fluid.pyy[p_],
                        scale * fluid.pzz[p_],
                        fluid.volume[p_],
                        scale * fluid.pxy[p_],
                        scale * fluid.pyz[p_],
                        scale * fluid.pxz[p_],
                        context.kinds[fluid.kind[p_]].viscosity};
    const float x = lane_sum(sum_.x), y = lane_sum(sum_.y), z = lane_sum(sum_.z);
    writer_.press.places[p_] = {fluid.x[p_], fluid.y[p_], fluid.z[p_], 0.0f};
    writer_.press.drags[p_] = {fluid.ux[p_], fluid.uy[p_], fluid.uz[p_], fluid.volume[p_]};
    writer_.press.tensors[p_] = t;
    writer_.press.own[p_] = {t.xx * x + t.xy * y + t.xz * z, t.xy * x + t.yy * y + t.yz * z,
                             t.xz * x + t.yz * y + t.zz * z, 0.0f};
  }

 private:
  void add(const Vector3<FloatBatch>& d, FloatBatch factor) {
    sum_.x += factor * d.x;
    sum_.y += factor * d.y;
    sum_.z += factor * d.z;
  }
  Writer& writer_;
  const std::uint32_t p_;
  Vector3<FloatBatch> sum_{FloatBatch(0.0f), FloatBatch(0.0f), FloatBatch(0.0f)};
};

// The corrected model's pass: what pressure and noise need of the neighbours besides their number.
template <class Row>
class CorrectedDensity {
 public:
  CorrectedDensity(PassContext& context, FluidParticles& fluid, const BoundaryParticles& fixed,
                   const BoundaryParticles& moving)
      : context_(context), fluid_(fluid), fixed_(fixed), moving_(moving) {}

  // One run of particles of a cell; returns the largest compression. All of it in one loop: left to itself
  // the compiler calls functions where rows are written, and hands batches over in memory.
  __attribute__((flatten)) float operator()(const CellRun& run, typename Row::Writer& writer) const {
    const RowList rows = fluid_.index.rows(context_.grid, run.cell);
    const RowList fixed_rows = fixed_.index.rows(context_.grid, run.cell);
    const RowList moving_rows = moving_.index.rows(context_.grid, run.cell);
    float densest = 0.0f;
    for (std::uint32_t p = run.particles.begin; p < run.particles.end; ++p) {
      Neighborhood<FloatBatch> sum = zero();
      Row row(writer, p);
      add_fluid(p, rows, sum, row);
      add_walls(p, fixed_, fixed_rows, sum, row);
      add_walls(p, moving_, moving_rows, sum, row);
      densest = std::max(densest, finish(p, sum));
      row.end(context_, fluid_);
    }
    return densest;
  }

 private:
  using Kernel = ModelParts<ParticleModel::kCorrected>::DensityKernel;

  static Neighborhood<FloatBatch> zero() {
    const FloatBatch z(0.0f);
    return {z, {z, z, z, z, z, z}, z, z, z, z};
  }

  void add_fluid(std::uint32_t p, const RowList& rows, Neighborhood<FloatBatch>& sum, Row& row) const {
    const FloatBatch x(fluid_.x[p]), y(fluid_.y[p]), z(fluid_.z[p]), h(context_.support_radius);
    for_each_batch(rows, [&](std::uint32_t j, FloatBatch weight) {
      const Vector3<FloatBatch> d{x - load(fluid_.x, j), y - load(fluid_.y, j), z - load(fluid_.z, j)};
      add_fluid_neighbor<Kernel>(d.x, d.y, d.z, load(fluid_.vx, j), load(fluid_.vy, j), load(fluid_.vz, j), h,
                                 weight, sum);
      row.add(j, d, h, weight);
    });
  }

  void add_walls(std::uint32_t p, const BoundaryParticles& walls, const RowList& rows,
                 Neighborhood<FloatBatch>& sum, Row& row) const {
    if (rows.count == 0) return;
    const FloatBatch x(fluid_.x[p]), y(fluid_.y[p]), z(fluid_.z[p]), h(context_.support_radius);
    for_each_batch(rows, [&](std::uint32_t j, FloatBatch weight) {
      const FloatBatch share = load(walls.pressure, j);
      const Vector3<FloatBatch> d{x - load(walls.x, j), y - load(walls.y, j), z - load(walls.z, j)};
      add_wall_neighbor<Kernel>(d.x, d.y, d.z, share, FloatBatch(1.0f / kWallShare) * share, h, weight, sum);
      row.add_wall(d, share, h, weight);
    });
  }

  float finish(std::uint32_t p, const Neighborhood<FloatBatch>& batch) const {
    const auto& m = batch.moment;
    const Neighborhood<float> n{
        lane_sum(batch.number),
        {lane_sum(m.xx), lane_sum(m.xy), lane_sum(m.xz), lane_sum(m.yy), lane_sum(m.yz), lane_sum(m.zz)},
        lane_sum(batch.fluid_number),
        lane_sum(batch.vx),
        lane_sum(batch.vy),
        lane_sum(batch.vz)};
    const ParticleKind& kind = context_.kinds[fluid_.kind[p]];
    const float in_u = one_explicit_ ? kind.viscosity : 0.0f;
    const float v[3] = {fluid_.vx[p], fluid_.vy[p], fluid_.vz[p]};
    if (context_.plan.has(PassId::kPressureSolve)) {
      const SolvedState state = solved_state(n, context_.correction, kind.viscosity, in_u, v);
      fluid_.pressure[p] = state.expansion;
      return keep(p, kind, state);
    }
    const CorrectedState state = corrected_state(n, context_.correction, kind.pressing_density,
                                                 kind.viscosity, in_u, fluid_.volume[p], v);
    fluid_.pressure[p] = state.pressure;
    return keep(p, kind, state);
  }

  // What the two models find alike.
  template <class State>
  float keep(std::uint32_t p, const ParticleKind& kind, const State& state) const {
    fluid_.volume[p] = state.volume;
    fluid_.pxx[p] = state.push.xx;
    fluid_.pxy[p] = state.push.xy;
    fluid_.pxz[p] = state.push.xz;
    fluid_.pyy[p] = state.push.yy;
    fluid_.pyz[p] = state.push.yz;
    fluid_.pzz[p] = state.push.zz;
    fluid_.ux[p] = state.u[0];
    fluid_.uy[p] = state.u[1];
    fluid_.uz[p] = state.u[2];
    if (context_.plan.has(PassId::kPairViscosity)) fluid_.viscosity[p] = kind.viscosity;
    return state.compression;
  }

  static FloatBatch load(const Column<float>& column, std::uint32_t j) {
    return FloatBatch::load_unaligned(column.data() + j);
  }

  PassContext& context_;
  const bool one_explicit_ = context_.plan.drags_explicitly() && context_.plan.has(PassId::kOneViscosity);
  FluidParticles& fluid_;
  const BoundaryParticles &fixed_, &moving_;
};

template <class Row>
void find(PassContext& context, ThreadTeam& team, FluidParticles& fluid, const BoundaryParticles& fixed,
          const BoundaryParticles& moving, FluidPress& press) {
  const std::vector<CellRun>& runs = fluid.index.runs();
  const CorrectedDensity<Row> pass(context, fluid, fixed, moving);
  team.run(runs.size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
    typename Row::Writer writer(press, begin / kRunsPerChunk);
    float densest = 0.0f;
    for (std::size_t r = begin; r < end; ++r) densest = std::max(densest, pass(runs[r], writer));
    if (densest > kTooCompressed) context.status.fetch_or(kStatusCompressed, std::memory_order_relaxed);
  });
}

}  // namespace

void compute_corrected_density(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                               const BoundaryParticles& fixed, const BoundaryParticles& moving,
                               FluidPress& press) {
  if (!context.plan.has(PassId::kPressureSolve) && !context.plan.has(PassId::kImplicitDrag)) {
    find<NoRow>(context, team, fluid, fixed, moving, press);
    return;
  }
  press.clear(fluid.index.particles(), chunk_count(fluid.index.runs().size(), kRunsPerChunk));
  find<PressRow>(context, team, fluid, fixed, moving, press);
}

}  // namespace slosh
