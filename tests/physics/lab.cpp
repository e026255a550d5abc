#include "tests/physics/lab.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "scenes/make/solid.h"

namespace slosh::lab {

SceneBuilder full_tank(ParticleModel model, double density, double viscosity) {
  constexpr double kTank = 0.16;
  SceneBuilder b;
  b.scene.model = model;
  b.add_fluid(density, viscosity);
  b.add_fixed("tank", tank_at_floor({kTank, kTank + 0.08, kTank}, 0.04));
  b.add_volume(make::box({-0.5 * kTank, 0.0, -0.5 * kTank}, {0.5 * kTank, kTank, 0.5 * kTank}));
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 0.6, 0.4});
  return b;
}

double report(const std::string& name, double measured, double predicted, const char* unit) {
  const double error = (measured - predicted) / predicted;
  char text[200];
  std::snprintf(text, sizeof text, "measured %.5g %s, predicted %.5g %s, error %+.2f %%", measured, unit,
                predicted, unit, 100.0 * error);
  std::printf("  %s: %s\n", name.c_str(), text);
  ::testing::Test::RecordProperty(name, text);
  return error;
}

void report_value(const std::string& name, double value, const char* unit) {
  char text[100];
  std::snprintf(text, sizeof text, "%.4g %s", value, unit);
  std::printf("  %s: %s\n", name.c_str(), text);
  ::testing::Test::RecordProperty(name, text);
}

}  // namespace slosh::lab
