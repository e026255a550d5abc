// Fluid in a glass that turns: as one with it, no faster.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/lab/report/surface.h"
#include "tests/physics/lab.h"

namespace slosh::lab {
namespace {

// 0.5 Pa·s at 16 rad/s; the artificial viscosity is 0.9 at 10 mm. While it damped the difference to the
// neighbours' mean, which at walls and surfaces is the flow itself, fluid within three quarters of the radius
// turned by 4.2 % faster than the glass (viscosity/neighbour_flow.h).
TEST(TurningGlass, is_not_overtaken_by_its_fluid) {
  constexpr double kRadius = report::TurningGlass::kRadius, kTurning = report::TurningGlass::kTurning;
  report::Setting setting;
  setting.spacing = 0.01;
  setting.threads = 1;
  report::Cost cost;
  report::TurningGlass glass(setting, cost);
  report::Trial& e = glass.trial();
  e.run(1.8, [&] { glass.turn(); });
  Snapshot before = e.picture();
  double last = e.world().time();
  Average turning;
  int steps = 0;
  e.run(0.2, [&] {
    glass.turn();
    if (++steps % 10) return;
    Snapshot now = e.picture();
    const double passed = e.world().time() - last;
    last = e.world().time();
    turning.add(
        report::share_of_shape(before, now, [&](std::size_t, const glm::vec3& from, const glm::vec3& to) {
          const double r = std::hypot(from.x, from.z);
          if (r > 0.75 * kRadius) return report::Along{};
          const double angle = std::atan2(from.z * to.x - from.x * to.z, from.x * to.x + from.z * to.z);
          return report::Along{{angle / passed * r, 0.0}, {kTurning * r, 0.0}};
        }));
    before = std::move(now);
  });
  report("0.5 Pa·s in a glass that turns, its turning over the glass's", turning.mean(), 1.0, "");
  EXPECT_NEAR(turning.mean(), 1.0, 0.008);
}

}  // namespace
}  // namespace slosh::lab
