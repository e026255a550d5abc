// What the experiments share: a trial on one thread, and reporting a measurement against its closed form.
#pragma once

#include <string>

#include "tests/lab/report/error_case.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/still_fluid.h"
#include "tests/lab/report/trial.h"

namespace slosh::lab {

using report::all_finite;
using report::Average;
using report::full_tank;
using report::kGravity;
using report::kPi;
using report::SceneBuilder;
using report::tank_at_floor;
using report::volume_of;

/// A scene that runs as it says itself, on one thread, so that experiments can run beside each other.
class Experiment : private report::Cost, public report::Trial {
 public:
  /// Samples the scene; an error of the sampler fails the test with its text.
  Experiment(const Scene& scene, double spacing) : Trial(scene, setting_of(scene, spacing), cost()) {}
  Experiment(const Scene& scene, const SampledScene& sampled)
      : Trial(scene, sampled, setting_of(scene, sampled.spacing), cost()) {}
  /// The same with drag explicit whatever the plan would find worth it.
  struct Explicit {};
  Experiment(const Scene& scene, double spacing, Explicit)
      : Trial(scene, explicit_setting_of(scene, spacing), cost()) {}

 private:
  report::Cost& cost() { return *this; }
  static report::Setting setting_of(const Scene& scene, double spacing) {
    report::Setting setting;
    setting.model = scene.model;
    setting.spacing = spacing;
    setting.support_ratio = scene.support_ratio;
    setting.threads = 1;
    return setting;
  }
  static report::Setting explicit_setting_of(const Scene& scene, double spacing) {
    report::Setting setting = setting_of(scene, spacing);
    setting.solve_viscosity = false;
    return setting;
  }
};

/// Prints "name: measured x, predicted y, error z %" and records it; returns (measured −
/// predicted)/predicted.
double report(const std::string& name, double measured, double predicted, const char* unit);
/// Prints and records a number that has no prediction.
void report_value(const std::string& name, double value, const char* unit);

}  // namespace slosh::lab
