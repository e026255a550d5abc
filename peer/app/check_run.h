// What `check` learns of a scene by letting it run for a moment: settled, then watched while the hands stand
// still.
#pragma once

#include <string>
#include <vector>

#include "peer/output/progress.h"
#include "scenes/inspect.h"
#include "scenes/scene.h"
#include "sim/plan.h"

namespace slosh {

/// s of wall time for the whole of it.
constexpr double kCheckBudget = 10.0;
/// Simulated s that are watched after settling.
constexpr double kWatched = 0.4;
/// The share of its mean within which a felt force counts as at rest.
constexpr double kSteadyShare = 0.02;

struct CheckRun {
  double settled = 0.0;      ///< simulated s of settling ...
  bool cut_short = false;    ///< ... which the budget ended
  double watched = 0.0;      ///< simulated s after it; 0: there was no room
  std::size_t fluid = 0;     ///< particles at the start
  std::size_t settling = 0;  ///< of these left the domain while it settled ...
  std::size_t left = 0;      ///< ... in all by the end ...
  std::size_t falling = 0;   ///< ... and are below all bodies, on their way out
  double compression = 0.0;  ///< the largest ρ/ρ⁰ − 1 at the end

  struct Felt {
    std::string grip;
    double force = 0.0;  ///< N, the mean's size
    double swing = 0.0;  ///< N, half of what it varied by
    bool steady() const { return swing <= 0.05 || swing <= kSteadyShare * force; }
  };
  std::vector<Felt> hands;

  struct Layer {
    std::string fluid;
    double depth = 0.0;  ///< m, as most of its particles have it above and below them
  };
  std::vector<Layer> layers;
};

/// Runs the scene on the CPU, all cores, each hand where its script or its grip begins. Errors: no world can
/// be made. What does not fit into kCheckBudget is left out, and that is in the result.
Result<CheckRun> run_for_check(const Scene& scene, const SampledScene& sampled, const Plan& plan,
                               Progress& progress);

/// What is not as it will have been meant; errors are what a run would end with.
void judge_run(const Scene& scene, const CheckRun& run, double spacing, Inspection& found);

/// "rests: left_hand feels 9.21 N, within 0.004", for the list of what is in a scene.
std::string rest_in_words(const CheckRun& run);

}  // namespace slosh
