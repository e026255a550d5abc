// Conduction and setting (conduction.h).
#include "sim/cpu/passes.h"
#include "sim/cpu/row_batches.h"
#include "sim/cpu/state.h"

namespace slosh {
namespace {

constexpr std::size_t kRunsPerChunk = 32;
constexpr std::size_t kParticlesPerChunk = 2048;

class Conduction {
 public:
  explicit Conduction(const CpuState& s) : s_(s), c_(s.context.heat) {}

  /// W, of a particle by the fluid in `rows`.
  float by_fluid(std::uint32_t p, const RowList& rows) const {
    const FluidParticles& f = s_.fluid;
    const HeatKind& own = c_.kinds[f.kind[p]];
    const FloatBatch x(f.x[p]), y(f.y[p]), z(f.z[p]), t(f.temperature[p]), h(s_.context.support_radius);
    const FloatBatch conductivity(own.conductivity);
    FloatBatch sum(0.0f);
    for_each_batch(rows, [&](std::uint32_t j, FloatBatch weight) {
      const auto at = [j](const Column<float>& column) {
        return FloatBatch::load_unaligned(column.data() + j);
      };
      const FloatBatch dx = x - at(f.x), dy = y - at(f.y), dz = z - at(f.z);
      const FloatBatch reach =
          kernel_reach(RealOps<FloatBatch>::root(dx * dx + dy * dy + dz * dz), h) * weight;
      const FloatBatch warmer = at(f.temperature) - t;
      sum += (c_.one ? conductivity : between(conductivity, conductivities(j))) * reach * warmer;
    });
    return c_.pair_scale * lane_sum(sum);
  }

  /// W, of a particle by the walls in `rows`.
  float by_walls(std::uint32_t p, const BoundaryParticles& walls, const RowList& rows) const {
    const FluidParticles& f = s_.fluid;
    float sum = 0.0f;
    for (int row = 0; row < rows.count; ++row) {
      for (std::uint32_t j = rows.rows[row].begin; j < rows.rows[row].end; ++j) {
        const float warm = c_.bodies[walls.body[j]];
        if (std::isnan(warm)) continue;
        const float dx = f.x[p] - walls.x[j], dy = f.y[p] - walls.y[j], dz = f.z[p] - walls.z[j];
        const float reach = kernel_reach(std::sqrt(dx * dx + dy * dy + dz * dz), walls.reach[j]);
        sum += (c_.by_volume ? walls.volume[j] : walls.pressure[j]) * reach * (warm - f.temperature[p]);
      }
    }
    return c_.kinds[f.kind[p]].conductivity * (c_.wall_scale / c_.share_unit) * sum;
  }

 private:
  FloatBatch conductivities(std::uint32_t j) const {
    alignas(64) float found[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      found[lane] = c_.kinds[s_.fluid.kind[j + lane]].conductivity;
    return FloatBatch::load_aligned(found);
  }

  const CpuState& s_;
  const HeatConstants& c_;
};

void find_heating(CpuState& s) {
  const Conduction conduction(s);
  const std::vector<CellRun>& runs = s.fluid.index.runs();
  s.team.run(runs.size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      const CellGrid& grid = s.context.grid;
      const RowList rows = s.fluid.index.rows(grid, runs[r].cell);
      const RowList fixed = s.fixed.sorted().index.rows(grid, runs[r].cell);
      const RowList moving = s.moving.sorted().index.rows(grid, runs[r].cell);
      for (std::uint32_t p = runs[r].particles.begin; p < runs[r].particles.end; ++p) {
        s.fluid.body_heating[p] = conduction.by_walls(p, s.fixed.sorted(), fixed) +
                                  conduction.by_walls(p, s.moving.sorted(), moving);
        s.fluid.heating[p] = conduction.by_fluid(p, rows) + s.fluid.body_heating[p];
      }
    }
  });
}

}  // namespace

namespace passes {

/// With no time only the viscosities follow.
void heat_on_cpu(CpuState& s, const PassInputs& in) {
  const auto dt = static_cast<float>(in.dt);
  if (dt > 0.0f) find_heating(s);
  FluidParticles& f = s.fluid;
  s.team.run(f.active, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const HeatKind& kind = s.context.heat.kinds[f.kind[p]];
      if (dt > 0.0f) {
        f.temperature[p] += f.heating[p] * dt / kind.capacity;
        f.from_bodies[p] += f.body_heating[p] * dt;
        f.cure[p] = cure_after(kind, f.temperature[p], f.cure[p], dt);
      }
      f.thickness[p] = thickness_of(kind, s.context.kinds[f.kind[p]].viscosity, f.temperature[p], f.cure[p]);
    }
  });
}

}  // namespace passes
}  // namespace slosh
