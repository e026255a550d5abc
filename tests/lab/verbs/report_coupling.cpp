// `slosh report coupling`: hands at several sites on one body, in virtual time: where each scheme is steady,
// and how far off its force is.
#include "tests/lab/verbs/report_coupling.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "net/clock.h"
#include "net/text/clean.h"
#include "peer/output/chart.h"
#include "peer/output/gnuplot.h"
#include "peer/output/progress.h"
#include "peer/output/whole_file.h"
#include "peer/app/interrupt.h"
#include "peer/app/verbs.h"
#include "sim/math/format.h"
#include "tests/lab/coupling/cells.h"
#include "tests/lab/verbs/on_cores.h"
#include "tests/lab/verbs/report.h"

namespace slosh {
namespace {

using coupling::Case;
using coupling::Scheme;

constexpr const char* kCouplingTable = "coupling.csv";
using coupling::kMapped;
using coupling::Row;

TileMap map_of(const std::vector<Row>& rows, Scheme scheme, const std::string& machine) {
  TileMap map;
  map.title = format("Hands on one body: %s", coupling::word(scheme));
  map.subtitle = "columns: round trip; on the tiles: energy generated. " + machine;
  map.kinds = {{"stable", "#3a9d5d"}, {"limit cycle", "#e0b93c"}, {"diverged", "#c8322b"}};
  for (const Row& row : rows) {
    if (row.scheme != scheme) continue;
    const std::string column = format("%g ms", 1e3 * row.c.round_trip);
    if (std::find(map.rows.begin(), map.rows.end(), row.c.name) == map.rows.end())
      map.rows.push_back(row.c.name);
    if (std::find(map.columns.begin(), map.columns.end(), column) == map.columns.end())
      map.columns.push_back(column);
  }
  map.kind.assign(map.rows.size(), std::vector<int>(map.columns.size(), -1));
  map.text.assign(map.rows.size(), std::vector<std::string>(map.columns.size()));
  for (const Row& row : rows) {
    if (row.scheme != scheme) continue;
    const std::string column = format("%g ms", 1e3 * row.c.round_trip);
    const auto r =
        static_cast<std::size_t>(std::find(map.rows.begin(), map.rows.end(), row.c.name) - map.rows.begin());
    const auto c = static_cast<std::size_t>(std::find(map.columns.begin(), map.columns.end(), column) -
                                            map.columns.begin());
    map.kind[r][c] = static_cast<int>(row.verdict);
    const double mj = 1e3 * row.generated;
    if (mj >= 0.1) map.text[r][c] = mj < 1e3 ? format("%.2g mJ", mj) : format("%.2g J", 1e-3 * mj);
  }
  return map;
}

/// Force error over the round trip, a panel a case.
std::vector<ChartPanel> error_panels(const std::vector<Row>& rows) {
  constexpr const char* kShown[] = {"alone, tight", "one of two moves", "opposing", "fluid, alone"};
  constexpr const char* kColors[] = {"#c8322b", "#e0893c", "#2a6fb0"};
  std::vector<ChartPanel> panels;
  for (const char* shown : kShown) {
    ChartPanel& panel = panels.emplace_back();
    panel.title = std::string("Force against zero delay: ") + shown;
    panel.x_label = "round trip, ms";
    panel.y_label = "error, % rms (above 300: not shown)";
    for (std::size_t s = 0; s < std::size(kMapped); ++s) {
      ChartSeries series;
      series.name = coupling::word(kMapped[s]);
      series.color = kColors[s];
      series.width = 1.5;
      for (const Row& row : rows) {
        if (row.scheme == kMapped[s] && row.c.name == shown && row.error <= 3.0)
          series.points.push_back({1e3 * row.c.round_trip, 1e2 * row.error});
      }
      panel.series.push_back(series);
    }
  }
  return panels;
}

/// The longest round trip at which one hand holds steadily.
struct Bound {
  const char* grip;
  Scheme scheme;
  double stiffness;        // N/m
  double steady = 0.0;     // s
  double by_theory = 0.0;  // s, of a spring
};

/// By halving, one a grip, scheme and stiffness; nothing when it was interrupted.
std::vector<Bound> measure_bounds(const ReportOptions& options, Progress& progress) {
  std::vector<Bound> bounds;
  for (const char* grip : {"tight", "loose"})
    for (const Scheme scheme : kMapped)
      for (const double stiffness : {200.0, 500.0, 1000.0, 2000.0})
        bounds.push_back({grip, scheme, stiffness});
  const auto find = [&](Bound& bound) {
    Case c;
    c.hands = 1;
    c.grip = bound.grip;
    c.stiffness = bound.stiffness;
    bound.by_theory = coupling::spring_bound(c);
    const auto steady = [&](double round_trip) {
      c.round_trip = round_trip;
      return coupling::run(c, bound.scheme).verdict == coupling::Verdict::kStable;
    };
    double low = 0.0, high = 0.5;
    if (steady(high)) low = high;
    for (int i = 0; low < high && i < (options.quick ? 5 : 8); ++i) {
      const double middle = 0.5 * (low + high);
      (steady(middle) ? low : high) = middle;
    }
    bound.steady = low;
  };
  double done = 0.0;
  const bool all = run_on_cores(
      bounds.size(), options.threads, [&](std::size_t i) { find(bounds[i]); },
      [&](std::size_t i) {
        done += 1.0 / static_cast<double>(bounds.size());
        progress.update(
            done, format("%g N/m, %s, %s", bounds[i].stiffness, bounds[i].grip, word(bounds[i].scheme)));
      },
      [] { return interrupted_by() != 0; });
  if (!all) bounds.clear();
  return bounds;
}

Result<bool> write_bounds(const std::vector<Bound>& bounds, const std::filesystem::path& file) {
  std::string text = "grip,scheme,stiffness_n_m,steady_round_trip_ms,gil_hulin_ms\n";
  for (const Bound& b : bounds)
    text += format("%s,%s,%g,%.4g,%.4g\n", b.grip, word(b.scheme), b.stiffness, 1e3 * b.steady,
                   1e3 * b.by_theory);
  return write_whole(file, text);
}

/// By stiffness, and what theory says of a spring.
ChartPanel bound_panel(const std::vector<Bound>& bounds, const std::string& grip) {
  ChartPanel panel;
  panel.title = "Longest steady round trip, one hand, " + grip;
  panel.x_label = "stiffness, N/m";
  panel.y_label = "round trip, ms (500: none found)";
  panel.log_x = true;
  panel.log_y = true;
  constexpr const char* kColors[] = {"#c8322b", "#e0893c", "#2a6fb0"};
  ChartSeries gil;
  gil.name = "Gil & Hulin: (b + B)/K − T/2";
  gil.color = "#808080";
  gil.mark = 0;
  gil.width = 1.5;
  gil.dashed = true;
  for (std::size_t s = 0; s < std::size(kMapped); ++s) {
    ChartSeries series;
    series.name = word(kMapped[s]);
    series.color = kColors[s];
    series.width = 1.5;
    for (const Bound& b : bounds) {
      if (b.grip != grip || b.scheme != kMapped[s]) continue;
      series.points.push_back({b.stiffness, 1e3 * b.steady});
      if (s == 0) gil.points.push_back({b.stiffness, 1e3 * b.by_theory});
    }
    panel.series.push_back(series);
  }
  panel.series.push_back(gil);
  return panel;
}

void print_summary(const std::vector<Row>& rows) {
  for (const Scheme scheme : kMapped) {
    int counts[3] = {0, 0, 0};
    double worst = 0.0;
    int steps = 0;
    for (const Row& row : rows) {
      if (row.scheme != scheme || row.c.round_trip > 0.3001) continue;
      counts[static_cast<std::size_t>(row.verdict)] += 1;
      worst = std::max(worst, row.generated);
      steps += row.verdict == coupling::Verdict::kDiverged ? 0 : row.steps;
    }
    std::printf(
        "%-12s to 300 ms: stable %d, limit cycle %d, diverged %d; most energy generated %.3g mJ, "
        "steps over 1 N within 2 ms where it did not diverge: %d\n",
        coupling::word(scheme), counts[0], counts[1], counts[2], 1e3 * worst, steps);
  }
}

}  // namespace

int report_coupling(const ReportOptions& options) {
  ReportOptions here = options;
  here.overwrite = options.overwrite || options.resume;
  const Result<std::filesystem::path> folder = report_folder(here, "coupling", kCouplingTable);
  if (!folder) return fail(folder.error());
  catch_interrupts();
  Progress progress;
  const std::vector<Case> cases = coupling::map_cases(options.quick);
  const std::vector<double> round_trips = coupling::map_round_trips(options.quick);
  const std::size_t cells = cases.size() * round_trips.size() * std::size(kMapped);
  progress.phase("measuring", format("%zu runs", cells));
  const std::int64_t all_began_ns = steady_now_ns();
  std::int64_t began_ns = all_began_ns;
  coupling::CellRun run;
  run.jobs = options.threads;
  run.resume = options.resume;
  run.stop = [] { return interrupted_by() != 0; };
  run.told = [&](double share, const std::string& which) {
    const double passed = to_seconds(steady_now_ns() - began_ns);
    const double left = share > 0.0 ? passed * (1.0 - share) / share : 0.0;
    progress.update(share, which + format(", about %.0f min left", std::ceil(left / 60.0)));
  };
  const Result<std::vector<Row>> measured =
      measure_cells(cases, round_trips, folder.value() / kCouplingTable, run);
  if (!measured) return fail(measured.error());
  const std::vector<Row>& rows = measured.value();
  print_summary(rows);

  // All numbers before the first picture: these need gnuplot.
  TileMap bucket;
  if (!options.quick && interrupted_by() == 0) {
    progress.phase("measuring", "the bucket of water");
    began_ns = steady_now_ns();
    const Result<bool> told = report_bucket(folder.value(), run, machine_line(options), bucket);
    if (!told) return fail(told.error());
  }
  std::vector<Bound> bounds;
  std::vector<ChartPanel> transparency, spectra;
  if (interrupted_by() == 0) {
    progress.phase("measuring", "bounds");
    bounds = measure_bounds(options, progress);
    if (!bounds.empty()) {
      if (const Result<bool> written = write_bounds(bounds, folder.value() / "bounds.csv"); !written)
        return fail(written.error());
    }
    using Part = Result<bool> (*)(const ReportOptions&, const std::filesystem::path&, Progress&,
                                  std::vector<ChartPanel>&);
    for (const auto& [part, drawn] :
         {std::pair<Part, std::vector<ChartPanel>*>{report_transparency, &transparency},
          {report_spectra, &spectra}}) {
      if (interrupted_by() != 0) break;
      const Result<bool> told = part(options, folder.value(), progress, *drawn);
      if (!told) return fail(told.error());
    }
  }
  const int signal = interrupted_by();
  if (signal != 0)
    progress.note("interrupted: drawing what there is; `slosh report coupling" +
                  std::string(options.quick ? " --quick" : "") +
                  (options.out.empty() ? "" : " --out " + clean_text(options.out, kMaxTextBytes)) +
                  " --resume` goes on");
  std::vector<ChartPanel> panels = error_panels(rows);
  if (!bounds.empty())
    for (const char* grip : {"tight", "loose"}) panels.push_back(bound_panel(bounds, grip));
  struct Drawing {
    std::string script, name;
  };
  std::vector<Drawing> pictures;
  for (const Scheme scheme : kMapped) {
    if (rows.empty()) break;
    std::string name = std::string("map_") + coupling::word(scheme) + ".png";
    std::replace(name.begin(), name.end(), ' ', '_');
    pictures.push_back({tile_script(map_of(rows, scheme, machine_line(options))), name});
  }
  if (!bucket.rows.empty()) pictures.push_back({tile_script(bucket), "bucket.png"});
  pictures.push_back({chart_script(panels, 2, "Hands at a distance, in virtual time"), "force_error.png"});
  if (!transparency.empty())
    pictures.push_back(
        {chart_script(transparency, 2, "Transparency: what a hand is rendered, and what it should be"),
         "transparency.png"});
  if (!spectra.empty())
    pictures.push_back(
        {chart_script(spectra, 2, "Spectrum of a hand's force, by the host's rate"), "spectrum.png"});
  for (const Drawing& picture : pictures) {
    const Result<bool> drawn = draw(picture.script, folder.value() / picture.name);
    if (drawn) continue;
    Error error = drawn.error();
    error.mend += "; the tables are whole, and `slosh report coupling --resume` with this folder draws them";
    return fail(error);
  }
  std::printf(
      "Written in %.0f s: %s/coupling.csv (%zu of %zu cells), a map_….png each scheme, force_error.png with "
      "bounds.csv, and transparency%s as csv and png\n",
      to_seconds(steady_now_ns() - all_began_ns), clean_text(folder.value().string(), kMaxTextBytes).c_str(),
      rows.size(), cells, bucket.rows.empty() ? " and spectrum" : ", spectrum and bucket");
  return signal != 0 ? 128 + signal : kExitOk;
}

}  // namespace slosh
