// What only time shows: drift, float positions, particles lost one by one. A full report's alone.
#include <cmath>

#include "sim/math/format.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/watch.h"

namespace slosh::report {
namespace {

// A tank of a thousand particles at rest for a million steps (about half an hour of simulated time).
Stress million_steps(const Setting& setting, Cost& cost) {
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("tank", tank_at_floor({0.1, 0.16, 0.1}, 0.04));
  b.add_volume(make::box({-0.05, 0.0, -0.05}, {0.05, 0.1, 0.05}));
  b.set_domain(glm::dvec3(-0.3), glm::dvec3(0.3));
  Trial t(b.scene, setting, cost);
  t.settle(0.5);
  const Diagnostics start = t.world().diagnostics();
  Watch watch(t, b.scene);
  watch.run_far(1e6 * t.world().plan().time_step);
  const double sunk = start.center.y - t.world().diagnostics().center.y;
  Stress found = watch.found();
  if (!(std::abs(sunk) < 0.1 * setting.spacing))
    found.broken = format("the fluid sank by %.2g mm", 1e3 * sunk);
  return found;
}

// A stirrer goes round in a glass for ten minutes.
Stress stir(const Setting& setting, Cost& cost) {
  constexpr double kRadius = 0.05, kRound = 0.025, kTurns = 1.0;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.001);
  b.add_fixed("glass", make::lathe({{0.0, -0.03},
                                    {kRadius + 0.03, -0.03},
                                    {kRadius + 0.03, 0.14},
                                    {kRadius, 0.14},
                                    {kRadius, 0.0},
                                    {0.0, 0.0}},
                                   64));
  const int rod =
      b.add_free("rod", make::capsule(0.012, 0.0, 0.12, 8, 24), 0.1, {{kRound, 0.03, 0.0}, {1, 0, 0, 0}});
  b.add_volume(make::lathe({{0.0, 0.0}, {kRadius, 0.0}, {kRadius, 0.07}, {0.0, 0.07}}, 64));
  b.add_grip(rod, 5e3, 50.0, 50.0, 1.0, {{0.0, 0.12, 0.0}, {1, 0, 0, 0}});
  b.set_domain(glm::dvec3(-0.4), glm::dvec3(0.4));
  Trial t(b.scene, setting, cost);
  t.handle(0).engaged = true;
  t.settle(0.5, true);
  const double height = t.handle(0).pose.position.y;
  Watch watch(t, b.scene);
  watch.run_far(600.0, [&] {
    const double rate = 2.0 * kPi * kTurns, angle = rate * t.world().time();
    t.handle(0).pose.position = {kRound * std::cos(angle), height, kRound * std::sin(angle)};
    t.handle(0).twist.linear = kRound * rate * glm::dvec3(-std::sin(angle), 0.0, std::cos(angle));
  });
  return watch.found(0.003);
}

}  // namespace

std::vector<StressCase> long_stress() {
  return {
      {"million_steps", "A tank at rest for a million steps", 0.01, false, true, million_steps},
      {"stir_10min", "A rod stirs water for ten minutes", 0.01, false, true, stir},
  };
}

}  // namespace slosh::report
