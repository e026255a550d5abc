// What it saves to leave out of a step what a scene does not need, and that nothing changes by it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/plan.h"
#include "tests/lab/report/trial.h"

namespace slosh::report {

struct PassRow {
  std::string what;               ///< "as planned", "with pair_viscosity", "and a picture with its shell"
  double step_ms = 0.0;           ///< median
  double slower = 1.0;            ///< than as planned: the median of the ratios of steps taken in turns
  double bytes_a_particle = 0.0;  ///< of the fluid's columns, without what sorting needs besides
  bool same_bits = true;          ///< the world's hash is that of the planned one's
  double off = 0.0;               ///< m, the largest difference of a particle's position after kComparedSteps
};
inline constexpr int kComparedSteps = 20;

/// What a pass takes of a step as planned.
struct PassShare {
  PassId pass;
  double ms = 0.0;  ///< median; of an engine's pass on a GPU the GPU's own time, which overlaps with the rest
  double share = 0.0;  ///< of StepCost::ms
};

/// Of steps in a row.
struct StepCost {
  double ms = 0.0;                ///< median
  double p10_ms = 0.0;            ///< a tenth of the steps took no longer
  double p90_ms = 0.0;            ///< a tenth of the steps took as long or longer
  std::vector<PassShare> shares;  ///< of passes that take time, in their order
};

struct PassTable {
  std::vector<PassRow> rows;
  StepCost alone;  ///< as planned
};

struct PassOptions {
  int warm_up = 10;  ///< steps before
  int steps = 100;   ///< timed, of each variant, in turns
  Backend backend = Backend::kCpu;
  int threads = 0;
  bool (*stopped)() = nullptr;
};

/// The value that a share (0–1) of the values is below; 0.5: the median. 0 where there is none.
double percentile(std::vector<double> values, double share);

/// Warms up, then times options.steps steps of a world, one after the other: on a GPU what another world's
/// step left under way would be in the passes' times. Throws Stopped.
StepCost measure_steps(World& world, std::span<const HandleInput> hands, const PassOptions& options);

/// The scene as planned first, then with each pass forced in that the plan left out and that can run, then
/// with what only a viewer or a recording needs. Throws Refused, Stopped.
PassTable measure_passes(const Scene& scene, const SampledScene& sampled, const PassOptions& options);

}  // namespace slosh::report
