// Eq 2 and 7 for the corrected model, with what pressure and artificial viscosity need of the neighbours
// besides their number.
#include <algorithm>

#include "sim/passes/density/cpu_block.h"
#include "sim/snapshot.h"

namespace slosh {

using namespace corrected_density;

namespace {

constexpr std::size_t kRunsPerChunk = 32;

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

// Those of the candidates that p, p + 1, … of one cell have in reach, themselves left out, into their rows:
// what is loaded of a candidate serves all. True where the last of them was a group's.
template <std::uint32_t together>
bool write_rows(const Work& w, std::uint32_t p, const RowList& rows, PairRows::Writer& writer) {
  // Columns of one's own: what is written may lie anywhere, for all that the compiler knows.
  const float *const xs = w.fluid.x.data(), *const ys = w.fluid.y.data(), *const zs = w.fluid.z.data();
  const float h = w.context.support_radius;
  const FloatBatch h_squared(h * h);
  std::uint32_t candidates = 0;
  for (int row = 0; row < rows.count; ++row) candidates += rows.rows[row].end - rows.rows[row].begin;
  std::int32_t* to[together];
  FloatBatch x[together], y[together], z[together];
  for (std::uint32_t a = 0; a < together; ++a) {
    to[a] = writer.begin(p + a, candidates, a);
    x[a] = FloatBatch(xs[p + a]);
    y[a] = FloatBatch(ys[p + a]);
    z[a] = FloatBatch(zs[p + a]);
  }
  for (int row = 0; row < rows.count; ++row) {
    const ParticleRange range = rows.rows[row];
    for (std::uint32_t j = range.begin; j < range.end; j += kLanes) {
      const FloatBatch of_x = FloatBatch::load_unaligned(xs + j), of_y = FloatBatch::load_unaligned(ys + j),
                       of_z = FloatBatch::load_unaligned(zs + j);
      const PickedLanes there =
          range.end - j < kLanes ? (PickedLanes{1} << (range.end - j)) - 1 : ~PickedLanes{0};
      for (std::uint32_t a = 0; a < together; ++a) {
        const FloatBatch dx = x[a] - of_x, dy = y[a] - of_y, dz = z[a] - of_z;
        PickedLanes picked = there & lanes_less(dx * dx + dy * dy + dz * dz, h_squared);
        if (p + a - j < kLanes) picked &= ~(PickedLanes{1} << (p + a - j));
        store_picked_indices(j, picked, to[a]);
        to[a] += count_of(picked);
      }
    }
  }
  bool full = false;
  for (std::uint32_t a = 0; a < together; ++a) full = writer.end_at(to[a]);
  return full;
}

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
  Block block{};
  const auto close_block = [&] {
    densest = std::max(densest, finish(block));
    block.count = 0;
  };
  const auto put = [&] {
    GroupSums sums;
    const PairRows::Walk group = weigh<flows>(w, writer, sums);
    if (block.count == 0) block.first = group.first;
    block.add(sums, group.count);
    for (std::uint32_t a = 0; a < group.count; ++a) {
      const std::uint32_t p = group.first + a;
      if (found == begin || p >= runs[found - 1].particles.end) {
        w.press.near[found].find(grid, w.fluid, runs[found], w.fixed, w.moving);
        ++found;
      }
      const ParticleKind& kind = w.context.kinds[w.fluid.kind[p]];
      block.viscosity[block.count] = particle_viscosity(w.context, w.fluid, p);
      block.density[block.count] = kind.pressing_density;
      finish.find_walls(p, w.press.near[found - 1], block, block.count++);
    }
    if (block.count == kLanes) close_block();
  };
  for (std::size_t r = begin; r < end; ++r) {
    const RowList rows = w.fluid.index.rows(grid, runs[r].cell);
    for (std::uint32_t p = runs[r].particles.begin, end_of_run = runs[r].particles.end; p < end_of_run;) {
      const std::uint32_t together = std::min(end_of_run - p, writer.room());
      const auto write = together == 4   ? write_rows<4>
                         : together == 3 ? write_rows<3>
                         : together == 2 ? write_rows<2>
                                         : write_rows<1>;
      if (write(w, p, rows, writer)) put();
      p += together;
    }
  }
  if (writer.waits()) put();
  if (block.count > 0) close_block();
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
