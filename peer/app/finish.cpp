#include <cstdio>

#include "peer/app/interrupt.h"
#include "peer/app/play_modes.h"
#include "peer/app/verbs.h"
#include "peer/output/child_process.h"
#include "peer/output/plot.h"
#include "sim/math/format.h"

namespace slosh {

namespace {

/// What was simulated, for whoever has the sheet alone.
std::vector<std::string> parameters_of(const Stage& stage, const RunSummary& summary) {
  std::string run;
  if (summary.spacing > 0.0) run += format("spacing %.3g mm, ", 1e3 * summary.spacing);
  if (summary.fluid_particles > 0) run += grouped(summary.fluid_particles) + " fluid particles, ";
  if (summary.boundary_particles > 0) run += grouped(summary.boundary_particles) + " of bodies, ";
  if (summary.time_step > 0.0) run += format("time step %.3g ms, ", 1e3 * summary.time_step);
  run += std::string(name(stage.scene.model)) + " particle model";
  if (!summary.backend.empty()) run += ", " + summary.backend;
  std::string fluids;
  for (const Fluid& fluid : stage.scene.fluids) {
    fluids += (fluids.empty() ? "" : "; ") + fluid.name +
              format(" %.4g kg/m³, %.3g Pa·s", fluid.rest_density, fluid.dynamic_viscosity);
  }
  std::vector<std::string> lines{run};
  if (!fluids.empty()) lines.push_back(fluids);
  return lines;
}

PlotSheet sheet_of(const Stage& stage, const ShowOptions& options, const RunSummary& summary) {
  PlotSheet sheet;
  for (const Grip& grip : stage.scene.grips) sheet.names.push_back(grip.name);
  sheet.title = stage.scene.title.empty() ? stage.scene.name : stage.scene.name + ": " + stage.scene.title;
  sheet.parameters = parameters_of(stage, summary);
  sheet.quantities = options.curves;
  sheet.format = options.plot;
  return sheet;
}

/// The run's row, and the last runs of the scene for comparison.
void keep_score(const std::string& file, RunSummary& summary) {
  constexpr std::size_t kShown = 5;
  const Score score = score_of(summary);
  const Result<bool> kept = append_score(file, score);
  if (!kept) return summary.problems.push_back("the score: " + kept.error().text());
  const Result<std::vector<Score>> all = read_scores(file);
  if (!all) return;
  for (const Score& each : all.value())
    if (each.scene == score.scene) summary.scores.push_back(each);
  if (summary.scores.size() > kShown)
    summary.scores.erase(summary.scores.begin(), summary.scores.end() - std::ptrdiff_t{kShown});
}

}  // namespace

int finish_run(const Stage& stage, const ShowOptions& options, Progress& progress, RunSummary& summary) {
  summary.interrupted = interrupted_by() != 0;
  if (!stage.folder.empty()) {
    if (!summary.devices.empty()) {
      progress.phase("plotting");
      const std::string name = "wrenches." + options.plot;
      const Result<bool> plotted = plot_wrenches(stage.folder / "wrenches.csv",
                                                 sheet_of(stage, options, summary), stage.folder / name);
      if (!plotted && !program_there("gnuplot")) {
        // Nothing was lost: the sheet is drawn from what is in the table.
        progress.note("slosh: no " + name +
                      ", as gnuplot is not installed (apt-get install gnuplot-nox); "
                      "what it would show is in wrenches.csv");
      } else if (!plotted) {
        summary.problems.push_back("the plot: " + plotted.error().text());
      } else if (plotted.value()) {
        summary.files.push_back(name);
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
  if (!options.score.empty()) keep_score(options.score, summary);
  progress.end();
  std::printf("%s", in_words(summary).c_str());
  std::fflush(stdout);
  for (const std::string& problem : summary.problems) fail({"", problem, ""});
  // As a shell reports a program that a signal ended.
  if (summary.interrupted) return 128 + interrupted_by();
  return summary.problems.empty() ? kExitOk : kExitFailed;
}

int show_run(const Stage& stage, const MakeRun& make_run, const ShowOptions& options, bool headless,
             HeadsetView* headset, Progress& progress) {
  RunSummary summary;
  if (headless) {
    const Result<std::unique_ptr<LiveRun>> run = make_run();
    if (!run) return fail(run.error());
    const Result<bool> filmed = show_headless(stage, *run.value(), options, progress, summary);
    if (!filmed) return fail(filmed.error());
  } else {
    const Result<bool> shown = show_in_window(stage, make_run, options, headset, progress, summary);
    if (!shown) return fail(shown.error());
  }
  return finish_run(stage, options, progress, summary);
}

}  // namespace slosh
