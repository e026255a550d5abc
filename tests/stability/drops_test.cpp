// Single drops that fall into an empty tank: a wall must not give back more than it was given.
#include <gtest/gtest.h>

#include "tests/physics/lab.h"
#include "tests/support/tank.h"

namespace slosh {
namespace {

// 25 particles, apart from each other, fall 5 to 7 cm on the floor. Without bulk damping they never came to
// rest and rose to 21 cm (the contact lasts about three steps); the bound is the height that they were let go
// from.
TEST(Drops, bounce_lower_than_they_fell_and_settle_on_the_floor) {
  testing::TankOptions options;
  options.inner = {0.2, 0.4, 0.2};
  testing::Tank tank = testing::make_tank(options);
  SampledScene& s = tank.sampled;
  s.fluid_positions.clear();
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      s.fluid_positions.emplace_back(-0.07f + 0.035f * i + 0.0013f * j, 0.05f + 0.0007f * (5 * i + j),
                                     -0.07f + 0.035f * j);
    }
  }
  s.fluid_velocities.assign(s.fluid_positions.size(), glm::vec3(0.0f));
  s.fluid_index.assign(s.fluid_positions.size(), 0);
  World world(tank.scene, s, make_plan(tank.scene, s.spacing), WorldOptions{1, Backend::kCpu});
  constexpr double kFirstContact = 0.12;  // s, by which all have met the floor
  Snapshot snapshot;
  float highest = 0.0f;
  float highest_at_last = 0.0f;
  while (world.time() < 2.0) {
    world.step({});
    world.fill(snapshot);
    if (world.time() < kFirstContact) continue;
    for (const glm::vec3& p : snapshot.positions) {
      highest = std::max(highest, p.y);
      if (world.time() > 1.5) highest_at_last = std::max(highest_at_last, p.y);
    }
  }
  EXPECT_LT(highest, 0.067f);
  EXPECT_LT(highest_at_last, 0.02f);  // they slide on, there is no friction, but do not hop
  EXPECT_EQ(world.diagnostics().retired, 0u);
}

}  // namespace
}  // namespace slosh
