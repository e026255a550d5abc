#include "tests/lab/verbs/report_speed_charts.h"

#include <algorithm>
#include <cmath>

#include "peer/output/summary.h"
#include "peer/view/palette.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

using report::RoofRow;
using report::ShareRow;
using report::SpeedRow;
using report::SpeedRows;

constexpr const char* kLimitColor = "#707070";

template <class Row>
std::vector<std::string> devices_in(const std::vector<Row>& rows) {
  std::vector<std::string> names;
  for (const Row& row : rows) {
    if (std::find(names.begin(), names.end(), row.device) == names.end()) names.push_back(row.device);
  }
  return names;
}

ChartSeries marked(const std::string& name, std::size_t color, int mark, bool dashed = false) {
  ChartSeries series;
  series.name = name;
  series.color = device_color(color).hex;
  series.mark = mark;
  series.width = 1.6;
  series.dashed = dashed;
  return series;
}

ChartSeries level(const std::string& name, double from, double to, double value) {
  ChartSeries series;
  series.name = name;
  series.color = kLimitColor;
  series.mark = 0;
  series.width = 1.0;
  series.dashed = true;
  series.points = {{from, value}, {to, value}};
  return series;
}

ChartPanel by_particles(const SpeedRows& rows, const std::vector<std::string>& devices) {
  ChartPanel panel{"6a: a pool of fluid", "fluid particles", "ms", true, true, {}};
  double least = report::kPaperParticles, most = report::kPaperParticles;
  for (std::size_t d = 0; d < devices.size(); ++d) {
    ChartSeries step = marked(devices[d] + ": a step", d, 5);
    ChartSeries with_picture = marked(devices[d] + ": a step and a picture", d, 13, true);
    for (const SpeedRow& row : rows.speeds) {
      if (row.figure != "6a" || row.device != devices[d]) continue;
      const auto count = static_cast<double>(row.fluid_particles);
      least = std::min(least, count);
      most = std::max(most, count);
      step.points.emplace_back(count, row.step_ms);
      if (row.picture_ms > 0.0) with_picture.points.emplace_back(count, row.step_ms + row.picture_ms);
    }
    panel.series.push_back(step);
    if (!with_picture.points.empty()) panel.series.push_back(with_picture);
  }
  panel.series.push_back(level("70 Hz, enough for a fluid's forces, and 1 kHz, for a rigid body's", least,
                               most, 1e3 / report::kFluidRate));
  panel.series.push_back(level("", least, most, 1e3 / report::kRigidRate));
  ChartSeries paper = marked("the paper: 32 000 particles at 70 Hz, Quadro FX 3600M", 3, 9);
  paper.size = 1.8;
  paper.width = 0.0;
  paper.points = {{report::kPaperParticles, 1e3 / report::kFluidRate}};
  panel.series.push_back(paper);
  return panel;
}

/// Its colours are those of 6a, its title says how many particles.
ChartPanel by_bodies(const SpeedRows& rows, const std::vector<std::string>& devices, const char* figure,
                     const char* title, const char* x_label, double (*x)(const SpeedRow&)) {
  ChartPanel panel{title, x_label, "ms", false, devices.size() > 1, {}};  // a CPU and a GPU are far apart
  panel.legend = false;
  panel.y_from_zero = true;
  std::string totals;
  for (std::size_t d = 0; d < devices.size(); ++d) {
    ChartSeries curve = marked(devices[d], d, 5);
    std::string total;
    for (const SpeedRow& row : rows.speeds) {
      if (row.figure != figure || row.device != devices[d]) continue;
      total = grouped(row.fluid_particles + row.body_particles);
      curve.points.emplace_back(x(row), row.step_ms);
    }
    if (totals.find(total) == std::string::npos) totals += (totals.empty() ? "" : " or ") + total;
    panel.series.push_back(curve);
  }
  panel.title += ", " + totals + " particles in all";
  return panel;
}

/// Of Figure 6a by its particles, of 6c by its spheres.
ChartPanel shares_of(const SpeedRows& rows, const std::string& device, const std::string& figure) {
  constexpr double kWorthACurve = 0.01;
  const bool by_size = figure == "6a";
  ChartPanel panel{device + (by_size ? ": within a step, 6a" : ": within a step, 6c"),
                   by_size ? "fluid particles" : "spheres",
                   "share of a step, %",
                   by_size,
                   false,
                   {}};
  const bool on_gpu = std::any_of(rows.speeds.begin(), rows.speeds.end(), [&](const SpeedRow& row) {
    return row.device == device && row.backend == backend_name(Backend::kCuda);
  });
  std::vector<std::string> passes;  // of both, so that colours agree
  for (const ShareRow& row : rows.shares) {
    const bool known = std::find(passes.begin(), passes.end(), row.pass) != passes.end();
    if (row.device == device && row.share >= kWorthACurve && !known) passes.push_back(row.pass);
  }
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const bool waits = on_gpu && passes[i] == name(PassId::kReadWrenches);
    ChartSeries curve =
        marked(passes[i] + (waits ? " (waits)" : ""), i, 5 + 2 * static_cast<int>(i % 5), i >= 6);
    for (const ShareRow& row : rows.shares) {
      if (row.device != device || row.figure != figure || row.pass != passes[i]) continue;
      curve.points.emplace_back(by_size ? static_cast<double>(row.fluid_particles) : row.bodies,
                                100.0 * row.share);
    }
    panel.series.push_back(curve);
  }
  return panel;
}

ChartPanel roofline_of(const SpeedRows& rows, const std::string& device) {
  std::size_t size = 0;
  for (const RoofRow& row : rows.roofs) {
    if (row.device == device) size = std::max(size, row.fluid_particles);
  }
  ChartPanel panel{device + ": roofline, " + grouped(size) + " particles",
                   "FLOP a byte of memory",
                   "GFLOP/s",
                   true,
                   true,
                   {}};
  constexpr double kLowest = 0.5;  // FLOP a byte
  report::Ceilings ceilings;
  double ridge = 0.0;
  for (const RoofRow& row : rows.roofs) {
    if (row.device != device || row.fluid_particles != size) continue;
    ceilings = row.ceilings;
    ridge = ceilings.flops_per_s / ceilings.bytes_per_s;
    const std::string reached = format("%.0f %% of its roof", 100.0 * row.share_of_roof());
    if (row.flops <= 0.0) {  // no point: the line of the bandwidth that it reaches
      ChartSeries line = marked(row.pass + ", no FLOP: " + reached, panel.series.size(), 0, true);
      for (const double x : {kLowest, ridge}) line.points.emplace_back(x, 1e-9 * row.bytes_per_s() * x);
      panel.series.push_back(line);
      continue;
    }
    ChartSeries point = marked(row.pass + ": " + reached, panel.series.size(), 7);
    point.size = 1.6;
    point.width = 0.0;
    point.points = {{row.flops_per_byte(), 1e-9 * row.flops_per_s()}};
    panel.series.push_back(point);
  }
  if (panel.series.empty()) return panel;  // it says that there is no data
  ChartSeries roof;
  roof.name = format("ceilings, measured: %.3g GB/s, %.4g GFLOP/s", 1e-9 * ceilings.bytes_per_s,
                     1e-9 * ceilings.flops_per_s);
  roof.color = kLimitColor;
  roof.mark = 0;
  roof.width = 2.0;
  for (const double x : {kLowest, ridge, 10.0 * ridge})
    roof.points.emplace_back(x, 1e-9 * report::roof(ceilings, x));
  panel.series.push_back(roof);
  return panel;
}

std::string rates_of(const SpeedRows& rows) {
  std::string text;
  for (const SpeedRow& row : rows.speeds) {
    if (row.figure != "6b" || row.bodies != 0) continue;
    text += format("%s%.0f Hz on %s, %s particles", text.empty() ? "" : "; ", 1e3 / row.step_ms,
                   row.device.c_str(), grouped(row.fluid_particles).c_str());
  }
  return text.empty() ? "not measured" : text;
}

/// Whether each device keeps real time with Figure 6b's pool.
std::string keeps_time(const SpeedRows& rows) {
  bool measured = false;
  std::string text;
  for (const SpeedRow& row : rows.speeds) {
    if (row.figure != "6b" || row.bodies != 0) continue;
    measured = true;
    if (row.real_time_factor() < 1.0)
      text += format("%s× %.2f on %s", text.empty() ? "" : "; ", row.real_time_factor(), row.device.c_str());
  }
  return !measured ? "not measured" : text.empty() ? "✓" : text;
}

}  // namespace

std::vector<ChartPanel> figure_six(const SpeedRows& rows) {
  const std::vector<std::string> devices = devices_in(rows.speeds);
  std::vector<ChartPanel> panels = {by_particles(rows, devices)};
  panels.push_back(by_bodies(rows, devices, "6b", "6b: a growing sphere", "particles of the sphere",
                             [](const SpeedRow& row) { return static_cast<double>(row.body_particles); }));
  panels.push_back(by_bodies(rows, devices, "6c", "6c: as many on more spheres", "spheres",
                             [](const SpeedRow& row) { return static_cast<double>(row.bodies); }));
  return panels;
}

std::vector<ChartPanel> pass_panels(const SpeedRows& rows) {
  std::vector<ChartPanel> panels;
  for (const std::string& device : devices_in(rows.shares)) {
    panels.push_back(shares_of(rows, device, "6a"));
    panels.push_back(shares_of(rows, device, "6c"));
    panels.push_back(roofline_of(rows, device));
  }
  return panels;
}

std::string table_one(const SpeedRows& rows) {
  return "The paper's Table 1, with a row of this program. Rates of others are the paper's; [n] are its "
         "references.\n\n"
         "| method | physical model | DoF | computed in real time | performance | on a GPU | rigid bodies of "
         "any "
         "shape | viscosity can be chosen |\n"
         "|---|---|---|---|---|---|---|---|\n"
         "| [33] | Eulerian | 3 | ✓ | 30 Hz | | | |\n"
         "| [1] | – | 6 | | 500 Hz | | | |\n"
         "| [3] | Eulerian | 6 | ✓ | 40–70 Hz | | | |\n"
         "| [2] | Eulerian | 3 | ✓ | 30–75 Hz | ✓ | | |\n"
         "| the paper | Lagrangian | 6 | ✓ | 60–120 Hz | ✓ | ✓ | ✓ |\n"
         "| slosh | Lagrangian | 6 | " +
         keeps_time(rows) + " | " + rates_of(rows) +
         " | ✓, or a CPU | ✓ | ✓ |\n\n"
         "Ours: steps of Figure 6b's pool without its sphere; × n is simulated over wall time, where that is "
         "below 1.\n";
}

}  // namespace slosh
