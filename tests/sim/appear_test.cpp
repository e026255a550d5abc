// What comes and goes while a world runs: bodies, and fillings of fluid volumes.
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/world.h"
#include "tests/support/contains.h"
#include "tests/support/stirred_tank.h"

namespace slosh {
namespace {

using testing::Tank;

constexpr std::size_t kPaddleBody = 1;

void go_on(World& world, double seconds) {
  const double end = world.time() + seconds;
  while (world.time() < end) world.step({});
}

BodyState state_of_paddle(const World& world) {
  BodySnapshot now;
  world.fill(now);
  return now.bodies[kPaddleBody];
}

Snapshot seen_now(const World& world) {
  Snapshot now;
  world.fill(now);
  return now;
}

Tank with_paddle_away() {
  Tank tank = testing::stirred_tank();
  tank.scene.bodies[kPaddleBody].starts_away = true;
  return tank;
}

/// A tank with 16 cm of room, of which the lowest 4 are water; over it, to be filled, a block of so many
/// particles along each axis, with room for so many fillings.
Tank with_filling(int cells, int fillings, bool starts_away) {
  Tank tank = testing::make_tank({.inner = {0.1, 0.2, 0.1}, .fill = 0.04});
  const std::size_t before = tank.sampled.fluid_positions.size();
  const double half = 0.005 * cells;
  testing::add_fluid_block(tank.scene, tank.sampled, 0, {-half, 0.08, -half},
                           {half, 0.08 + 0.01 * cells, half});
  FluidVolume& volume = tank.scene.fluid_volumes.back();
  volume.name = "more";
  volume.starts_away = starts_away;
  volume.fillings = fillings;
  const auto count = static_cast<std::uint32_t>(tank.sampled.fluid_positions.size() - before);
  const auto first = static_cast<std::uint32_t>(before);
  tank.sampled.fillings = {{0, first, 0, 0},
                           {first, count, first + count, count * static_cast<std::uint32_t>(fillings - 1)}};
  for (int more = 1; more < fillings; ++more) {
    for (std::uint32_t i = 0; i < count; ++i) {
      tank.sampled.fluid_positions.push_back(tank.sampled.fluid_positions[first + i]);
      tank.sampled.fluid_velocities.emplace_back(0.0f);
      tank.sampled.fluid_index.push_back(0);
    }
  }
  return tank;
}
constexpr std::size_t kFilling = 2;  // the tank's body, its water, this

TEST(Appear, ABodyThatStartsAwayTouchesNothing) {
  Tank without = testing::stirred_tank();
  without.scene.bodies.pop_back();
  without.sampled.surfaces.pop_back();
  without.sampled.distance_fields.pop_back();
  without.scene.grips.clear();
  World away = testing::world_of(with_paddle_away());
  World empty = testing::world_of(without);
  go_on(away, 0.1);
  go_on(empty, 0.1);
  EXPECT_TRUE(state_of_paddle(away).away());
  EXPECT_EQ(state_of_paddle(away).fluid.force, glm::dvec3(0.0));
  const Snapshot a = seen_now(away), b = seen_now(empty);
  ASSERT_EQ(a.positions.size(), b.positions.size());
  for (std::size_t i = 0; i < a.positions.size(); ++i)
    EXPECT_LT(glm::distance(a.positions[i], b.positions[i]), 1e-4f) << "by rounding: sums in another order";
}

TEST(Appear, ABodyComesWhereTheSceneHasItAndGoesAgain) {
  Tank tank = with_paddle_away();
  tank.scene.bodies[kPaddleBody].twist.linear = {0.0, 0.3, 0.0};
  tank.scene.bodies[kPaddleBody].pose.position.y = 0.4;
  tank.scene.domain_max.y = 1.0;
  World world = testing::world_of(tank);
  go_on(world, 0.02);
  EXPECT_FALSE(world.take_away(kPaddleBody)) << "it is away";
  ASSERT_TRUE(world.appear(kPaddleBody));
  EXPECT_FALSE(world.appear(kPaddleBody)) << "it is there";
  const BodyState came = state_of_paddle(world);
  EXPECT_FALSE(came.gone);
  EXPECT_EQ(came.pose.position, tank.scene.bodies[kPaddleBody].pose.position);
  go_on(world, 0.05);
  EXPECT_NEAR(state_of_paddle(world).twist.linear.y, 0.3 - 9.81 * 0.05, 0.03)
      << "thrown up, it slows down by gravity";
  ASSERT_TRUE(world.take_away(kPaddleBody));
  go_on(world, 0.05);
  EXPECT_TRUE(state_of_paddle(world).away());
  EXPECT_EQ(world.take_status() & kStatusBodyGone, 0u) << "it was taken, and did not get lost";
}

TEST(Appear, WhatStandsForGoodNeitherComesNorGoes) {
  World world = testing::world_of(with_paddle_away());
  EXPECT_FALSE(world.appear(0)) << "the tank is there";
  const Result<bool> refused = world.take_away(0);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(test::contains(refused.error().text(), "stands for good")) << refused.error().text();
  EXPECT_FALSE(world.appear(99));
  EXPECT_FALSE(world.take_away(99));
}

TEST(Appear, AFillingHasTheMassOfItsParticlesAndMovesNobodyElse) {
  World world = testing::world_of(with_filling(4, 1, true));
  go_on(world, 0.1);
  const Diagnostics before = world.diagnostics();
  EXPECT_EQ(before.retired, 0u) << "what has still to come is not lost";
  const Snapshot then = seen_now(world);
  ASSERT_TRUE(world.appear(kFilling));
  const Diagnostics after = world.diagnostics();
  EXPECT_EQ(after.particles, before.particles + 64);
  EXPECT_NEAR(after.mass - before.mass, 64 * 1e-3, 1e-7);
  EXPECT_EQ(after.retired, 0u);
  const Snapshot now = seen_now(world);
  for (std::size_t i = 0; i < then.positions.size(); ++i) {
    if (then.fluid_index[i] != 255) EXPECT_EQ(then.positions[i], now.positions[i]);
  }
  go_on(world, 0.5);
  EXPECT_EQ(world.diagnostics().particles, after.particles) << "it fell into the water, and all of it stays";
  EXPECT_EQ(world.take_status() & (kStatusNonFinite | kStatusCompressed), 0u);
}

TEST(Appear, FillingsHaveAnEndAndWhatWasTakenAwayComesAgain) {
  World world = testing::world_of(with_filling(4, 2, false));
  Result<bool> full = world.appear(kFilling);
  ASSERT_FALSE(full) << "it is where it was";
  EXPECT_TRUE(test::contains(full.error().text(), "has no room")) << full.error().text();
  go_on(world, 0.3);
  ASSERT_TRUE(world.appear(kFilling)) << "the first filling has fallen";
  go_on(world, 0.3);
  full = world.appear(kFilling);
  ASSERT_FALSE(full);
  EXPECT_TRUE(test::contains(full.error().text(), "needs 64 particles to be filled, and 0 are left"))
      << full.error().text();
  const double mass = world.diagnostics().mass;
  ASSERT_TRUE(world.take_away(kFilling));
  EXPECT_NEAR(mass - world.diagnostics().mass, 128 * 1e-3, 1e-7);
  EXPECT_EQ(world.diagnostics().retired, 0u) << "taken away is not spilled";
  EXPECT_FALSE(world.take_away(kFilling)) << "nothing is left of it";
  ASSERT_TRUE(world.appear(kFilling)) << "also at once";
  go_on(world, 0.05);
  EXPECT_NEAR(mass - world.diagnostics().mass, 64 * 1e-3, 1e-7);
}

TEST(Appear, WhatIsSpilledStaysSpilledWhenItIsFilledAgain) {
  Tank tank = with_filling(4, 1, true);
  for (glm::vec3& place : tank.sampled.fluid_positions)
    if (place.y > 0.07f) place.x += 0.1f;  // outside the tank: it falls out of the world
  World world = testing::world_of(tank);
  ASSERT_TRUE(world.appear(kFilling));
  go_on(world, 0.6);
  EXPECT_EQ(world.diagnostics().retired, 64u);
  ASSERT_TRUE(world.appear(kFilling));
  EXPECT_EQ(world.diagnostics().retired, 64u);
  go_on(world, 0.6);
  EXPECT_EQ(world.diagnostics().retired, 128u);
}

TEST(Appear, AVolumeIsFilledWhereItsBodyIs) {
  Tank tank = with_paddle_away();
  Body& paddle = tank.scene.bodies[kPaddleBody];
  paddle.starts_away = false;
  paddle.pose.position.y = 0.5;
  tank.scene.domain_max.y = 1.0;
  tank.scene.gravity = glm::dvec3(0.0);
  paddle.twist.linear = {0.0, 0.1, 0.0};
  const auto before = static_cast<std::uint32_t>(tank.sampled.fluid_positions.size());
  const glm::dvec3 over = paddle.pose.position + glm::dvec3(-0.01, 0.1, -0.01);
  testing::add_fluid_block(tank.scene, tank.sampled, 0, over, over + 0.02);
  tank.sampled.fillings.resize(tank.scene.fluid_volumes.size());
  tank.sampled.fillings.back() = {before, 8, 0, 0};
  tank.scene.fluid_volumes.back().body = static_cast<int>(kPaddleBody);
  tank.scene.fluid_volumes.back().starts_away = true;
  World world = testing::world_of(tank);
  go_on(world, 0.2);
  const double moved = state_of_paddle(world).pose.position.y - paddle.pose.position.y;
  EXPECT_NEAR(moved, 0.02, 0.001);
  const std::size_t thing = tank.scene.bodies.size() + tank.scene.fluid_volumes.size() - 1;
  ASSERT_TRUE(world.appear(thing));
  std::vector<glm::vec3> velocities;
  world.fill_velocities(velocities);
  EXPECT_NEAR(seen_now(world).positions[before].y, over.y + 0.005 + moved, 1e-6);
  EXPECT_NEAR(velocities[before].y, 0.1f, 1e-6f) << "it moves with what carries it";
  ASSERT_TRUE(world.take_away(kPaddleBody));
  EXPECT_FALSE(world.appear(thing)) << "its body is not there";
}

TEST(Appear, ASavedWorldKnowsWhatIsThereAndWhatHasStillToCome) {
  const Tank tank = with_filling(4, 3, true);
  World world = testing::world_of(tank);
  go_on(world, 0.1);
  ASSERT_TRUE(world.appear(kFilling));
  go_on(world, 0.1);
  std::vector<std::uint8_t> saved;
  ASSERT_TRUE(world.save(saved));
  World other = testing::world_of(tank);
  ASSERT_TRUE(other.restore(saved));
  EXPECT_EQ(other.diagnostics().retired, 0u);
  for (World* each : {&world, &other}) {
    go_on(*each, 0.2);
    ASSERT_TRUE(each->appear(kFilling));
    go_on(*each, 0.1);
  }
  EXPECT_EQ(world.hash(), other.hash());
  const Tank away = with_paddle_away();
  World first = testing::world_of(away), second = testing::world_of(away);
  saved.clear();
  ASSERT_TRUE(first.save(saved));
  ASSERT_TRUE(second.restore(saved));
  EXPECT_TRUE(state_of_paddle(second).away());
}

}  // namespace
}  // namespace slosh
