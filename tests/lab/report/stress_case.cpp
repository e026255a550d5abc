#include "tests/lab/report/stress_case.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "sim/backend.h"
#include "sim/math/format.h"
#include "tests/lab/report/csv.h"

namespace slosh::report {
namespace {

Verdict verdict_of(const Stress& found, std::uint32_t status, std::string& why) {
  const auto say = [&](const std::string& text) { why += (why.empty() ? "" : "; ") + text; };
  if (!found.finite) {
    say("not finite");
    return Verdict::kFailed;
  }
  const bool bounded = !(found.energy_ratio > kMaxEnergy);
  if (!bounded) say(format("%.3g times the energy there can be", found.energy_ratio));
  bool within = true;
  if (found.momentum_error > kMaxMomentumError) {
    say(format("momentum off by %.2g a step", found.momentum_error));
    within = false;
  }
  if (found.lost_share > found.most_lost) {
    say(format("%.2g %% lost", 100.0 * found.lost_share));
    within = false;
  }
  if (!found.broken.empty()) {
    say(found.broken);
    within = false;
  }
  const std::string limited = status_text(status);
  if (!limited.empty()) say(limited);
  if (!bounded) return Verdict::kFailed;
  if (!limited.empty()) return Verdict::kLimited;
  return within ? Verdict::kTrue : Verdict::kFailed;
}

}  // namespace

const std::vector<StressCase>& stress_cases() {
  static const std::vector<StressCase> all = [] {
    std::vector<StressCase> cases;
    for (auto& some : {fluid_stress(), body_stress(), joint_stress(), cut_stress(), setting_stress(),
                       hand_stress(), long_stress()})
      cases.insert(cases.end(), some.begin(), some.end());
    return cases;
  }();
  return all;
}

StressRow run_stress(const StressCase& which, const Setting& setting) {
  StressRow row;
  row.case_id = which.id;
  row.model = name(setting.model);
  row.backend = backend_name(setting.backend);
  try {
    row.found = which.run(setting, row.cost);
    row.verdict = verdict_of(row.found, row.cost.status, row.why);
  } catch (const Refused& refusal) {
    row.verdict = Verdict::kRefused;
    row.why = refusal.text;
  }
  return row;
}

std::string csv_line(const StressRow& r) {
  return csv_field(r.case_id) + ',' + csv_field(r.model) + ',' + csv_field(r.backend) + ',' +
         kVerdictNames[static_cast<std::size_t>(r.verdict)] +
         format(",%.5g,%.3g,%.5g,%.0f,%.0f,%.6g,%.6g,%.6g,%u,", r.found.energy_ratio, r.found.momentum_error,
                r.found.lost_share, static_cast<double>(r.cost.particles), static_cast<double>(r.cost.steps),
                r.cost.time_step, r.cost.simulated_s, r.cost.wall_s, r.cost.status) +
         csv_field(r.why);
}

std::vector<Setting> settings_of(const StressCase& which, const SweepOptions& options) {
  std::vector<Setting> settings = base_settings(options);
  // Without a fluid the world is the same for all models.
  if (!which.fluid)
    std::erase_if(settings, [](const Setting& s) { return s.model != ParticleModel::kCorrected; });
  for (Setting& each : settings) each.spacing = which.spacing;
  return settings;
}

Result<std::vector<StressRow>> read_stresses(const std::filesystem::path& file) {
  std::vector<StressRow> rows;
  const Result<bool> read = read_rows(file, kStressHeader, "stability", [&](const Fields& f) {
    StressRow r;
    r.case_id = f[0];
    r.model = f[1];
    if (!model_named(r.model)) return;
    r.backend = f[2];
    const auto verdict = std::find(kVerdictNames.begin(), kVerdictNames.end(), std::string_view(f[3]));
    if (verdict == kVerdictNames.end()) throw std::invalid_argument("verdict");
    r.verdict = static_cast<Verdict>(verdict - kVerdictNames.begin());
    r.found.energy_ratio = std::stod(f[4]);
    r.found.momentum_error = std::stod(f[5]);
    r.found.lost_share = std::stod(f[6]);
    r.cost.particles = std::stoull(f[7]);
    r.cost.steps = std::stoull(f[8]);
    r.cost.time_step = std::stod(f[9]);
    r.cost.simulated_s = std::stod(f[10]);
    r.cost.wall_s = std::stod(f[11]);
    r.cost.status = static_cast<std::uint32_t>(std::stoul(f[12]));
    r.why = f[13];
    rows.push_back(r);
  });
  if (!read) return read.error();
  return rows;
}

}  // namespace slosh::report
