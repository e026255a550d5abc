#include <cstdio>

#include "peer/output/plot.h"
#include "peer/verbs/interrupt.h"
#include "peer/verbs/play_modes.h"
#include "peer/verbs/verbs.h"

namespace slosh {

int finish_run(const Prepared& prepared, Progress& progress, RunSummary& summary) {
  int code = kExitOk;
  summary.interrupted = interrupted_by() != 0;
  if (!prepared.folder.empty()) {
    if (!prepared.scene.grips.empty()) {
      progress.phase("plotting");
      std::vector<std::string> names;
      for (const Grip& grip : prepared.scene.grips) names.push_back(grip.name);
      const std::string title = prepared.scene.title.empty()
                                    ? prepared.scene.name
                                    : prepared.scene.name + ": " + prepared.scene.title;
      const Result<bool> plotted =
          plot_wrenches(prepared.folder / "wrenches.csv", names, title, prepared.folder / "wrenches.png");
      if (plotted) {
        summary.files.emplace_back("wrenches.png");
      } else {
        progress.note("slosh: the plot: " + plotted.error().text());
      }
    }
    summary.files.emplace_back("summary.json");
    const Result<bool> written = write_summary(prepared.folder / "summary.json", summary);
    if (!written) code = fail(written.error());
  }
  progress.note("");
  std::printf("%s", in_words(summary).c_str());
  // As a shell reports a program that a signal ended.
  if (summary.interrupted && code == kExitOk) code = 128 + interrupted_by();
  return code;
}

}  // namespace slosh
