#include "sim/saved_particles.h"

#include <cmath>
#include <span>

namespace slosh {

namespace {

// Every saved column but the key, which follows from the position: of it one byte tells who is retired.
template <class S, class P>
void columns(S& s, const Plan& plan, P& p) {
  for_each_column(
      [&](auto column, auto& values) {
        if (info(column).saved && column != FluidColumn::key && needs(plan, info(column).need))
          s.column(std::span(values.data(), values.size()));
      },
      p);
}

// Of each particle, by id, whether it has set and its bonds.
void write_bonds(StateSink& s, const BondTable& table) {
  for (std::size_t id = 0; id < table.count.size(); ++id) {
    s.raw(table.set[id]);
    s.raw(table.count[id]);
    s.raw(table.weight[id]);
    for (std::uint8_t k = 0; k < table.count[id]; ++k) {
      s.raw(table.row(id)[k].other);
      s.raw(table.row(id)[k].rest);
    }
  }
}

void read_bonds(StateSource& s, std::size_t particles, float longest, BondTable& table) {
  table.resize(particles);
  for (std::size_t id = 0; id < particles && s.ok(); ++id) {
    s.raw(table.set[id]);
    s.raw(table.count[id]);
    s.raw(table.weight[id]);
    if (s.ok() && !(table.weight[id] >= 0.0f && table.weight[id] <= 2.0f))
      return s.fail("it holds a weight of bonds that is none");
    if (table.set[id] > 1 || table.count[id] > kMaxBonds)
      return s.fail("it holds more bonds than there can be");
    for (std::uint8_t k = 0; k < table.count[id]; ++k) {
      Bond& bond = table.row(id)[k];
      s.raw(bond.other);
      s.raw(bond.rest);
      if (s.ok() &&
          (bond.other >= particles || bond.other == id || !(bond.rest > 0.0f) || bond.rest > longest))
        return s.fail("it holds a bond that is none");
    }
  }
}

// Every particle once at most, probes all, and those in the world where they can be.
void check_particles(StateSource& s, const StateFrame& frame, const RunConstants& constants,
                     const std::vector<std::uint8_t>& gone, ParticleState& p) {
  const std::uint64_t total = frame.fluid_particles + frame.probes;
  std::vector<bool> seen(total, false);
  std::uint64_t probes = 0;
  for (std::size_t i = 0; i < p.size() && s.ok(); ++i) {
    if (p.id[i] >= total || seen[p.id[i]])
      return s.fail("it holds a particle that is not of this world, or one twice");
    seen[p.id[i]] = true;
    const bool probe = p.id[i] >= frame.fluid_particles;
    probes += probe;
    if (gone[i] > 1 || (gone[i] && probe))
      return s.fail("it holds a particle that is neither in the world nor out of it");
    if (gone[i]) {
      p.key[i] = constants.grid.retired_key();
      continue;
    }
    const bool finite = std::isfinite(p.x[i]) && std::isfinite(p.y[i]) && std::isfinite(p.z[i]) &&
                        std::isfinite(p.vx[i]) && std::isfinite(p.vy[i]) && std::isfinite(p.vz[i]);
    if (!finite || !(p.volume[i] > 0.0f) || !std::isfinite(p.volume[i]))
      return s.fail("it holds a particle that is not finite");
    if (!(p.solved[i] >= 0.0f) || !std::isfinite(p.solved[i]))
      return s.fail("it holds a pressure that is none");
    if (constants.plan.has(PassId::kHeat)) {
      const bool warm = p.temperature[i] >= kColdest && p.temperature[i] <= 2.0 * kHottest;
      if (!warm || !(p.cure[i] >= 0.0f && p.cure[i] <= 1.0f) || !(p.thickness[i] >= 0.0f) ||
          !std::isfinite(p.thickness[i]) || !std::isfinite(p.from_bodies[i]))
        return s.fail("it holds a temperature or a viscosity that is none");
    }
    // A probe may be outside, with the hand that holds it.
    if (!probe && !constants.grid.contains(p.x[i], p.y[i], p.z[i]))
      return s.fail("it holds a particle that is outside the domain");
    p.key[i] = constants.grid.cell_of(p.x[i], p.y[i], p.z[i]);
  }
  if (s.ok() && probes != frame.probes) s.fail("a probe is missing in it");
}

}  // namespace

std::size_t bytes_a_particle(const Plan& plan) {
  std::size_t bytes = 1;
  for (const ColumnInfo& column : kFluidColumns) {
    if (column.saved && column.life != ColumnLife::kKey && needs(plan, column.need)) bytes += column.bytes;
  }
  return bytes;
}

void write_particles(StateSink& s, const RunConstants& constants, const SavedState& state) {
  const ParticleState& p = state.particles;
  s.raw(static_cast<std::uint32_t>(p.size()));
  columns(s, constants.plan, p);
  std::vector<std::uint8_t> gone(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) gone[i] = p.key[i] >= constants.grid.retired_key();
  s.column(std::span<const std::uint8_t>(gone));
  if (constants.plan.has(PassId::kBonds)) write_bonds(s, state.bonds);
}

void read_particles(StateSource& s, const StateFrame& frame, const RunConstants& constants,
                    SavedState& state) {
  std::uint32_t count = 0;
  s.raw(count);
  ParticleState& p = state.particles;
  // What is there decides how much is allocated.
  const bool bound = constants.plan.has(PassId::kBonds);
  const std::uint64_t wanted = std::uint64_t{bytes_a_particle(constants.plan)} * count;
  if (s.ok() && (bound ? s.left() < wanted : s.left() != wanted))
    s.fail("its length does not fit its number of particles");
  if (s.ok()) {
    p.resize(count);
    columns(s, constants.plan, p);
    std::vector<std::uint8_t> gone(count);
    s.column(std::span(gone));
    check_particles(s, frame, constants, gone, p);
  }
  if (s.ok() && bound) {
    const float longest = 2.0f * kBondReach * static_cast<float>(frame.spacing);
    read_bonds(s, frame.fluid_particles + frame.probes, longest, state.bonds);
    if (s.ok() && s.left() != 0) s.fail("it goes on behind its end");
  }
}

}  // namespace slosh
