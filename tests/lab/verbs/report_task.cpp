// Learning over the runs of a guided task: the tables of `slosh play --score` drawn.
#include <algorithm>
#include <map>
#include <span>

#include "peer/app/verbs.h"
#include "peer/output/chart.h"
#include "peer/output/gnuplot.h"
#include "peer/output/score.h"
#include "sim/math/format.h"
#include "tests/lab/verbs/report.h"

namespace slosh {
namespace {

constexpr const char* kStepColors[] = {"#1f77b4", "#ff7f0e", "#2ca02c", "#d62728",
                                       "#9467bd", "#8c564b", "#e377c2", "#7f7f7f"};

ChartSeries series_over_runs(const std::string& name, const std::string& color) {
  ChartSeries series;
  series.name = name;
  series.color = color;
  series.width = 2.0;
  return series;
}

ChartPanel panel_over_runs(const std::string& title, const std::string& y_label) {
  ChartPanel panel;
  panel.title = title;
  panel.x_label = "run";
  panel.y_label = y_label;
  panel.y_from_zero = true;
  return panel;
}

/// Whole runs alone count as a time: one that was broken off would look quick.
std::vector<ChartPanel> learning(const std::vector<Score>& runs) {
  ChartPanel time = panel_over_runs("time of all steps, where all were done", "s");
  ChartPanel steps = panel_over_runs("time of each step", "s");
  ChartPanel spilled = panel_over_runs("spilled: in no region at the end", "g");
  ChartPanel force = panel_over_runs("force on the hands", "N");
  ChartSeries whole = series_over_runs("", "#303030"), lost = series_over_runs("", "#1f77b4");
  ChartSeries peak = series_over_runs("largest", "#d62728"), mean = series_over_runs("mean", "#ff7f0e");
  std::size_t most = 0;
  for (const Score& run : runs) most = std::max(most, run.step_times.size());
  for (std::size_t k = 0; k < most; ++k)
    steps.series.push_back(
        series_over_runs(format("step %zu", k + 1), kStepColors[k % std::size(kStepColors)]));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Score& run = runs[i];
    const auto x = static_cast<double>(i + 1);
    if (run.done == run.steps) whole.points.emplace_back(x, run.time);
    for (std::size_t k = 0; k < run.step_times.size(); ++k)
      steps.series[k].points.emplace_back(x, run.step_times[k]);
    lost.points.emplace_back(x, 1e3 * run.spilled);
    peak.points.emplace_back(x, run.peak_force);
    mean.points.emplace_back(x, run.mean_force);
  }
  time.series = {whole};
  time.legend = false;
  spilled.series = {lost};
  spilled.legend = false;
  force.series = {peak, mean};
  return {time, steps, spilled, force};
}

}  // namespace

int report_task(const std::string& table, const std::string& wanted, const std::string& out) {
  const Result<std::vector<Score>> scores = read_scores(table);
  if (!scores) return fail(scores.error());
  if (scores.value().empty())
    return fail({table, "has no run in it yet", "Make one with `slosh play SCENE --score " + table + "`"});
  const std::string scene = wanted.empty() ? scores.value().back().scene : wanted;
  std::vector<Score> runs;
  std::map<std::string, std::size_t> known;
  for (const Score& score : scores.value()) {
    known[score.scene] += 1;
    if (score.scene == scene) runs.push_back(score);
  }
  if (runs.empty()) {
    std::string names;
    for (const auto& [name, count] : known) names += (names.empty() ? "" : ", ") + name;
    return fail({table, "has no run of '" + scene + "'", "It has runs of: " + names});
  }
  std::filesystem::path picture = out;
  if (out.empty()) picture = std::filesystem::path(table).replace_extension(".png");
  const std::string title = format("%s: %zu runs", scene.c_str(), runs.size());
  if (const Result<bool> drawn = draw(chart_script(learning(runs), 2, title), picture); !drawn)
    return fail(drawn.error());
  constexpr std::size_t kShown = 20;
  const std::span<const Score> last = std::span(runs).last(std::min(kShown, runs.size()));
  std::printf("%s\n%sWritten to %s.\n", title.c_str(), score_words(last, false).c_str(),
              picture.string().c_str());
  return kExitOk;
}

}  // namespace slosh
