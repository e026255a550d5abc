// Heat and what sets: sudden cold, sudden melting, and solids that are stiff, dropped and torn.
#include <algorithm>
#include <cmath>

#include "sim/math/format.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/stress/scenes.h"
#include "tests/lab/report/watch.h"

namespace slosh::report {
namespace {

constexpr double kTub = 0.16, kTubDeep = 0.08;  // m

// A tub of fluid that is `celsius` warm in walls of `walls`.
SceneBuilder tub(double celsius, double walls) {
  SceneBuilder b;
  Fluid& fluid = b.scene.fluids[static_cast<std::size_t>(b.add_fluid(1000.0, 0.5))];
  fluid.heat.temperature = celsius;
  fluid.heat.capacity = 1000.0;
  fluid.heat.conductivity = 1e4;
  const int tank = b.add_fixed("tank", tank_at_floor({kTub, 0.2, kTub}, 0.03));
  b.scene.bodies[static_cast<std::size_t>(tank)].temperature = walls;
  b.set_viscosity({tank}, kFluidsViscosity);
  b.add_volume(make::box({-0.5 * kTub, 0.0, -0.5 * kTub}, {0.5 * kTub, kTubDeep, 0.5 * kTub}));
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 0.6, 0.4});
  return b;
}

void check_heat(const Diagnostics& start, const Diagnostics& now, double coldest, double hottest,
                Stress& found) {
  const double gained = now.heat - start.heat, most = std::max(std::abs(gained), 1e-3 * std::abs(start.heat));
  if (now.retired == 0 && !(std::abs(gained - now.heat_from_bodies) < 1e-4 * most))
    found.broken = format("%.2g J came from nowhere", gained - now.heat_from_bodies);
  if (!(now.coldest > coldest - 1e-3 && now.hottest < hottest + 1e-3))
    found.broken = format("it is %.4g to %.4g °C", now.coldest, now.hottest);
}

// The best conductor that a scene may have, two thousand degrees apart.
Stress quenched(const Setting& setting, Cost& cost) {
  const SceneBuilder b = tub(2000.0, 0.0);
  Trial t(b.scene, setting, cost);
  Watch watch(t, b.scene);
  const Diagnostics start = t.world().diagnostics();
  watch.run(1.0);
  Stress found = watch.found();
  check_heat(start, t.world().diagnostics(), 0.0, 2000.0, found);
  return found;
}

// Walls that set it within a hundredth of a second to a hundred thousand times its viscosity.
Stress frozen(const Setting& setting, Cost& cost) {
  SceneBuilder b = tub(20.0, -50.0);
  Heat& heat = b.scene.fluids[0].heat;
  heat.sets_below = 0.0;
  heat.sets_in = 0.01;
  heat.set_times = 1e5;
  heat.modulus = 1e6;
  Trial t(b.scene, setting, cost);
  Watch watch(t, b.scene);
  const Diagnostics start = t.world().diagnostics();
  watch.run(0.5);
  Stress found = watch.found();
  check_heat(start, t.world().diagnostics(), -50.0, 20.0, found);
  if (!(t.world().diagnostics().cure > 0.2)) found.broken = "it did not set";
  return found;
}

// A block of `modulus` Pa that falls 0.2 m onto a floor, and tears at `tears_at`.
Stress dropped(double modulus, double tears_at, const Setting& setting, Cost& cost) {
  SceneBuilder b;
  Fluid& fluid = b.scene.fluids[static_cast<std::size_t>(b.add_fluid(1000.0, 0.5))];
  fluid.heat.starts_set = true;
  fluid.heat.melts_above = 100.0;
  fluid.heat.melts_in = 1.0;
  fluid.heat.set_times = 40.0;
  fluid.heat.modulus = modulus;
  fluid.heat.tears_at = tears_at;
  const int floor = b.add_fixed("floor", make::box({-0.3, -0.05, -0.3}, {0.3, 0.0, 0.3}));
  b.set_viscosity({floor}, kFluidsViscosity);
  b.add_volume(make::box({-0.05, 0.2, -0.05}, {0.05, 0.26, 0.05}));
  b.set_domain({-0.5, -0.3, -0.5}, {0.5, 0.6, 0.5});
  Trial t(b.scene, setting, cost);
  Watch watch(t, b.scene);
  watch.run(1.0);
  return watch.found();
}
Stress stiff_block(const Setting& setting, Cost& cost) {
  return dropped(2e5, 0.5, setting, cost);
}
Stress brittle_block(const Setting& setting, Cost& cost) {
  return dropped(1e5, 0.01, setting, cost);
}

}  // namespace

std::vector<StressCase> setting_stress() {
  return {
      {"quenched", "The best conductor, two thousand degrees apart", 0.01, true, true, quenched},
      {"frozen", "Walls that freeze within 10 ms to 10⁵ times the viscosity", 0.01, true, true, frozen},
      {"stiff_block", "A set block of 2·10⁵ Pa falls onto a floor", 0.01, true, true, stiff_block},
      {"brittle_block", "A set block that tears at 1 % falls onto a floor", 0.01, true, true, brittle_block},
  };
}

}  // namespace slosh::report
