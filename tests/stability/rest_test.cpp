// A long rest: nothing drifts, nothing warms up, nothing leaves.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/lab.h"
#include "tests/support/tank.h"

namespace slosh::lab {
namespace {

TEST(Rest, twenty_thousand_steps) {
  testing::TankOptions options;
  options.inner = {0.08, 0.1, 0.08};
  options.fill = 0.05;
  const testing::Tank tank = testing::make_tank(options);
  Experiment e(tank.scene, tank.sampled);
  e.world().settle(0.5);
  double early = 0.0, late = 0.0;
  glm::dvec3 center(0.0);
  for (int i = 0; i < 20000; ++i) {
    e.step();
    if (i % 10) continue;
    const Diagnostics d = e.world().diagnostics();
    if (i < 2000) early += d.kinetic_energy;
    if (i == 2000) center = d.center;
    if (i >= 18000) late += d.kinetic_energy;
  }
  const Diagnostics fluid = e.world().diagnostics();
  report_value("kinetic energy at rest, first tenth", early / 200.0, "J");
  report_value("kinetic energy at rest, last tenth", late / 200.0, "J");
  report_value("way of the centre of mass in 18000 steps", 1e3 * glm::distance(fluid.center, center), "mm");
  EXPECT_LT(late, early);
  EXPECT_LT(glm::distance(fluid.center, center), 0.05 * options.spacing);
  EXPECT_EQ(fluid.retired, 0u);
  EXPECT_EQ(e.world().take_status(), 0u);
}

// Held by hands, where body and fluid could drive each other.
TEST(Rest, held_cup_stays_where_it_is_held) {
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  const int cup = b.add_free("cup", tank_at_floor({0.08, 0.09, 0.08}, 0.012), 0.2);
  b.add_volume(make::box({-0.04, 0.0, -0.04}, {0.04, 0.05, 0.04}));
  b.add_grip(cup, 2000.0, 40.0, 20.0, 0.5);
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 0.8, 0.4});
  Experiment e(b.scene, 0.01);
  e.handle(0).engaged = true;
  e.world().settle(0.5);
  e.run(2.0);
  const Pose pose = e.bodies().bodies[cup].pose;
  double fastest = 0.0;
  e.run(8.0, [&] { fastest = std::max(fastest, glm::length(e.bodies().bodies[cup].twist.linear)); });
  report_value("held cup at rest, largest speed", 1e3 * fastest, "mm/s");
  EXPECT_LT(fastest, 2e-3);
  EXPECT_LT(glm::distance(pose.position, e.bodies().bodies[cup].pose.position), 1e-4);
  EXPECT_EQ(e.world().diagnostics().retired, 0u);
}

}  // namespace
}  // namespace slosh::lab
