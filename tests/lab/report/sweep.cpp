#include "tests/lab/report/sweep.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sim/backend.h"
#include "sim/math/format.h"
#include "tests/lab/report/close_spacings.h"
#include "tests/lab/report/csv.h"

namespace slosh::report {
namespace {

constexpr double kWideSupport = 2.5;
constexpr double kShortStep = 0.5;

bool wanted(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

ErrorRow row_of(const ErrorCase& which, const Setting& setting, const Cost& cost) {
  ErrorRow row;
  row.case_id = which.id;
  row.model = name(setting.model);
  row.backend = backend_name(setting.backend);
  row.threads = setting.threads;
  row.spacing = setting.spacing;
  row.support_ratio = setting.support_ratio;
  row.step_share = setting.step_share;
  row.particles = static_cast<double>(cost.particles);
  row.steps = static_cast<double>(cost.steps);
  row.time_step = cost.time_step;
  row.simulated_s = cost.simulated_s;
  row.wall_s = cost.wall_s;
  row.retired = static_cast<double>(cost.retired);
  row.status = cost.status;
  return row;
}

}  // namespace

std::vector<Setting> base_settings(const SweepOptions& options) {
  std::vector<Setting> settings;
  for (const Backend backend : options.backends) {
    for (const ParticleModel model :
         {ParticleModel::kPaper, ParticleModel::kCorrected, ParticleModel::kIncompressible}) {
      if (!wanted(options.models, name(model))) continue;
      Setting setting;
      setting.model = model;
      setting.backend = backend;
      setting.threads = options.threads;
      setting.stopped = options.stopped;
      settings.push_back(setting);
    }
  }
  return settings;
}

std::vector<Setting> settings_of(const ErrorCase& which, const SweepOptions& options) {
  std::vector<Setting> settings;
  for (const Setting& base : base_settings(options)) {
    std::vector<double> spacings = options.spacings;
    if (spacings.empty()) {
      spacings = which.spacings;
      if (options.quick) spacings.resize(which.quick);
    }
    for (const double middle : spacings) {
      for (const double spacing : close_spacings(middle, options.close)) {
        Setting setting = base;
        setting.spacing = spacing;
        settings.push_back(setting);
        if (options.quick) continue;
        setting.support_ratio = kWideSupport;
        settings.push_back(setting);
        setting.support_ratio = base.support_ratio;
        setting.step_share = kShortStep;
        settings.push_back(setting);
      }
    }
  }
  return settings;
}

std::vector<ErrorRow> run_case(const ErrorCase& which, const Setting& setting) {
  Cost cost;
  std::vector<Reading> readings;
  std::string refused;
  try {
    readings = which.run(setting, cost);
  } catch (const Refused& refusal) {
    refused = refusal.text;
  }
  const ErrorRow base = row_of(which, setting, cost);
  std::vector<ErrorRow> rows;
  for (const Reading& reading : readings) {
    ErrorRow row = base;
    row.quantity = reading.quantity;
    row.unit = reading.unit;
    row.plotted = reading.plotted;
    row.measured = reading.measured;
    row.expected = reading.expected;
    row.scale = reading.scale > 0.0 ? reading.scale : std::abs(reading.expected);
    rows.push_back(row);
  }
  if (!refused.empty()) {
    rows.push_back(base);
    rows.back().refused = refused;
  }
  return rows;
}

std::string csv_line(const ErrorRow& r) {
  const double error = r.refused.empty() ? r.error() : std::nan("");
  return csv_field(r.case_id) + ',' + csv_field(r.quantity) + ',' + csv_field(r.unit) + ',' +
         (r.plotted ? '1' : '0') + ',' + csv_field(r.model) + ',' + csv_field(r.backend) + ',' +
         format("%d,%.6g,%.4g,%.4g,%.0f,%.0f,%.6g,%.6g,%.6g,%.12g,%.12g,%.12g,%.5g,%.0f,%u,", r.threads,
                r.spacing, r.support_ratio, r.step_share, r.particles, r.steps, r.time_step, r.simulated_s,
                r.wall_s, r.measured, r.expected, r.scale, error, r.retired, r.status) +
         csv_field(r.refused);
}

Result<std::vector<ErrorRow>> read_errors(const std::filesystem::path& file) {
  std::vector<ErrorRow> rows;
  const Result<bool> read = read_rows(file, kErrorHeader, "error", [&](const Fields& f) {
    ErrorRow r;
    r.case_id = f[0];
    r.quantity = f[1];
    r.unit = f[2];
    r.plotted = f[3] == "1";
    r.model = f[4];
    if (!model_named(r.model)) return;
    r.backend = f[5];
    r.threads = std::stoi(f[6]);
    double* const numbers[] = {&r.spacing,  &r.support_ratio, &r.step_share,  &r.particles,
                               &r.steps,    &r.time_step,     &r.simulated_s, &r.wall_s,
                               &r.measured, &r.expected,      &r.scale};
    for (std::size_t i = 0; i < std::size(numbers); ++i) *numbers[i] = std::stod(f[7 + i]);
    r.retired = std::stod(f[19]);
    r.status = static_cast<std::uint32_t>(std::stoul(f[20]));
    r.refused = f[21];
    rows.push_back(r);
  });
  if (!read) return read.error();
  return rows;
}

}  // namespace slosh::report
