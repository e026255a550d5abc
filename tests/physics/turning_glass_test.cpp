// Fluid in a glass that turns: as one with it, no faster.
#include <gtest/gtest.h>

#include <cmath>

#include "host/report/surface.h"
#include "tests/physics/lab.h"

namespace slosh::lab {
namespace {

// 0.5 Pa·s at 16 rad/s, of which jostling would need 0.9 at 10 mm. While a particle was dragged on by what it
// differs from its neighbours' mean by, which at walls and surfaces is the flow itself, fluid within three
// quarters of the radius turned by 4.2 % faster than the glass (viscosity/neighbour_flow.h).
TEST(TurningGlass, is_not_overtaken_by_its_fluid) {
  constexpr double kRadius = 0.06, kDepth = 0.08, kTurning = 16.0, kSpacing = 0.01;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.5);
  const int glass = b.add_free("glass", report::glass_of(kRadius, kDepth + 0.06, 0.02), 0.5);
  b.set_viscosity({glass}, 0.5);
  b.scene.bodies[static_cast<std::size_t>(glass)].twist.angular = {0.0, kTurning, 0.0};
  b.add_volume(report::filling_of(kRadius, kDepth));
  b.add_stiff_grip(glass);
  b.set_domain({-0.2, -0.1, -0.2}, {0.2, 0.3, 0.2});
  report::Setting setting;
  setting.spacing = kSpacing;
  setting.threads = 1;
  SampledScene start = report::sampled_for(b.scene, setting);
  for (std::size_t i = 0; i < start.fluid_positions.size(); ++i) {
    start.fluid_velocities[i] =
        glm::cross(glm::vec3(0.0f, static_cast<float>(kTurning), 0.0f), start.fluid_positions[i]);
  }
  Experiment e(b.scene, start);
  e.handle(0).engaged = true;
  e.handle(0).twist.angular.y = kTurning;
  const auto turn = [&] {
    e.handle(0).pose.orientation = glm::angleAxis(kTurning * e.world().time(), report::kUp);
  };
  e.run(1.8, turn);
  Snapshot before = e.picture();
  double last = e.world().time();
  Average turning;
  int steps = 0;
  e.run(0.2, [&] {
    turn();
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
