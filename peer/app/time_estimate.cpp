#include "peer/app/time_estimate.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <vector>

#include "net/clock.h"
#include "peer/output/summary.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxSteps = 5;
constexpr double kLongest = 3.0;  // s of measuring, and a step

std::string format_step(double seconds) {
  return seconds < 1e-3 ? format("%.3g µs", 1e6 * seconds) : format("%.3g ms", 1e3 * seconds);
}

bool someone_says_yes(Progress& progress, const std::string& question) {
  progress.note(question + " [y/N]");
  std::string answer;
  return std::getline(std::cin, answer) && !answer.empty() && (answer[0] == 'y' || answer[0] == 'Y');
}

}  // namespace

std::string duration(double seconds) {
  if (seconds < 90.0) return format("%.0f s", seconds);
  if (seconds < 5400.0) return format("%.0f min", seconds / 60.0);
  if (seconds < 172800.0) return format("%.1f h", seconds / 3600.0);
  return format("%.0f days", seconds / 86400.0);
}

double measure_step(World& world, std::span<const HandleInput> hands) {
  std::vector<std::uint8_t> before;
  if (!world.save(before)) return 0.0;
  const std::int64_t begin_ns = steady_now_ns();
  std::vector<double> costs;
  // The median: the first step touches memory that the others find warm.
  while (costs.size() < kMaxSteps && (costs.empty() || to_seconds(steady_now_ns() - begin_ns) < kLongest)) {
    const std::int64_t step_ns = steady_now_ns();
    world.step(hands);
    costs.push_back(to_seconds(steady_now_ns() - step_ns));
  }
  std::nth_element(costs.begin(), costs.begin() + costs.size() / 2, costs.end());
  const double cost = costs[costs.size() / 2];
  (void)world.restore(before);
  (void)world.take_status();
  return cost;
}

TimeEstimate estimate_time(const PlannedTime& planned, double time_step, double step_cost) {
  TimeEstimate estimate;
  estimate.step = step_cost;
  const double each = step_cost / time_step;  // wall s a simulated s
  estimate.settle = planned.settle * each;
  if (std::isfinite(planned.seconds))
    estimate.run = planned.seconds * (planned.paced ? std::max(each, 1.0) : each);
  estimate.pace = planned.paced ? std::min(1.0, 1.0 / each) : 1.0 / each;
  return estimate;
}

std::string in_words(const TimeEstimate& estimate, const PlannedTime& planned, const Plan& plan) {
  const double simulated = planned.settle + (std::isfinite(planned.seconds) ? planned.seconds : 0.0);
  const auto steps = static_cast<std::uint64_t>(std::llround(simulated / plan.time_step));
  std::string words = grouped(steps) + " steps of " + format_step(plan.time_step) + " (by " +
                      plan.time_step_reason + "), each " + format_step(estimate.step) + " of work here";
  const char* joint = ": about ";
  if (planned.settle > 0.0) {
    words += joint + duration(estimate.settle) + " to settle";
    joint = " and ";
  }
  if (std::isfinite(planned.seconds)) words += joint + duration(estimate.run) + " for the run";
  return words + format(", real time × %.2g", estimate.pace);
}

Result<bool> agree_on_time(World& world, std::span<const HandleInput> hands, const PlannedTime& planned,
                           Progress& progress) {
  const double time_step = world.plan().time_step;
  const double particles = static_cast<double>(world.fluid_count() + world.boundary_count());
  const auto slow = [&](const TimeEstimate& e) {
    return e.whole() > kSlow + (std::isfinite(planned.seconds) ? planned.seconds : 0.0);
  };
  if (!slow(estimate_time(planned, time_step, particles * kStatedStepCost))) return true;
  const TimeEstimate estimate = estimate_time(planned, time_step, measure_step(world, hands));
  if (!slow(estimate)) return true;
  const std::string words = in_words(estimate, planned, world.plan());
  if (planned.agreed || estimate.whole() <= kAsk) {
    progress.note("slow: " + words);
    return true;
  }
  const char* const mend =
      "Take coarser particles (--spacing), a shorter run (--seconds) or a thinner fluid, look whether the "
      "scene is "
      "in metres, or give --yes";
  if (estimate.whole() > kRefuse) return Error{"this run", "would take too long: " + words, mend};
  if (progress.terminal() && isatty(STDIN_FILENO) != 0) {
    if (!someone_says_yes(progress, "slow: " + words + ". Go on?"))
      return Error{"this run", "was not wanted", mend};
    return true;
  }
  progress.note("slow: " + words);
  return true;
}

}  // namespace slosh
