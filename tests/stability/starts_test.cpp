// Odd starts: few particles, particles on top of each other, far away, not numbers, inside a wall.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/lab/report/surface.h"
#include "tests/physics/lab.h"
#include "tests/support/tank.h"

namespace slosh::lab {
namespace {

testing::Tank tank_with(std::vector<glm::vec3> positions) {
  testing::Tank tank = testing::make_tank({});
  tank.sampled.fluid_positions = std::move(positions);
  tank.sampled.fluid_velocities.assign(tank.sampled.fluid_positions.size(), glm::vec3(0.0f));
  tank.sampled.fluid_index.assign(tank.sampled.fluid_positions.size(), 0);
  return tank;
}

testing::Tank full_tank() {
  return testing::make_tank({});
}

class Few : public ::testing::TestWithParam<int> {};

// They fall on the floor and stay over it. A particle without neighbours meets the floor within two or three
// steps, and so bounces as if the floor were springs: no bound on how it comes up again but that it stays in
// the tank.
TEST_P(Few, particles_stay_in_the_tank) {
  std::vector<glm::vec3> positions;
  for (int i = 0; i < GetParam(); ++i)
    positions.emplace_back(-0.05f + 0.01f * static_cast<float>(i), 0.05f, 0.0f);
  const testing::Tank tank = tank_with(positions);
  Experiment e(tank.scene, tank.sampled);
  e.run(3.0);
  ASSERT_TRUE(all_finite(e.world()));
  const Diagnostics fluid = e.world().diagnostics();
  EXPECT_EQ(fluid.particles, static_cast<std::uint64_t>(GetParam()));
  EXPECT_EQ(e.world().take_status(), 0u);
  double highest = 0.0;
  e.run(1.0, [&] {
    for (const glm::vec3& p : e.picture().positions) {
      highest = std::max<double>(highest, p.y);
      EXPECT_GT(
          p.y,
          -0.01f);  // between surface and boundary layer: a lone particle has little pressure to stand on
    }
  });
  report_value(std::to_string(GetParam()) + " particles dropped from 50 mm, highest after 3 s", 1e3 * highest,
               "mm");
  EXPECT_LT(highest, 0.3);
}

INSTANTIATE_TEST_SUITE_P(counts, Few, ::testing::Values(0, 1, 2, 10));

// Every particle doubled: 8 times the pressure at once. It bursts, but within bounds, and then settles.
TEST(Start, coincident_particles) {
  testing::Tank tank = full_tank();
  const std::vector<glm::vec3> half(
      tank.sampled.fluid_positions.begin(),
      tank.sampled.fluid_positions.begin() + static_cast<long>(tank.sampled.fluid_positions.size() / 2));
  std::vector<glm::vec3> doubled = half;
  doubled.insert(doubled.end(), half.begin(), half.end());
  tank = tank_with(doubled);
  Experiment e(tank.scene, tank.sampled);
  const std::size_t count = e.world().fluid_count();
  e.run(2.0);
  ASSERT_TRUE(all_finite(e.world()));
  const Diagnostics fluid = e.world().diagnostics();
  EXPECT_EQ(fluid.particles + fluid.retired, count);
  const double thrown = static_cast<double>(fluid.retired) / static_cast<double>(count);
  report_value("coincident start, share thrown out of the domain", thrown, "");
  EXPECT_LT(thrown, 0.6);
  EXPECT_LT(fluid.kinetic_energy, 0.2 * fluid.mass * kGravity * 0.1);
}

// Two particles in one place and nothing else: they add nothing to each other's force and stay finite.
TEST(Start, two_particles_in_one_place) {
  const testing::Tank tank = tank_with({{0.0f, 0.05f, 0.0f}, {0.0f, 0.05f, 0.0f}});
  Experiment e(tank.scene, tank.sampled);
  e.run(1.0);
  EXPECT_TRUE(all_finite(e.world()));
  EXPECT_EQ(e.world().diagnostics().particles, 2u);
}

// 10⁶ m away: retired with the bit for it; the rest does not notice (same weight, same step).
TEST(Start, one_particle_far_away_is_retired) {
  testing::Tank tank = full_tank();
  tank.sampled.fluid_positions[7] = {1e6f, 0.0f, 0.0f};
  Experiment e(tank.scene, tank.sampled);
  e.world().settle(0.3);
  e.run(0.3);
  EXPECT_TRUE(all_finite(e.world()));
  EXPECT_EQ(e.world().diagnostics().retired, 1u);
  EXPECT_EQ(e.world().take_status(), static_cast<std::uint32_t>(kStatusEscaped));
}

TEST(Start, not_a_number_is_retired_and_the_rest_lives) {
  testing::Tank tank = full_tank();
  tank.sampled.fluid_positions[11].y = std::numeric_limits<float>::quiet_NaN();
  tank.sampled.fluid_velocities[13].x = std::numeric_limits<float>::infinity();
  Experiment e(tank.scene, tank.sampled);
  Average down;
  e.run(1.0);
  e.run(0.5, [&] { down.add(-e.bodies().bodies[0].fluid.force.y); });
  EXPECT_TRUE(all_finite(e.world()));
  const Diagnostics fluid = e.world().diagnostics();
  EXPECT_EQ(fluid.retired, 2u);
  EXPECT_NE(e.world().take_status() & kStatusNonFinite, 0u);
  EXPECT_NEAR(down.mean(), fluid.mass * kGravity, 0.02 * fluid.mass * kGravity);
}

// Fluid that starts two spacings inside the floor and a wall, built past the sampler, which refuses it: what
// lies behind the boundary layer is outside and falls; the rest must neither explode nor follow.
TEST(Start, overlapping_a_wall) {
  testing::TankOptions options;
  testing::Tank tank = testing::make_tank(options);
  for (glm::vec3& p : tank.sampled.fluid_positions) p += glm::vec3(0.015f, -0.015f, 0.0f);
  Experiment e(tank.scene, tank.sampled);
  const std::size_t count = e.world().fluid_count();
  // Up to the boundary layer, 0.7 spacings behind their surface.
  const report::Room room{{-0.107, -0.007, -0.107}, {0.107, 0.15, 0.107}, true};
  const std::size_t outside_at_start = report::count_outside(e.picture(), Pose{}, room);
  e.run(1.5);
  ASSERT_TRUE(all_finite(e.world()));
  const Diagnostics fluid = e.world().diagnostics();
  EXPECT_EQ(fluid.particles + fluid.retired, count);
  EXPECT_LT(fluid.max_speed, 5.0);
  // What was inside then against what is inside now, by the same box.
  const std::size_t outside = report::count_outside(e.picture(), Pose{}, room);
  const double kept = static_cast<double>(count - outside) / static_cast<double>(count - outside_at_start);
  report_value("start in a wall, share of what began inside that is there", kept, "");
  EXPECT_GT(outside_at_start, count / 20) << "some of it does start behind the boundary layer";
  EXPECT_GT(kept, 0.97);
  EXPECT_LT(kept, 1.05);
}

}  // namespace
}  // namespace slosh::lab
