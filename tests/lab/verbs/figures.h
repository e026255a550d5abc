// The paper's Figures 8 to 13: what each shows, and what the paper's words say of it, held against a run in
// numbers.
#pragma once

#include <string>
#include <vector>

#include "peer/output/chart.h"
#include "tests/lab/verbs/scripted_run.h"

namespace slosh {

/// A sentence of the paper and what a run says to it.
struct Claim {
  std::string paper;     ///< its words
  std::string measured;  ///< with numbers and units
  bool holds = false;
};

struct FigureParts {
  std::vector<ChartPanel> panels;
  std::vector<Claim> claims;
  bool reproduced = false;  ///< of Figure 10: this model shows what the paper shows
};

/// A part of a motion between two times.
struct Phase {
  std::string name;
  double from = 0.0, to = 0.0;  ///< s
};

/// The shipped scene that a figure is of; null where there is no such figure here (8–13 are).
const char* scene_of_figure(int number);

/// Figure 8: the spoon. `tare`: the wrench at rest, before the first stroke, is taken off what is drawn.
FigureParts judge_spoon(const ScriptedRun& run, bool tare);
/// Figure 9: bowl (hand 0) and pan (hand 1).
FigureParts judge_pour(const ScriptedRun& run);
/// Figure 10: four glasses of rising viscosity, by one model; `model` for the titles.
FigureParts judge_spin(const ScriptedRun& run, const std::string& model);
/// Figure 11: a bucket in a left and a right hand.
FigureParts judge_bucket(const ScriptedRun& run);
/// Figure 12: batter poured from the crêpe's bowl into its pan.
FigureParts judge_crepe_pour(const ScriptedRun& run);
/// Figure 13: its batter stirred, and syrup poured on it.
FigureParts judge_crepe_tools(const ScriptedRun& run);

}  // namespace slosh
