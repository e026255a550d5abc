// Eq 2 and 7 for the corrected model, with what pressure and noise need of the neighbours besides their
// number.
#include <algorithm>

#include "sim/cpu/passes.h"
#include "sim/cpu/row_batches.h"
#include "sim/model.h"
#include "sim/pressure/solved_state.h"
#include "sim/snapshot.h"
#include "sim/walls/wall_particles.h"

namespace slosh {

namespace {

constexpr std::size_t kRunsPerChunk = 32;

// The corrected model's pass: what pressure and noise need of the neighbours besides their number.
class CorrectedDensity {
 public:
  CorrectedDensity(PassContext& context, FluidParticles& fluid, const BoundaryParticles& fixed,
                   const BoundaryParticles& moving)
      : context_(context), fluid_(fluid), fixed_(fixed), moving_(moving) {}

  // One run of particles of a cell; returns the largest compression.
  float operator()(const CellRun& run) const {
    const RowList rows = fluid_.index.rows(context_.grid, run.cell);
    const RowList fixed_rows = fixed_.index.rows(context_.grid, run.cell);
    const RowList moving_rows = moving_.index.rows(context_.grid, run.cell);
    float densest = 0.0f;
    for (std::uint32_t p = run.particles.begin; p < run.particles.end; ++p) {
      Neighborhood<FloatBatch> sum = zero();
      add_fluid(p, rows, sum);
      add_walls(p, fixed_, fixed_rows, sum);
      add_walls(p, moving_, moving_rows, sum);
      densest = std::max(densest, finish(p, sum));
    }
    return densest;
  }

 private:
  using Kernel = ModelParts<ParticleModel::kCorrected>::DensityKernel;

  static Neighborhood<FloatBatch> zero() {
    const FloatBatch z(0.0f);
    return {z, {z, z, z, z, z, z}, z, z, z, z};
  }

  void add_fluid(std::uint32_t p, const RowList& rows, Neighborhood<FloatBatch>& sum) const {
    const FloatBatch x(fluid_.x[p]), y(fluid_.y[p]), z(fluid_.z[p]), h(context_.support_radius);
    for_each_batch(rows, [&](std::uint32_t j, FloatBatch weight) {
      add_fluid_neighbor<Kernel>(x - load(fluid_.x, j), y - load(fluid_.y, j), z - load(fluid_.z, j),
                                 load(fluid_.vx, j), load(fluid_.vy, j), load(fluid_.vz, j), h, weight, sum);
    });
  }

  void add_walls(std::uint32_t p, const BoundaryParticles& walls, const RowList& rows,
                 Neighborhood<FloatBatch>& sum) const {
    if (rows.count == 0) return;
    const FloatBatch x(fluid_.x[p]), y(fluid_.y[p]), z(fluid_.z[p]), h(context_.support_radius);
    for_each_batch(rows, [&](std::uint32_t j, FloatBatch weight) {
      const FloatBatch share = load(walls.pressure, j);
      add_wall_neighbor<Kernel>(x - load(walls.x, j), y - load(walls.y, j), z - load(walls.z, j), share,
                                FloatBatch(1.0f / kWallShare) * share, h, weight, sum);
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

}  // namespace

void compute_corrected_density(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                               const BoundaryParticles& fixed, const BoundaryParticles& moving) {
  const std::vector<CellRun>& runs = fluid.index.runs();
  const CorrectedDensity pass(context, fluid, fixed, moving);
  team.run(runs.size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
    float densest = 0.0f;
    for (std::size_t r = begin; r < end; ++r) densest = std::max(densest, pass(runs[r]));
    if (densest > kTooCompressed) context.status.fetch_or(kStatusCompressed, std::memory_order_relaxed);
  });
}

}  // namespace slosh
