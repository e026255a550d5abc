// Stiff and extreme cases: what must hold where no answer is known.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/lab/report/sweep.h"
#include "tests/lab/report/trial.h"

namespace slosh::report {

enum class Verdict : std::uint8_t {
  kTrue,     ///< within its bounds, and nothing had to be limited
  kLimited,  ///< finite and bounded, and a status bit said that something was not as it should be
  kRefused,  ///< clear words before anything ran
  kFailed,   ///< not finite, unbounded, or beyond its bounds without a word
};
inline constexpr std::array kVerdictNames{"ran true", "ran limited", "refused", "failed"};

/// What a case found.
struct Stress {
  bool finite = true;
  double energy_ratio =
      0.0;  ///< largest kinetic energy over the case's own measure of what there can be; 0: not read
  double momentum_error = 0.0;  ///< worst step's |ΔP − F·dt| of the fluid over M·g·dt; 0: not read
  double lost_share =
      0.0;  ///< of the fluid: retired, or found where it cannot have come without passing a wall
  double most_lost = 0.0;  ///< that is within bounds
  std::string broken;      ///< a bound of the case's own that does not hold, in words
};

struct StressCase {
  const char* id;
  const char* title;
  double spacing;                                     ///< m
  bool quick;                                         ///< a quick report has it
  bool fluid;                                         ///< there is one: particle models differ
  Stress (*run)(const Setting& setting, Cost& cost);  ///< throws Refused, Stopped
};

/// Every one, in the order of the report.
const std::vector<StressCase>& stress_cases();

/// The settings of one case: every backend with each model, or with one where there is no fluid.
std::vector<Setting> settings_of(const StressCase& which, const SweepOptions& options);

struct StressRow {
  std::string case_id, model, backend;
  Verdict verdict = Verdict::kTrue;
  std::string why;  ///< what was broken, limited or refused
  Stress found;
  Cost cost;
};
/// Runs one. Throws Stopped.
StressRow run_stress(const StressCase& which, const Setting& setting);

constexpr const char* kStressHeader =
    "case,model,backend,verdict,energy_ratio,momentum_error,lost_share,particles,steps,time_step_s,"
    "simulated_s,wall_s,status,why";
std::string csv_line(const StressRow& row);
/// Rows of models that are no more are passed over. Errors: it cannot be read, another header, a row that is
/// none.
Result<std::vector<StressRow>> read_stresses(const std::filesystem::path& file);

/// The bounds that every case has.
inline constexpr double kMaxEnergy = 1.05;         ///< of Stress::energy_ratio
inline constexpr double kMaxMomentumError = 1e-5;  ///< of Stress::momentum_error

// Each file of stress/ gives its own.
std::vector<StressCase> fluid_stress();    ///< materials, gravity, sizes, starts
std::vector<StressCase> body_stress();     ///< bodies of all weights, contacts
std::vector<StressCase> joint_stress();    ///< linkages
std::vector<StressCase> cut_stress();      ///< bodies that are cut
std::vector<StressCase> setting_stress();  ///< heat and what sets
std::vector<StressCase> hand_stress();     ///< stiff, fast and many hands; closed vessels
std::vector<StressCase> long_stress();     ///< soaks: a full report's only

}  // namespace slosh::report
