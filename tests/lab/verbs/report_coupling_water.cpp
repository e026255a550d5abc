// `slosh report coupling --water`: one hand on the bucket of real water, and what could be had at best.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "net/text/clean.h"
#include "peer/output/chart.h"
#include "peer/output/gnuplot.h"
#include "peer/output/progress.h"
#include "peer/output/whole_file.h"
#include "peer/app/interrupt.h"
#include "peer/app/verbs.h"
#include "sim/math/format.h"
#include "tests/lab/coupling/water_study.h"
#include "tests/lab/verbs/on_cores.h"
#include "tests/lab/verbs/report_coupling.h"

namespace slosh {
namespace {

using namespace coupling;

constexpr const char* kCouplingWaterTable = "coupling_water.csv";
constexpr double kNudge = 1e-6;  // m: nobody could tell
constexpr const char* kPerson = "tight,correction=0";
constexpr const char* kLoosePerson = "loose,correction=0";  // whose bucket tips, and pours

struct WaterFelt {
  double round_trip = 0.0;  // s
  double error = 0.0, learning = 0.0, moving = 0.0, after = 0.0, line = 0.0;
  /// Of a person, who goes elsewhere by what they feel: off what is right where they went, and m rms that is
  /// elsewhere; and what is right there, a round trip late.
  double same = 0.0, elsewhere = 0.0, late = 0.0;
};
struct WaterRow {
  WaterCase c;
  double force = 0.0;  // N
  double chaos = 0.0;
  WaterSplit split;
  std::vector<WaterFelt> felt;
  std::string problem;
};

/// m rms between two hands from kWaterBegins on.
double apart(const std::vector<DeviceReport>& went, const WaterRun& reference) {
  double off = 0.0, count = 0.0;
  for (std::size_t i = 0; i < went.size() && i < reference.steps.size(); ++i) {
    if (reference.steps[i].time < kWaterBegins) continue;
    const glm::dvec3 d = went[i].pose.position - reference.steps[i].hand.position;
    off += glm::dot(d, d);
    count += 1.0;
  }
  return std::sqrt(off / std::max(count, 1.0));
}

Result<bool> measure(const std::vector<double>& round_trips, WaterRow& row) {
  const Result<WaterRun> run = run_water(row.c);
  if (!run) return run.error();
  WaterCase nudged = row.c;
  nudged.nudge = kNudge;
  const Result<WaterRun> again = run_water(nudged);
  if (!again) return again.error();
  std::vector<Wrench> felt;
  for (const WaterStep& step : again.value().steps) felt.push_back(step.felt);
  row.force = water_force(run.value());
  row.chaos = water_error(felt, run.value());
  row.split = split_water(run.value());
  ReplicaTuning by_line;
  by_line.follows_slosh = false;
  for (const double round_trip : round_trips) {
    std::vector<DeviceReport> went;
    const Result<std::vector<Wrench>> ours = feel_water(run.value(), round_trip, {}, &went);
    if (!ours) return ours.error();
    WaterFelt& f = row.felt.emplace_back();
    f.round_trip = round_trip;
    f.error = water_error(ours.value(), run.value());
    f.learning = water_error(ours.value(), run.value(), kWaterBegins, kWaterLearnt);
    f.moving = water_error(ours.value(), run.value(), kWaterLearnt, kWaterStops);
    f.after = water_error(ours.value(), run.value(), kWaterStops, kWaterEnds);
    if (!row.c.grip.empty()) {
      const Result<WaterRun> right = run_water_again(row.c, went);
      if (!right) return right.error();
      f.same = water_error(ours.value(), right.value());
      f.elsewhere = apart(went, run.value());
      f.late = late_error(right.value(), round_trip);
      continue;  // for the line it would need a world of its own
    }
    const Result<std::vector<Wrench>> line = feel_water(run.value(), round_trip, by_line);
    if (!line) return line.error();
    f.line = water_error(line.value(), run.value());
  }
  return true;
}

const char* words_of(const WaterCase& c) {
  return c.grip.empty() ? "" : c.grip == kPerson ? ", a person" : ", a loose arm";
}

std::string name_of(const WaterRow& row) {
  const WaterWay way = way_of(row.c);
  return format("%.0f mm at %.2f Hz%s", 1e3 * way.reach, way.pace, words_of(row.c));
}

ChartPanel panel_of(const std::vector<WaterRow>& rows, bool person) {
  constexpr const char* kColors[] = {"#2a6fb0", "#c8322b", "#3a9d5d", "#e0893c",
                                     "#7a4fa3", "#808080", "#b5651d", "#208080"};
  ChartPanel panel;
  panel.title = person ? "A simulated person, against the same motion at no delay"
                       : "A hand that goes its way whatever the force";
  panel.x_label = "round trip, ms";
  panel.y_label = "force off, % rms of its change";
  std::size_t color = 0;
  for (const WaterRow& row : rows) {
    if (row.c.grip.empty() == person) continue;
    ChartSeries series;
    series.name = name_of(row) + format(" (%.1f N; repeatability %.0f %%)", row.force, 1e2 * row.chaos);
    series.color = kColors[color++ % std::size(kColors)];
    series.width = 1.5;
    for (const WaterFelt& f : row.felt)
      series.points.push_back({1e3 * f.round_trip, 1e2 * (person ? f.same : f.error)});
    panel.series.push_back(series);
    if (!person) continue;
    series.name = "the same, with where they went by it";
    series.dashed = true;
    for (std::size_t i = 0; i < series.points.size(); ++i) series.points[i].y = 1e2 * row.felt[i].error;
    panel.series.push_back(series);
  }
  return panel;
}

}  // namespace

int report_coupling_water(const ReportOptions& options) {
  if (options.resume)
    return fail({"--resume", "is not for --water, which takes some minutes",
                 "Leave it out; --overwrite measures again into "
                 "the same folder"});
  const Result<std::filesystem::path> folder = report_folder(options, "coupling", kCouplingWaterTable);
  if (!folder) return fail(folder.error());
  catch_interrupts();
  Progress progress;
  const std::vector<double> round_trips =
      options.quick ? std::vector<double>{0.1, 0.4} : std::vector<double>{0.0, 0.05, 0.1, 0.2, 0.3, 0.4};
  std::vector<WaterRow> rows;
  for (int way = 0; way < (options.quick ? 3 : 8); ++way)
    rows.push_back({{0.014, "", way, 0.0}, 0.0, 0.0, {}, {}, {}});
  for (const auto& [grip, way] : {std::pair{kPerson, 2}, {kPerson, 3}, {kPerson, 0}, {kLoosePerson, 2}})
    if (!options.quick || (grip == kPerson && way == 2))
      rows.push_back({{0.014, grip, way, 0.0}, 0.0, 0.0, {}, {}, {}});
  progress.phase("measuring", format("%zu ways of a hand", rows.size()));
  std::size_t done = 0;
  const bool all = run_on_cores(
      rows.size(), options.threads,
      [&](std::size_t i) {
        if (const Result<bool> went = measure(round_trips, rows[i]); !went)
          rows[i].problem = went.error().text();
      },
      [&](std::size_t i) {
        done += 1;
        progress.update(static_cast<double>(done) / static_cast<double>(rows.size()), name_of(rows[i]));
      },
      [] { return interrupted_by() != 0; });
  for (const WaterRow& row : rows)
    if (!row.problem.empty()) return fail({"the bucket", row.problem, "Is this a whole build or package?"});
  if (!all)
    rows.erase(std::remove_if(rows.begin(), rows.end(), [](const WaterRow& row) { return row.felt.empty(); }),
               rows.end());
  std::string text =
      "way,reach_mm,pace_hz,hand,force_n,chance,rigid_leaves,modes_leave,lifts_leave,round_trip_ms,force_"
      "error,error_to_1500ms,"
      "error_moving,error_after,error_by_line,error_for_the_same_motion,hand_elsewhere_mm,error_known_late\n";
  std::printf("%-30s force   repeats a model leaves: rigid, modes, lift   force off at", "a hand's way");
  for (const double round_trip : round_trips) std::printf(" %.0f", 1e3 * round_trip);
  std::printf(" ms\n");
  for (const WaterRow& row : rows) {
    const WaterWay way = way_of(row.c);
    std::printf("%-30s %4.1f N  %5.1f %%  %21.0f %% %4.0f %% %4.0f %%              ", name_of(row).c_str(),
                row.force, 1e2 * row.chaos, 1e2 * row.split.rigid, 1e2 * row.split.modes,
                1e2 * row.split.lifts);
    for (const WaterFelt& f : row.felt) {
      std::printf(" %.0f", 1e2 * f.error);
      text += format("%d,%.3g,%.3g,%s,%.4g,%.4g,%.4g,%.4g,%.4g,%g,%.4g,%.4g,%.4g,%.4g,", row.c.way,
                     1e3 * way.reach, way.pace,
                     row.c.grip.empty()      ? "led"
                     : row.c.grip == kPerson ? "person"
                                             : "loose",
                     row.force, row.chaos, row.split.rigid, row.split.modes, row.split.lifts,
                     1e3 * f.round_trip, f.error, f.learning, f.moving, f.after) +
              (row.c.grip.empty() ? format("%.4g,,,", f.line)
                                  : format(",%.4g,%.4g,%.4g", f.same, 1e3 * f.elsewhere, f.late)) +
              "\n";
    }
    std::printf(" %%\n");
    if (row.c.grip.empty() || row.felt.empty()) continue;
    std::printf("%-91s", "  for the same motion at no delay (the rest is where the person went by it)");
    for (const WaterFelt& f : row.felt) std::printf(" %.1f", 1e2 * f.same);
    std::printf(" %%; elsewhere by");
    for (const WaterFelt& f : row.felt) std::printf(" %.1f", 1e3 * f.elsewhere);
    std::printf(" mm; known a round trip late");
    for (const WaterFelt& f : row.felt) std::printf(" %.1f", 1e2 * f.late);
    std::printf(" %%\n");
  }
  if (const Result<bool> written = write_whole(folder.value() / kCouplingWaterTable, text); !written)
    return fail(written.error());
  std::vector<ChartPanel> panels{panel_of(rows, false), panel_of(rows, true)};
  // The ways' names are long: beside the curves, not over them.
  ChartPanel key;
  key.key_alone = true;
  for (ChartPanel& panel : panels) {
    panel.legend = false;
    key.series.insert(key.series.end(), panel.series.begin(), panel.series.end());
  }
  panels.push_back(key);
  const std::string script =
      chart_script(panels, static_cast<int>(panels.size()), "One hand on a bucket of water, over a delay",
                   "png", machine_line(options));
  if (const Result<bool> drawn = draw(script, folder.value() / "coupling_water.png"); !drawn)
    return fail(drawn.error());
  std::printf("Written to %s: coupling_water.csv and .png\n",
              clean_text(folder.value().string(), kMaxTextBytes).c_str());
  const int signal = interrupted_by();
  return signal != 0 ? 128 + signal : kExitOk;
}

}  // namespace slosh
