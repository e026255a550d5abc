// `slosh report coupling`, parts (b) and (c): what impedance a hand is rendered, and what its force is made
// of.
#include <cstdio>
#include <fstream>
#include <functional>

#include "peer/output/chart.h"
#include "peer/app/interrupt.h"
#include "sim/math/format.h"
#include "tests/lab/coupling/response.h"
#include "tests/lab/report/csv.h"
#include "tests/lab/verbs/on_cores.h"
#include "tests/lab/verbs/report_coupling.h"

namespace slosh {
namespace {

using coupling::Case;
using coupling::Impedance;
using coupling::Line;
using coupling::Load;
using coupling::Outcome;
using coupling::Scheme;

constexpr double kDegrees = 57.29577951308232;
constexpr double kSettles = 10.0;  // s, before an impedance is taken
constexpr double kTaken = 20.0;    // s
constexpr const char* kResponseColors[] = {"#2a6fb0", "#3a9d5d", "#e0893c", "#c8322b", "#7b4fa6"};

struct Site {
  const char* name;
  int hands;
  Load load;
};
constexpr Site kSites[] = {{"alone on a rigid body", 1, Load::kNone},
                           {"another hand holds it still", 2, Load::kNone},
                           {"alone, fluid that swings", 1, Load::kFluid}};

Result<bool> written(std::ofstream& out, const std::filesystem::path& file) {
  out.flush();
  if (out) return true;
  return Error{file.string(), "cannot be written", "Choose a folder with room that you may write to"};
}

Case toned(const Site& site, double round_trip) {
  Case c;
  c.hands = site.hands;
  c.load = site.load;
  c.tones = coupling::transparency_tones();
  c.seconds = kSettles + kTaken;
  c.round_trip = round_trip;
  return c;
}

/// Each of `count` on all cores. False when it was interrupted.
bool on_all(const ReportOptions& options, Progress& progress, std::size_t count,
            const std::function<void(std::size_t)>& measure) {
  std::size_t done = 0;
  return run_on_cores(
      count, options.threads, measure,
      [&](std::size_t) {
        done += 1;
        progress.update(static_cast<double>(done) / static_cast<double>(count),
                        format("%zu of %zu", done, count));
      },
      [] { return interrupted_by() != 0; });
}

ChartSeries curve(const std::string& name, const char* color) {
  ChartSeries series;
  series.name = name;
  series.color = color;
  series.width = 1.5;
  series.size = 0.6;
  return series;
}

}  // namespace

Result<bool> report_transparency(const ReportOptions& options, const std::filesystem::path& folder,
                                 Progress& progress, std::vector<ChartPanel>& panels) {
  const std::vector<double> round_trips =
      options.quick ? std::vector<double>{0.05, 0.2} : std::vector<double>{0.02, 0.05, 0.1, 0.2, 0.4};
  // What is commanded of each site, then what each scheme renders there.
  struct Part {
    const Site* site;
    Scheme scheme;
    std::size_t trip = 0;  // which of the round trips
    bool diverged = false;
    std::vector<Impedance> z = {};
  };
  std::vector<Part> parts;
  for (const Site& site : kSites) {
    parts.push_back({&site, Scheme::kZeroDelay});
    for (const Scheme scheme : {Scheme::kReplica, Scheme::kPeerSpring})
      for (std::size_t i = 0; i < round_trips.size(); ++i) parts.push_back({&site, scheme, i});
  }
  progress.phase("measuring", "transparency");
  const bool all = on_all(options, progress, parts.size(), [&](std::size_t i) {
    Part& part = parts[i];
    const Case c = toned(*part.site, part.scheme == Scheme::kZeroDelay ? 0.0 : round_trips[part.trip]);
    const Outcome run = coupling::run(c, part.scheme);
    part.diverged = run.verdict == coupling::Verdict::kDiverged;
    if (!part.diverged) part.z = coupling::impedance(run, part.site->hands, c.tones, kTaken);
  });
  if (!all) return true;

  const std::filesystem::path file = folder / "transparency.csv";
  std::ofstream out(file);
  out << "site,scheme,round_trip_ms,frequency_hz,rendered_n_s_m,rendered_phase_deg,commanded_n_s_m,"
         "commanded_phase_deg\n";
  std::vector<Impedance> commanded;
  for (const Part& part : parts) {
    const Site& site = *part.site;
    if (part.scheme == Scheme::kZeroDelay) {
      commanded = part.z;
      ChartPanel size, phase;
      size.title = std::string("Impedance, ") + site.name;
      size.y_label = "N·s/m";
      phase.title = std::string("Its phase, ") + site.name;
      phase.y_label = "degrees (90: a mass, -90: a spring)";
      phase.legend = false;
      size.x_label = phase.x_label = "Hz";
      size.log_x = size.log_y = phase.log_x = true;
      ChartSeries wanted = curve("commanded", "#303030"), wanted_phase = curve("", "#303030");
      wanted.mark = wanted_phase.mark = 0;
      wanted.width = wanted_phase.width = 3.0;
      for (const Impedance& z : commanded) {
        wanted.points.push_back({z.frequency, z.size});
        wanted_phase.points.push_back({z.frequency, kDegrees * z.phase});
      }
      size.series.push_back(wanted);
      phase.series.push_back(wanted_phase);
      panels.push_back(size);
      panels.push_back(phase);
      continue;
    }
    const double trip_ms = 1e3 * round_trips[part.trip];
    if (part.diverged) {
      std::printf("%-28s %-11s %3.0f ms: diverged\n", site.name, coupling::word(part.scheme), trip_ms);
      continue;
    }
    const std::string name = format("%s, %g ms", coupling::word(part.scheme), trip_ms);
    ChartSeries series = curve(name, kResponseColors[part.trip]),
                turn = curve("", kResponseColors[part.trip]);
    series.dashed = turn.dashed = part.scheme == Scheme::kPeerSpring;
    for (std::size_t k = 0; k < part.z.size(); ++k) {
      const Impedance& z = part.z[k];
      series.points.push_back({z.frequency, z.size});
      turn.points.push_back({z.frequency, kDegrees * z.phase});
      out << report::csv_field(site.name) << ','
          << format("%s,%g,%g,%.4g,%.2f,%.4g,%.2f\n", coupling::word(part.scheme), trip_ms, z.frequency,
                    z.size, kDegrees * z.phase, commanded[k].size, kDegrees * commanded[k].phase);
    }
    panels[panels.size() - 2].series.push_back(series);
    panels.back().series.push_back(turn);
    std::printf("%-28s %-11s %3.0f ms: impedance off by %.0f %% at most, 0.1 to 30 Hz\n", site.name,
                coupling::word(part.scheme), trip_ms, 1e2 * coupling::farthest_off(part.z, commanded));
  }
  return written(out, file);
}

Result<bool> report_spectra(const ReportOptions& options, const std::filesystem::path& folder,
                            Progress& progress, std::vector<ChartPanel>& panels) {
  Case c;
  c.hands = 1;
  c.body_mass = 1.0;
  c.round_trip = 0.0;
  c.grip = "tight,tremor=0.0005";
  c.seconds = 5.0;
  c.load = Load::kSyrup;
  const std::vector<double> rates =
      options.quick ? std::vector<double>{60.0, 100.0, 200.0, 500.0}
                    : std::vector<double>{60.0, 100.0, 150.0, 200.0, 300.0, 500.0, 700.0, 1000.0};
  struct Way {
    const char* name;
    Load load;
    Scheme scheme;
    const char* color;
  };
  constexpr Way kWays[] = {{"host's force held", Load::kSyrup, Scheme::kHostForce, "#c8322b"},
                           {"replica, no model", Load::kSyrupUntold, Scheme::kReplica, "#e0893c"},
                           {"replica, model", Load::kSyrup, Scheme::kReplica, "#2a6fb0"}};
  struct Part {
    Outcome run;
    std::vector<Line> lines;
  };
  constexpr std::size_t kEach = std::size(kWays);
  std::vector<Part> parts(1 + rates.size() * kEach);  // the truth, then each rate's ways
  progress.phase("measuring", "spectra");
  const bool all = on_all(options, progress, parts.size(), [&](std::size_t i) {
    Case at = c;
    if (i > 0) {
      at.load = kWays[(i - 1) % kEach].load;
      at.host_rate = rates[(i - 1) / kEach];
    }
    parts[i].run = coupling::run(at, i == 0 ? Scheme::kZeroDelay : kWays[(i - 1) % kEach].scheme);
    parts[i].lines = coupling::force_spectrum(parts[i].run, 1, 0.5, 4.5);
  });
  if (!all) return true;

  const std::filesystem::path file = folder / "spectrum.csv";
  std::ofstream out(file);
  out << "host_rate_hz,model,frequency_hz,force_n\n";
  const auto series_of = [](const char* name, const char* color, const std::vector<Line>& lines) {
    ChartSeries series = curve(name, color);
    series.mark = 0;
    series.width = 1.0;
    for (const Line& line : lines) series.points.push_back({line.frequency, line.force});
    return series;
  };
  for (std::size_t r = 0; r < rates.size(); ++r) {
    const double rate = rates[r];
    ChartPanel& panel = panels.emplace_back();
    panel.title = format("Force in a syrup, host at %g Hz", rate);
    panel.x_label = "Hz";
    panel.y_label = std::string("N");
    panel.log_x = panel.log_y = true;
    for (std::size_t w = 0; w < kEach; ++w) {
      const Part& part = parts[1 + r * kEach + w];
      panel.series.push_back(series_of(kWays[w].name, kWays[w].color, part.lines));
      for (const Line& line : part.lines)
        out << format("%g,", rate) << report::csv_field(kWays[w].name)
            << format(",%g,%.4g\n", line.frequency, line.force);
      std::printf("host at %4.0f Hz, %-18s force off by %5.1f %%, tone at its rate %.2f %% of the largest\n",
                  rate, kWays[w].name, 1e2 * coupling::force_error(part.run, parts[0].run),
                  1e2 * (rate < 500.0 ? coupling::tone_at(part.lines, rate) : 0.0));
    }
    panel.series.push_back(series_of("host at 1 kHz, beside the hand", "#303030", parts[0].lines));
  }
  return written(out, file);
}

}  // namespace slosh
