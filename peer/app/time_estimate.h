// How long a run is going to take, told before it does.
#pragma once

#include <span>
#include <string>

#include "peer/output/progress.h"
#include "sim/world.h"

namespace slosh {

/// What is going to be stepped.
struct PlannedTime {
  double settle = 0.0;   ///< simulated s before the run
  double seconds = 0.0;  ///< simulated s of the run; infinity = until it is ended
  bool paced = true;     ///< the run takes no less than real time
  bool agreed = false;   ///< --yes: nobody is asked, nothing is refused
};

/// Wall time by the cost of a step.
struct TimeEstimate {
  double step = 0.0;    ///< s of wall time a step
  double settle = 0.0;  ///< s
  double run = 0.0;     ///< s; of an endless run 0
  double pace = 0.0;    ///< simulated s a wall s, at most 1 where it is paced
  double whole() const { return settle + run; }
};
TimeEstimate estimate_time(const PlannedTime& planned, double time_step, double step_cost);

/// "12 s", "25 min", "1.5 h", "3 days".
std::string duration(double seconds);

/// s a particle and step, on one core: what the slowest machine tried takes twice of.
constexpr double kStatedStepCost = 5e-7;
/// The same on a large GPU, of millions.
constexpr double kStatedStepCostOnGpu = 7e-10;

/// s, the median of some steps; the world is put back bitwise. 0 where it cannot be saved.
double measure_step(World& world, std::span<const HandleInput> hands);

/// From this on a run is told to be slow, s more than its simulated time ...
constexpr double kSlow = 30.0;
/// ... on a terminal asked for, s in all ...
constexpr double kAsk = 600.0;
/// ... and refused, s in all, unless it was agreed to.
constexpr double kRefuse = 86400.0;

/// "1 200 000 steps of 2.00 µs, 1.20 ms each, take about 25 min on this machine", with why the step is what
/// it is.
std::string in_words(const TimeEstimate& estimate, const PlannedTime& planned, const Plan& plan);

/// Where a stated rate says that the run may be slow, takes some steps, puts the world back bitwise, and
/// tells what they say; on a terminal it asks before long runs. Errors: longer than kRefuse, or the answer
/// was no.
Result<bool> agree_on_time(World& world, std::span<const HandleInput> hands, const PlannedTime& planned,
                           Progress& progress);

}  // namespace slosh
