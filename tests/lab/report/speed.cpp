#include "tests/lab/report/speed.h"

#include <algorithm>

#include "sim/math/format.h"
#include "sim/passes/pass.h"
#include "tests/lab/report/csv.h"

namespace slosh::report {
namespace {

std::size_t count_in(const std::string& field) {
  return static_cast<std::size_t>(std::stoull(field));
}

}  // namespace

double RoofRow::share_of_roof() const {
  return flops > 0.0 ? flops_per_s() / roof(ceilings, flops_per_byte())
                     : bytes_per_s() / ceilings.bytes_per_s;
}

std::string csv_line(const SpeedRow& r) {
  return format("%s,%s,%s,%zu,%zu,%zu,%d,%.6g,%.5g,%.5g,%.5g,%.5g,%.5g,%.6g,%d,%.5g", r.figure.c_str(),
                r.backend.c_str(), csv_field(r.device).c_str(), r.fluid_particles, r.body_particles,
                r.wall_particles, r.bodies, r.spacing, r.step_ms, r.step_p10_ms, r.step_p90_ms, r.picture_ms,
                r.particle_steps_per_s(), 1e3 * r.time_step, r.sub_steps, r.real_time_factor());
}

std::string csv_line(const ShareRow& r) {
  return format("%s,%s,%zu,%d,%s,%.5g,%.5g", r.figure.c_str(), csv_field(r.device).c_str(), r.fluid_particles,
                r.bodies, r.pass.c_str(), r.ms, r.share);
}

std::string csv_line(const RoofRow& r) {
  return format("%s,%zu,%s,%.5g,%.5g,%.5g,%.6g,%.6g,%.5g,%.5g,%.5g,%.5g,%.5g,%.4g",
                csv_field(r.device).c_str(), r.fluid_particles, r.pass.c_str(), r.ms, r.pairs.candidates,
                r.pairs.neighbours, r.bytes, r.flops, 1e-9 * r.bytes_per_s(), 1e-9 * r.flops_per_s(),
                r.flops_per_byte(), 1e-9 * r.ceilings.bytes_per_s, 1e-9 * r.ceilings.flops_per_s,
                r.share_of_roof());
}

Result<bool> read_speeds(const std::filesystem::path& file, SpeedRows& rows) {
  const Result<bool> read = read_rows(file, kSpeedHeader, "speed", [&](const Fields& f) {
    rows.speeds.push_back({f[0], f[1], f[2], count_in(f[3]), count_in(f[4]), count_in(f[5]), std::stoi(f[6]),
                           std::stod(f[7]), std::stod(f[8]), std::stod(f[9]), std::stod(f[10]),
                           std::stod(f[11]), 1e-3 * std::stod(f[13]), std::stoi(f[14])});
  });
  if (!read) return read;
  const std::filesystem::path shares = file.parent_path() / "shares.csv";
  if (std::filesystem::exists(shares)) {
    const Result<bool> more = read_rows(shares, kShareHeader, "speed", [&](const Fields& f) {
      rows.shares.push_back(
          {f[0], f[1], count_in(f[2]), std::stoi(f[3]), f[4], std::stod(f[5]), std::stod(f[6])});
    });
    if (!more) return more;
  }
  const std::filesystem::path roofs = file.parent_path() / "roofline.csv";
  if (!std::filesystem::exists(roofs)) return true;
  return read_rows(roofs, kRoofHeader, "speed", [&](const Fields& f) {
    rows.roofs.push_back({f[0],
                          count_in(f[1]),
                          f[2],
                          std::stod(f[3]),
                          {std::stod(f[4]), std::stod(f[5])},
                          std::stod(f[6]),
                          std::stod(f[7]),
                          {1e9 * std::stod(f[11]), 1e9 * std::stod(f[12])}});
  });
}

void measure_speed(SpeedRow row, const SpeedPool& pool, const PassOptions& options,
                   const PictureTimer& picture, const Ceilings* ceilings, SpeedRows& rows) {
  Result<World> made = make_world(pool.scene, pool.sampled, make_plan(pool.scene, pool.sampled.spacing),
                                  {options.threads, options.backend});
  if (!made) throw Refused(made.error());
  World& world = made.value();
  const StepCost cost = measure_steps(world, {}, options);
  row.fluid_particles = world.fluid_count();
  row.body_particles = pool.body_particles;
  row.wall_particles = pool.wall_particles;
  row.bodies = static_cast<int>(pool.scene.bodies.size()) - 1;
  row.spacing = pool.sampled.spacing;
  row.step_ms = cost.ms;
  row.step_p10_ms = cost.p10_ms;
  row.step_p90_ms = cost.p90_ms;
  row.time_step = world.plan().time_step;
  row.sub_steps = world.plan().sub_steps;
  if (picture) row.picture_ms = picture(pool, world);
  rows.speeds.push_back(row);
  for (const PassShare& each : cost.shares)
    rows.shares.push_back(
        {row.figure, row.device, row.fluid_particles, row.bodies, name(each.pass), each.ms, each.share});
  if (row.figure != "6a" || !ceilings) return;
  Snapshot snapshot;
  world.fill(snapshot);
  const PairCounts pairs = count_pairs(snapshot.positions, world.plan().support_radius);
  const double times = static_cast<double>(row.fluid_particles) * row.sub_steps;
  for (const PassWork& work : pass_work(world.plan(), pairs, options.backend)) {
    for (const PassShare& each : cost.shares) {
      if (each.pass == work.pass)
        rows.roofs.push_back({row.device, row.fluid_particles, name(work.pass), each.ms, pairs,
                              times * work.bytes, times * work.flops, *ceilings});
    }
  }
}

}  // namespace slosh::report
