#include <cstdio>

#include "peer/output/plot.h"
#include "peer/verbs/interrupt.h"
#include "peer/verbs/play_modes.h"
#include "peer/verbs/verbs.h"

namespace slosh {

int finish_run(const Stage& stage, Progress& progress, RunSummary& summary) {
  summary.interrupted = interrupted_by() != 0;
  if (!stage.folder.empty()) {
    if (!summary.devices.empty()) {
      progress.phase("plotting");
      std::vector<std::string> names;
      for (const Grip& grip : stage.scene.grips) names.push_back(grip.name);
      const std::string title =
          stage.scene.title.empty() ? stage.scene.name : stage.scene.name + ": " + stage.scene.title;
      const Result<bool> plotted =
          plot_wrenches(stage.folder / "wrenches.csv", names, title, stage.folder / "wrenches.png");
      if (!plotted) {
        summary.problems.push_back("the plot: " + plotted.error().text());
      } else if (plotted.value()) {
        summary.files.emplace_back("wrenches.png");
      } else {
        progress.note("slosh: the run was too short for a plot");
      }
    }
    summary.files.emplace_back("summary.json");
    const Result<bool> written = write_summary(stage.folder / "summary.json", summary);
    if (!written) {
      summary.files.pop_back();
      summary.problems.push_back(written.error().text());
    }
  }
  progress.note("");
  std::printf("%s", in_words(summary).c_str());
  std::fflush(stdout);
  for (const std::string& problem : summary.problems) fail({"", problem, ""});
  // As a shell reports a program that a signal ended.
  if (summary.interrupted) return 128 + interrupted_by();
  return summary.problems.empty() ? kExitOk : kExitFailed;
}

}  // namespace slosh
