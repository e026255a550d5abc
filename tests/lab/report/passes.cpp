#include "tests/lab/report/passes.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <span>

#include "sim/columns.h"
#include "sim/passes/pass.h"

namespace slosh::report {
namespace {

struct Variant {
  PassRow row;
  World world;
  std::function<void(const World&)> after;  ///< what is done besides the step, and timed with it
  std::vector<double> times;
};

bool can_be_forced(PassId id, const Plan& plan) {
  switch (id) {
    case PassId::kOneViscosity:
      return plan.has_fluid() && !plan.viscous();
    case PassId::kPairViscosity:
    case PassId::kWrenches:
      return plan.has_fluid();
    case PassId::kCouplings:
    case PassId::kContacts:
    case PassId::kMoveBodies:
      return true;
    default:
      return false;  // without a fluid, or without bodies, there is nothing for it to work on
  }
}

Plan with_pass(const Scene& scene, Plan plan, PassId id) {
  plan.runs.set(id, true);
  plan.runs.set(runs_in(id), true);
  if (id == PassId::kPairViscosity) plan.runs.set(PassId::kOneViscosity, false);
  if (id == PassId::kWrenches) {
    plan.wrench_bodies.clear();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) plan.wrench_bodies.push_back(static_cast<int>(i));
  }
  return plan;
}

double farthest(const Snapshot& a, const Snapshot& b) {
  double off = 0.0;
  for (std::size_t i = 0; i < std::min(a.positions.size(), b.positions.size()); ++i)
    off = std::max<double>(off, glm::distance(a.positions[i], b.positions[i]));
  return off;
}

}  // namespace

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const double place = share * static_cast<double>(values.size());
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(std::min(place, static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

StepCost measure_steps(World& world, std::span<const HandleInput> hands, const PassOptions& options) {
  std::vector<double> steps;
  std::array<std::vector<double>, kPassCount> parts;
  for (int i = 0; i < options.warm_up + options.steps; ++i) {
    if (options.stopped && options.stopped()) throw Stopped();
    world.step(hands);
    if (i < options.warm_up) continue;
    steps.push_back(1e3 * world.times().total);
    for (std::size_t p = 0; p < kPassCount; ++p) parts[p].push_back(1e3 * world.times().pass[p]);
  }
  StepCost cost{percentile(steps, 0.5), percentile(steps, 0.1), percentile(steps, 0.9), {}};
  for (std::size_t p = 0; p < kPassCount; ++p) {
    const double ms = percentile(parts[p], 0.5);
    if (ms > 0.0) cost.shares.push_back({static_cast<PassId>(p), ms, ms / cost.ms});
  }
  return cost;
}

PassTable measure_passes(const Scene& scene, const SampledScene& sampled, const PassOptions& options) {
  const Plan planned = make_plan(scene, sampled.spacing);
  std::vector<Variant> variants;
  const auto add = [&](const std::string& what, const Plan& plan,
                       std::function<void(const World&)> after = {}) {
    Result<World> made = make_world(scene, sampled, plan, {options.threads, options.backend});
    if (!made) throw Refused(made.error());
    PassRow row;
    row.what = what;
    row.bytes_a_particle = column_bytes(plan);
    variants.push_back({row, std::move(made.value()), std::move(after), {}});
  };
  add("as planned", planned);
  for (const Pass& left : planned.left_out) {
    if (can_be_forced(left.id, planned))
      add(std::string("with ") + name(left.id), with_pass(scene, planned, left.id));
  }
  if (planned.has_fluid()) {
    add("and a picture", planned,
        [snapshot = Snapshot()](const World& world) mutable { world.fill(snapshot); });
    add("and a picture with its shell", planned,
        [snapshot = Snapshot()](const World& world) mutable { world.fill(snapshot, true); });
  }
  add("and a hash", planned, [](const World& world) { (void)world.hash(); });

  std::vector<HandleInput> hands(scene.grips.size());
  for (std::size_t g = 0; g < hands.size(); ++g) {
    hands[g].pose =
        compose(scene.bodies[static_cast<std::size_t>(scene.grips[g].body)].pose, scene.grips[g].pose);
    hands[g].engaged = true;
  }
  // In turns, so that what else the machine does falls on all alike.
  Snapshot first, other;
  for (int round = 0; round < options.warm_up + options.steps; ++round) {
    for (Variant& each : variants) {
      if (options.stopped && options.stopped()) throw Stopped();
      const auto before = std::chrono::steady_clock::now();
      each.world.step(hands);
      if (each.after) each.after(each.world);
      const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - before;
      if (round >= options.warm_up) each.times.push_back(took.count());
    }
    if (round + 1 != kComparedSteps) continue;
    variants.front().world.fill(first);
    for (Variant& each : variants) {
      each.world.fill(other);
      each.row.off = farthest(first, other);
      each.row.same_bits = each.world.hash() == variants.front().world.hash();
    }
  }
  PassTable table;
  for (Variant& each : variants) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < each.times.size(); ++i)
      ratios.push_back(each.times[i] / variants.front().times[i]);
    each.row.step_ms = percentile(each.times, 0.5);
    each.row.slower = percentile(ratios, 0.5);
    table.rows.push_back(each.row);
  }
  table.alone = measure_steps(variants.front().world, hands, options);
  return table;
}

}  // namespace slosh::report
