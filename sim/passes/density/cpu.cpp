// Eq 2 and 7. Density is counted in numbers of neighbours (Solenthaler & Pajarola 2008: ρ_p = m_p Σ W) rather
// than in their masses: for one fluid the two are the same, and where two fluids touch a light particle is
// not taken for dense because its neighbours are heavy. It is measured against the rest lattice, so that a
// fluid at rest has its rest density whatever the support ratio.
#include "sim/cpu/passes.h"
#include "sim/cpu/state.h"
#include "sim/model.h"
#include "sim/passes/density/equation_of_state.h"
#include "sim/snapshot.h"

namespace slosh {

namespace {

constexpr std::size_t kRunsPerChunk = 32;

// Σ shape over rows.
template <class Kernel>
FloatBatch sum_fluid(const RowList& rows, const FluidParticles& fluid, std::uint32_t p,
                     float support_radius) {
  const FloatBatch x(fluid.x[p]), y(fluid.y[p]), z(fluid.z[p]);
  const Support<FloatBatch> support{FloatBatch(support_radius), FloatBatch(support_radius * support_radius)};
  const auto shape = [&](std::uint32_t j) {
    const FloatBatch dx = x - FloatBatch::load_unaligned(fluid.x.data() + j);
    const FloatBatch dy = y - FloatBatch::load_unaligned(fluid.y.data() + j);
    const FloatBatch dz = z - FloatBatch::load_unaligned(fluid.z.data() + j);
    return Kernel::shape(dx * dx + dy * dy + dz * dz, support);
  };
  FloatBatch sum(0.0f);
  for (int row = 0; row < rows.count; ++row) {
    const ParticleRange range = rows.rows[row];
    std::uint32_t j = range.begin;
    for (; j + kLanes <= range.end; j += kLanes) sum += shape(j);
    if (j < range.end) sum += first_lanes(range.end - j) * shape(j);
  }
  return sum;
}

// The published model's: bodies do not count.
template <class Parts>
void compute_density_of(PassContext& context, ThreadTeam& team, FluidParticles& fluid) {
  using Kernel = typename Parts::DensityKernel;
  const std::vector<CellRun>& runs = fluid.index.runs();
  const float h = context.support_radius;
  const float stiffness = static_cast<float>(context.plan.stiffness);
  const float tension = static_cast<float>(context.plan.tension);
  const bool viscosities = context.plan.has(PassId::kPairViscosity);
  team.run(runs.size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
    float densest = 0.0f;
    for (std::size_t r = begin; r < end; ++r) {
      const RowList rows = fluid.index.rows(context.grid, runs[r].cell);
      for (std::uint32_t p = runs[r].particles.begin; p < runs[r].particles.end; ++p) {
        const FloatBatch sum = sum_fluid<Kernel>(rows, fluid, p, h);
        const ParticleKind& kind = context.kinds[fluid.kind[p]];
        const PressureState state =
            pressure_state(lane_sum(sum), context.rest_number_density, context.rest_volume,
                           kind.pressing_density, stiffness, tension, fluid.volume[p], false);
        densest = std::max(densest, state.compression);
        fluid.pressure[p] = state.pressure;
        fluid.volume[p] = state.volume;
        if (viscosities) fluid.viscosity[p] = particle_viscosity(context, fluid, p);
      }
    }
    if (densest > kTooCompressed) context.status.fetch_or(kStatusCompressed, std::memory_order_relaxed);
  });
}

}  // namespace

void compute_density(PassContext& context, ThreadTeam& team, FluidParticles& fluid,
                     const BoundaryParticles& fixed, const BoundaryParticles& moving, FluidPress& press) {
  with_model(context.plan.model, [&]<class Parts>() {
    if constexpr (Parts::kCorrected) {
      compute_corrected_density(context, team, fluid, fixed, moving, press);
    } else {
      compute_density_of<Parts>(context, team, fluid);
    }
  });
}

namespace passes {

void density_on_cpu(CpuState& s, const PassInputs&) {
  compute_density(s.context, s.team, s.fluid, s.fixed.sorted(), s.moving.sorted(), s.pairs);
}

}  // namespace passes

}  // namespace slosh
