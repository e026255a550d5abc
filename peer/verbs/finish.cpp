#include <cstdio>

#include "peer/output/plot.h"
#include "peer/verbs/interrupt.h"
#include "peer/verbs/play_modes.h"
#include "peer/verbs/verbs.h"

namespace slosh {

int finish_run(const Stage& stage, Progress& progress, RunSummary& summary) {
  int code = kExitOk;
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
      if (plotted) {
        summary.files.emplace_back("wrenches.png");
      } else {
        progress.note("slosh: the plot: " + plotted.error().text());
      }
    }
    summary.files.emplace_back("summary.json");
    const Result<bool> written = write_summary(stage.folder / "summary.json", summary);
    if (!written) code = fail(written.error());
  }
  progress.note("");
  std::printf("%s", in_words(summary).c_str());
  // As a shell reports a program that a signal ended.
  if (summary.interrupted && code == kExitOk) code = 128 + interrupted_by();
  return code;
}

}  // namespace slosh
