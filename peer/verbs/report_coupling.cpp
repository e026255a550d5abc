// `slosh report coupling`: hands at several sites on one body, in virtual time: where each scheme is steady,
// and how far off its force is.
#include "peer/verbs/report_coupling.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>

#include "host/report/csv.h"
#include "net/text/clean.h"
#include "peer/output/chart.h"
#include "peer/output/gnuplot.h"
#include "peer/output/progress.h"
#include "peer/verbs/coupling/study.h"
#include "peer/verbs/interrupt.h"
#include "peer/verbs/report.h"
#include "peer/verbs/verbs.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

using coupling::Case;
using coupling::Outcome;
using coupling::Scheme;

constexpr const char* kTable = "coupling.csv";
constexpr const char* kHeader =
    "case,scheme,hands,stiffness_n_m,grip,round_trip_ms,jitter_ms,loss,pose_rate_hz,host_rate_hz,verdict,"
    "generated_mj,force_error,peak_n,swing_mm_s,guarded,fell_back";
constexpr Scheme kSchemes[] = {Scheme::kHostForce, Scheme::kPeerSpring, Scheme::kReplica};

struct Row {
  Case c;
  Scheme scheme;
  coupling::Verdict verdict;
  double generated, error, peak, swing, fired;
  bool fell_back;
};

std::string csv_line(const Row& r) {
  return report::csv_field(r.c.name) + "," + coupling::word(r.scheme) +
         format(",%d,%g,", r.c.hands, r.c.stiffness) + report::csv_field(r.c.grip) +
         format(",%g,%g,%g,%g,%g,%s,%.4g,%.4g,%.4g,%.4g,%.3g,%d", 1e3 * r.c.round_trip, 1e3 * r.c.jitter,
                r.c.loss, r.c.pose_rate, r.c.host_rate, coupling::word(r.verdict), 1e3 * r.generated, r.error,
                r.peak, 1e3 * r.swing, r.fired, r.fell_back ? 1 : 0);
}

std::vector<double> round_trips(bool quick) {
  if (quick) return {0.0, 0.05, 0.1, 0.2, 0.3};
  return {0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5};
}

/// The cases of the map: alone, what broke schemes, and in a full report every number of hands, stiffness,
/// grip and link.
std::vector<Case> cases_of(bool quick) {
  std::vector<Case> cases;
  for (const char* grip : {"tight", "loose,mass=1.5"}) {
    Case& alone = cases.emplace_back();
    alone.hands = 1;
    alone.grip = grip;
    alone.name = std::string("alone, ") + (alone.grip == "tight" ? "tight" : "loose");
  }
  for (const Case& c : coupling::known_breakers()) cases.push_back(c);
  if (quick) return cases;
  struct Link {
    const char* name;
    double jitter, loss, poses, host;
  };
  constexpr Link kLinks[] = {{"good link", 0.0, 0.0, 500.0, 500.0},
                             {"40 ms, 20 %", 0.04, 0.2, 500.0, 500.0},
                             {"40 ms, 20 %, 60 Hz", 0.04, 0.2, 60.0, 70.0}};
  for (const int hands : {2, 4, 8}) {
    for (const double stiffness : {200.0, 700.0, 2000.0}) {
      for (const char* grip : {"tight", "loose"}) {
        for (const Link& link : kLinks) {
          Case& c = cases.emplace_back();
          c.hands = hands;
          c.stiffness = stiffness;
          c.grip = grip;
          c.motion = coupling::Motion::kOpposing;
          c.jitter = link.jitter;
          c.loss = link.loss;
          c.pose_rate = link.poses;
          c.host_rate = link.host;
          c.name = format("%d hands, %g N/m, %s, %s", hands, stiffness, grip, link.name);
        }
      }
    }
  }
  return cases;
}

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
    for (std::size_t s = 0; s < std::size(kSchemes); ++s) {
      ChartSeries series;
      series.name = coupling::word(kSchemes[s]);
      series.color = kColors[s];
      series.width = 1.5;
      for (const Row& row : rows) {
        if (row.scheme == kSchemes[s] && row.c.name == shown && row.error <= 3.0)
          series.points.push_back({1e3 * row.c.round_trip, 1e2 * row.error});
      }
      panel.series.push_back(series);
    }
  }
  return panels;
}

/// The longest round trip at which one hand holds steadily, by stiffness, found by halving; and what theory
/// says of a spring.
ChartPanel bound_panel(const std::string& grip, bool quick, Progress& progress) {
  ChartPanel panel;
  panel.title = "Longest steady round trip, one hand, " + grip;
  panel.x_label = "stiffness, N/m";
  panel.y_label = "round trip, ms (500: none found)";
  panel.log_x = true;
  panel.log_y = true;
  const auto steady = [&](const Case& c, Scheme scheme) {
    return coupling::run(c, scheme).verdict == coupling::Verdict::kStable;
  };
  constexpr const char* kColors[] = {"#c8322b", "#e0893c", "#2a6fb0"};
  ChartSeries gil;
  gil.name = "Gil & Hulin: (b + B)/K − T/2";
  gil.color = "#808080";
  gil.mark = 0;
  gil.width = 1.5;
  gil.dashed = true;
  for (std::size_t s = 0; s < std::size(kSchemes); ++s) {
    ChartSeries series;
    series.name = coupling::word(kSchemes[s]);
    series.color = kColors[s];
    series.width = 1.5;
    for (const double stiffness : {200.0, 500.0, 1000.0, 2000.0}) {
      if (interrupted_by() != 0) return panel;
      progress.update(-1.0, panel.title);
      Case c;
      c.hands = 1;
      c.grip = grip;
      c.stiffness = stiffness;
      double low = 0.0, high = 0.5;
      c.round_trip = high;
      if (steady(c, kSchemes[s])) low = high;
      for (int i = 0; low < high && i < (quick ? 5 : 8); ++i) {
        c.round_trip = 0.5 * (low + high);
        (steady(c, kSchemes[s]) ? low : high) = c.round_trip;
      }
      series.points.push_back({stiffness, 1e3 * low});
      if (s == 0) gil.points.push_back({stiffness, 1e3 * coupling::spring_bound(c)});
    }
    panel.series.push_back(series);
  }
  panel.series.push_back(gil);
  return panel;
}

void print_summary(const std::vector<Row>& rows) {
  for (const Scheme scheme : kSchemes) {
    int counts[3] = {0, 0, 0};
    double worst = 0.0;
    for (const Row& row : rows) {
      if (row.scheme != scheme || row.c.round_trip > 0.3001) continue;
      counts[static_cast<std::size_t>(row.verdict)] += 1;
      worst = std::max(worst, row.generated);
    }
    std::printf("%-12s to 300 ms: stable %d, limit cycle %d, diverged %d; most energy generated %.3g mJ\n",
                coupling::word(scheme), counts[0], counts[1], counts[2], 1e3 * worst);
  }
}

}  // namespace

int report_coupling(const ReportOptions& options) {
  const Result<std::filesystem::path> folder = report_folder(options, "coupling", kTable);
  if (!folder) return fail(folder.error());
  catch_interrupts();
  const std::filesystem::path table = folder.value() / kTable;
  std::ofstream out(table);
  out << kHeader << '\n';
  std::vector<Row> rows;
  Progress progress;
  std::vector<ReportJob> jobs;
  for (const Case& c : cases_of(options.quick)) {
    jobs.push_back({c.name, static_cast<double>(c.hands), [&, c] {
                      if (interrupted_by() != 0) throw report::Stopped();
                      const Outcome reference = coupling::run(c, Scheme::kZeroDelay);
                      for (const Scheme scheme : kSchemes) {
                        for (const double round_trip : round_trips(options.quick)) {
                          Case at = c;
                          at.round_trip = round_trip;
                          const Outcome o = coupling::run(at, scheme);
                          rows.push_back({at, scheme, o.verdict, o.generated, force_error(o, reference),
                                          o.peak, o.swing, o.fired, o.fell_back});
                          out << csv_line(rows.back()) << '\n';
                        }
                      }
                    }});
  }
  if (const Result<bool> ran = run_jobs(jobs, out, table, progress); !ran) return fail(ran.error());
  std::vector<ChartPanel> panels = error_panels(rows);
  progress.phase("measuring", "bounds");
  for (const char* grip : {"tight", "loose"}) panels.push_back(bound_panel(grip, options.quick, progress));
  print_summary(rows);
  for (const Scheme scheme : kSchemes) {
    std::string name = std::string("map_") + coupling::word(scheme) + ".png";
    std::replace(name.begin(), name.end(), ' ', '_');
    const Result<bool> drawn =
        draw(tile_script(map_of(rows, scheme, machine_line(options))), folder.value() / name);
    if (!drawn) return fail(drawn.error());
  }
  const Result<bool> drawn = draw(chart_script(panels, 2, "Hands at a distance, in virtual time"),
                                  folder.value() / "force_error.png");
  if (!drawn) return fail(drawn.error());
  for (const auto part : {report_transparency, report_spectra}) {
    const Result<bool> told = part(options, folder.value(), progress);
    if (!told) return fail(told.error());
  }
  std::printf(
      "Written: %s/coupling.csv, a map_….png each scheme, force_error.png, and transparency and spectrum as "
      "csv and png\n",
      clean_text(folder.value().string(), kMostTextBytes).c_str());
  return kExitOk;
}

}  // namespace slosh
