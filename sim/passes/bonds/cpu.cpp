#include "sim/passes/bonds/cpu.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "sim/cpu/state.h"

namespace slosh {
namespace {

constexpr std::size_t kParticlesPerChunk = 512, kRunsPerChunk = 32;
// CpuBonds::is_new.
constexpr std::uint8_t kIsNew = 1, kGrew = 2;

void find_slots(CpuState& s, CpuBonds& b) {
  b.slot_of.assign(b.table.count.size(), CpuBonds::kNowhere);
  for (std::size_t p = 0; p < s.fluid.active; ++p) b.slot_of[s.fluid.id[p]] = static_cast<std::uint32_t>(p);
}

// m, the same bitwise from either end.
float distance(const FluidParticles& f, std::size_t p, std::size_t q) {
  const float dx = f.x[p] - f.x[q], dy = f.y[p] - f.y[q], dz = f.z[p] - f.z[q];
  return std::sqrt(dx * dx + dy * dy + dz * dz);
}

void bind_to_those_around(const CpuState& s, CpuBonds& b, std::uint32_t p, const RowList& rows) {
  const FluidParticles& f = s.fluid;
  const auto stiffness = [&](std::uint32_t q) { return s.context.heat.kinds[f.kind[q]].bond; };
  const std::uint32_t id = f.id[p];
  if (!b.table.set[id] || !(stiffness(p) > 0.0f)) return;
  const float reach = kBondReach * static_cast<float>(s.context.plan.spacing);
  const std::uint8_t before = b.table.count[id];
  for (int row = 0; row < rows.count; ++row) {
    for (std::uint32_t q = rows.rows[row].begin; q < rows.rows[row].end; ++q) {
      const std::uint32_t other = f.id[q];
      if (q == p || !b.table.set[other] || !((b.is_new[id] | b.is_new[other]) & kIsNew) ||
          !(stiffness(q) > 0.0f))
        continue;
      const float apart = distance(f, p, q);
      if (apart < reach && apart > 0.0f && b.table.count[id] < kMaxBonds)
        b.table.row(id)[b.table.count[id]++] = {other, apart};
    }
  }
  if (b.table.count[id] > before) b.is_new[id] |= kGrew;
}

// Where one of two had no room left the other has no bond either.
void drop_one_sided(const BondTable& before, BondTable& table, std::uint32_t id) {
  Bond* row = table.row(id);
  const auto is_gone = [&](const Bond& bond) {
    const Bond* theirs = before.row(bond.other);
    return std::none_of(theirs, theirs + before.count[bond.other],
                        [id](const Bond& t) { return t.other == id; });
  };
  Bond* end = std::remove_if(row, row + table.count[id], is_gone);
  table.count[id] = static_cast<std::uint8_t>(end - row);
}

void weigh(const CpuState& s, BondTable& table, std::uint32_t id) {
  float lengths = 0.0f;
  for (std::uint8_t k = 0; k < table.count[id]; ++k) lengths += table.row(id)[k].rest;
  table.weight[id] = bond_weight(lengths, s.context.heat.bond_lengths);
}

// Who has set and who melted since the last time; those that set are bound to what has set around them.
void bind(CpuState& s, CpuBonds& b) {
  const FluidParticles& f = s.fluid;
  b.is_new.assign(b.table.count.size(), 0);
  bool any = false;
  for (std::size_t p = 0; p < f.active; ++p) {
    const std::uint32_t id = f.id[p];
    const bool did = b.table.set[id], does = counts_as_set(f.cure[p], did);
    b.is_new[id] = does && !did ? kIsNew : 0;
    any |= does && !did;
    b.table.set[id] = does;
  }
  if (!any) return;
  const std::vector<CellRun>& runs = f.index.runs();
  s.team.run(runs.size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      const RowList rows = f.index.rows(s.context.grid, runs[r].cell);
      for (std::uint32_t p = runs[r].particles.begin; p < runs[r].particles.end; ++p)
        bind_to_those_around(s, b, p, rows);
    }
  });
  if (std::ranges::any_of(b.table.count, [](std::uint8_t count) { return count == kMaxBonds; })) {
    const BondTable before = b.table;
    for (std::size_t p = 0; p < f.active; ++p) drop_one_sided(before, b.table, f.id[p]);
  }
  for (std::size_t p = 0; p < f.active; ++p)
    if (b.is_new[f.id[p]] & kGrew) weigh(s, b.table, f.id[p]);
}

}  // namespace

namespace passes {

void bonds_on_cpu(CpuState& s, const PassInputs& in) {
  CpuBonds& b = s.bonds;
  if (in.look) bind(s, b);
  find_slots(s, b);
  FluidParticles& f = s.fluid;
  s.team.run(f.active, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::uint32_t id = f.id[p];
      std::uint8_t& count = b.table.count[id];
      if (!b.table.set[id]) count = 0;
      Bond* const row = b.table.row(id);
      const HeatKind& own = s.context.heat.kinds[f.kind[p]];
      float x = 0.0f, y = 0.0f, z = 0.0f;
      std::uint8_t kept = 0;
      for (std::uint8_t k = 0; k < count; ++k) {
        const Bond bond = row[k];
        const std::uint32_t q = b.slot_of[bond.other];
        if (q == CpuBonds::kNowhere || !b.table.set[bond.other]) continue;
        const float r = distance(f, p, q), strain = (r - bond.rest) / bond.rest;
        const HeatKind& other = s.context.heat.kinds[f.kind[q]];
        if (strain > std::min(own.tears_at, other.tears_at)) continue;
        row[kept++] = bond;
        const float cure = std::min(f.cure[p], f.cure[q]);
        const float weight = b.table.weight[id] * b.table.weight[bond.other];
        const float pull = std::min(own.bond, other.bond) * weight * cure * strain / std::max(r, 1e-12f);
        x += pull * (f.x[q] - f.x[p]);
        y += pull * (f.y[q] - f.y[p]);
        z += pull * (f.z[q] - f.z[p]);
      }
      count = kept;
      f.fx[p] += x;
      f.fy[p] += y;
      f.fz[p] += z;
    }
  });
}

}  // namespace passes
}  // namespace slosh
