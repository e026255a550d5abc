// Which settings a case is run at, and what came of each.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/lab/report/error_case.h"

namespace slosh::report {

struct SweepOptions {
  bool quick = false;               ///< each case's coarsest spacings, no variants
  std::vector<std::string> cases;   ///< ids; empty: all
  std::vector<std::string> models;  ///< names; empty: all
  std::vector<double> spacings;     ///< m, in place of each case's own; empty: those
  int close = 1;                    ///< runs at each spacing, close by (close_spacings.h); odd
  std::vector<Backend> backends{Backend::kCpu};
  int threads = 0;
  bool (*stopped)() = nullptr;  ///< Setting::stopped
};

/// Those that `ids` names, in their own order; all where it names none. Errors: there is no such case.
template <class Case>
Result<std::vector<const Case*>> chosen(const std::vector<Case>& all, const std::vector<std::string>& ids) {
  std::string known;
  std::vector<const Case*> some;
  for (const Case& each : all) {
    known += (known.empty() ? "" : ", ") + std::string(each.id);
    if (ids.empty() || std::count(ids.begin(), ids.end(), each.id) > 0) some.push_back(&each);
  }
  for (const std::string& id : ids) {
    if (std::none_of(all.begin(), all.end(), [&](const Case& each) { return id == each.id; }))
      return Error{"--case", "there is no case '" + id + "'", "Cases: " + known};
  }
  return some;
}

/// One reading at one setting, or why there is none: a row of errors.csv.
struct ErrorRow {
  std::string case_id, quantity, unit, model, backend;
  bool plotted = false;
  int threads = 0;
  double spacing = 0.0, support_ratio = 0.0, step_share = 0.0;
  double particles = 0.0, steps = 0.0, time_step = 0.0, simulated_s = 0.0, wall_s = 0.0;
  double measured = 0.0, expected = 0.0, scale = 0.0;
  double retired = 0.0;
  std::uint32_t status = 0;
  std::string refused;   ///< empty when it ran
  int readings = 1;      ///< more: this is their mean (close_spacings.h)
  double scatter = 0.0;  ///< root mean square of what their errors differ by from the mean

  double error() const { return (measured - expected) / scale; }
  double wall_per_simulated() const { return simulated_s > 0.0 ? wall_s / simulated_s : 0.0; }
  /// The setting that a scene has unless its author says otherwise, but for the spacing.
  bool is_default() const { return model == name(ParticleModel::kCorrected) && is_base(); }
  bool is_paper() const { return model == name(ParticleModel::kPaper) && is_base(); }
  bool is_base() const { return support_ratio == 2.0 && step_share == 1.0; }
};

/// Every backend with each model.
std::vector<Setting> base_settings(const SweepOptions& options);

/// The settings of one case: every spacing, and those close by, with each model; in a full report also at a
/// support ratio of 2.5 and at half the time step.
std::vector<Setting> settings_of(const ErrorCase& which, const SweepOptions& options);

/// Runs one case at one setting; a refusal is a row of its own. Throws Stopped.
std::vector<ErrorRow> run_case(const ErrorCase& which, const Setting& setting);

constexpr const char* kErrorHeader =
    "case,quantity,unit,plotted,model,backend,threads,spacing_m,support_ratio,step_share,particles,steps,"
    "time_step_s,simulated_s,wall_s,measured,expected,scale,error,lost,status,refused";
std::string csv_line(const ErrorRow& row);
/// Rows of models that are no more are passed over. Errors: it cannot be read, another header, a row that is
/// none.
Result<std::vector<ErrorRow>> read_errors(const std::filesystem::path& file);

}  // namespace slosh::report
