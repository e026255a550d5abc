// `slosh report coupling`, parts (b) and (c): what impedance a hand is rendered, and what its force is made
// of.
#include <cstdio>
#include <fstream>

#include "host/report/csv.h"
#include "peer/output/chart.h"
#include "peer/output/gnuplot.h"
#include "peer/verbs/coupling/response.h"
#include "peer/verbs/interrupt.h"
#include "peer/verbs/report_coupling.h"
#include "sim/math/format.h"

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
constexpr const char* kColors[] = {"#2a6fb0", "#3a9d5d", "#e0893c", "#c8322b", "#7b4fa6"};

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
                                 Progress& progress) {
  const std::filesystem::path file = folder / "transparency.csv";
  std::ofstream out(file);
  out << "site,scheme,round_trip_ms,frequency_hz,rendered_n_s_m,rendered_phase_deg,commanded_n_s_m,"
         "commanded_phase_deg\n";
  std::vector<ChartPanel> panels;
  const std::vector<double> round_trips =
      options.quick ? std::vector<double>{0.05, 0.2} : std::vector<double>{0.02, 0.05, 0.1, 0.2, 0.4};
  for (const Site& site : kSites) {
    const Case c0 = toned(site, 0.0);
    const std::vector<Impedance> commanded =
        coupling::impedance(coupling::run(c0, Scheme::kZeroDelay), site.hands, c0.tones, kTaken);
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
    for (const Scheme scheme : {Scheme::kReplica, Scheme::kPeerSpring}) {
      for (std::size_t i = 0; i < round_trips.size(); ++i) {
        if (interrupted_by() != 0) return Error{"", "interrupted", ""};
        progress.update(-1.0, size.title);
        const Case c = toned(site, round_trips[i]);
        const Outcome run = coupling::run(c, scheme);
        if (run.verdict == coupling::Verdict::kDiverged) {
          std::printf("%-28s %-11s %3.0f ms: diverged\n", site.name, coupling::word(scheme),
                      1e3 * c.round_trip);
          continue;
        }
        const std::vector<Impedance> z = coupling::impedance(run, site.hands, c.tones, kTaken);
        const std::string name = format("%s, %g ms", coupling::word(scheme), 1e3 * c.round_trip);
        ChartSeries series = curve(name, kColors[i]), turn = curve("", kColors[i]);
        series.dashed = turn.dashed = scheme == Scheme::kPeerSpring;
        for (std::size_t k = 0; k < z.size(); ++k) {
          series.points.push_back({z[k].frequency, z[k].size});
          turn.points.push_back({z[k].frequency, kDegrees * z[k].phase});
          out << report::csv_field(site.name) << ','
              << format("%s,%g,%g,%.4g,%.2f,%.4g,%.2f\n", coupling::word(scheme), 1e3 * c.round_trip,
                        z[k].frequency, z[k].size, kDegrees * z[k].phase, commanded[k].size,
                        kDegrees * commanded[k].phase);
        }
        size.series.push_back(series);
        phase.series.push_back(turn);
        std::printf("%-28s %-11s %3.0f ms: impedance off by %.0f %% at most, 0.1 to 30 Hz\n", site.name,
                    coupling::word(scheme), 1e3 * c.round_trip, 1e2 * coupling::farthest_off(z, commanded));
      }
    }
    panels.push_back(size);
    panels.push_back(phase);
  }
  if (const Result<bool> ok = written(out, file); !ok) return ok;
  return draw(chart_script(panels, 2, "Transparency: what a hand is rendered, and what it should be"),
              folder / "transparency.png");
}

Result<bool> report_spectra(const ReportOptions& options, const std::filesystem::path& folder,
                            Progress& progress) {
  const std::filesystem::path file = folder / "spectrum.csv";
  std::ofstream out(file);
  out << "host_rate_hz,model,frequency_hz,force_n\n";
  Case c;
  c.hands = 1;
  c.body_mass = 1.0;
  c.round_trip = 0.0;
  c.grip = "tight,tremor=0.0005";
  c.seconds = 5.0;
  c.load = Load::kSyrup;
  const Outcome reference = coupling::run(c, Scheme::kZeroDelay);
  const auto spectrum_of = [](const Outcome& run) { return coupling::force_spectrum(run, 1, 0.5, 4.5); };
  const std::vector<Line> true_lines = spectrum_of(reference);
  const auto points = [](const std::vector<Line>& lines) {
    std::vector<glm::dvec2> p;
    for (const Line& line : lines) p.push_back({line.frequency, line.force});
    return p;
  };
  std::vector<ChartPanel> panels;
  const std::vector<double> rates =
      options.quick ? std::vector<double>{60.0, 100.0, 200.0, 500.0}
                    : std::vector<double>{60.0, 100.0, 150.0, 200.0, 300.0, 500.0, 700.0, 1000.0};
  for (const double rate : rates) {
    ChartPanel& panel = panels.emplace_back();
    panel.title = format("Force in a syrup, host at %g Hz", rate);
    panel.x_label = "Hz";
    panel.y_label = "N";
    panel.log_x = panel.log_y = true;
    struct Way {
      const char* name;
      Load load;
      Scheme scheme;
      const char* color;
    };
    constexpr Way kWays[] = {{"host's force held", Load::kSyrup, Scheme::kHostForce, "#c8322b"},
                             {"replica, no model", Load::kSyrupUntold, Scheme::kReplica, "#e0893c"},
                             {"replica, model", Load::kSyrup, Scheme::kReplica, "#2a6fb0"}};
    for (const Way& way : kWays) {
      if (interrupted_by() != 0) return Error{"", "interrupted", ""};
      progress.update(-1.0, panel.title);
      c.load = way.load;
      c.host_rate = rate;
      const Outcome run = coupling::run(c, way.scheme);
      const std::vector<Line> lines = spectrum_of(run);
      ChartSeries series = curve(way.name, way.color);
      series.mark = 0;
      series.width = 1.0;
      series.points = points(lines);
      panel.series.push_back(series);
      for (const Line& line : lines)
        out << format("%g,", rate) << report::csv_field(way.name)
            << format(",%g,%.4g\n", line.frequency, line.force);
      std::printf("host at %4.0f Hz, %-18s force off by %5.1f %%, tone at its rate %.2f %% of the largest\n",
                  rate, way.name, 1e2 * coupling::force_error(run, reference),
                  1e2 * (rate < 500.0 ? coupling::tone_at(lines, rate) : 0.0));
    }
    ChartSeries truth = curve("host at 1 kHz, beside the hand", "#303030");
    truth.mark = 0;
    truth.width = 1.0;
    truth.points = points(true_lines);
    panel.series.push_back(truth);
  }
  if (const Result<bool> ok = written(out, file); !ok) return ok;
  return draw(chart_script(panels, 2, "Spectrum of a hand's force, by the host's rate"),
              folder / "spectrum.png");
}

}  // namespace slosh
