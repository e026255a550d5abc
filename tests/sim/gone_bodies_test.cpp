// A free body that leaves the world for good is taken out of the motion, and that is said.
#include <gtest/gtest.h>

#include "sim/bodies/body_room.h"
#include "sim/world.h"
#include "tests/support/stirred_tank.h"

namespace slosh {
namespace {

using testing::stirred_tank;
using testing::Tank;
using testing::world_of;

constexpr int kPaddle = 1;

// Its distance fields are empty: nothing stops the paddle.
Tank thrown(const glm::dvec3& velocity) {
  Tank tank = stirred_tank();
  tank.scene.bodies[kPaddle].pose.position = {0.0, 0.4, 0.0};
  tank.scene.bodies[kPaddle].twist.linear = velocity;
  return tank;
}

BodySnapshot seen(const World& world) {
  BodySnapshot snapshot;
  world.fill(snapshot);
  return snapshot;
}

void run(World& world, double until, std::span<const HandleInput> hands = {}) {
  while (world.time() < until) world.step(hands);
}

TEST(GoneBodies, ABodyThrownOverTheRimStopsSomewhereAndIsSaidOnce) {
  const Tank tank = thrown({3.0, 1.0, 0.0});
  World world = world_of(tank);
  std::uint32_t status = 0;
  int times = 0;
  while (world.time() < 2.0) {
    world.step({});
    const std::uint32_t now = world.take_status();
    times += (now & kStatusBodyGone) != 0;
    status |= now;
  }
  EXPECT_EQ(times, 1) << status_text(status);
  const BodySnapshot there = seen(world);
  EXPECT_TRUE(there.bodies[kPaddle].gone);
  EXPECT_FALSE(there.bodies[0].gone);
  EXPECT_LT(glm::length(there.bodies[kPaddle].pose.position), 5.0);
  EXPECT_EQ(glm::length(there.bodies[kPaddle].twist.linear), 0.0);

  // No hand can hold it, and none feels it.
  HandleInput hand;
  hand.engaged = true;
  hand.pose = there.bodies[kPaddle].pose;
  hand.pose.position.y += 0.1;
  run(world, 2.1, {&hand, 1});
  const BodySnapshot later = seen(world);
  EXPECT_EQ(later.bodies[kPaddle].pose.position, there.bodies[kPaddle].pose.position);
  EXPECT_EQ(glm::length(later.grips[0].on_hand.force), 0.0);

  // A saved world knows it, and one of the start does not.
  std::vector<std::uint8_t> bytes;
  ASSERT_TRUE(world.save(bytes));
  World other = world_of(tank);
  ASSERT_TRUE(other.restore(bytes));
  EXPECT_TRUE(seen(other).bodies[kPaddle].gone);
  other.take_status();
  other.step({});
  EXPECT_EQ(other.take_status() & kStatusBodyGone, 0u) << "it was said";
  EXPECT_EQ(seen(other).bodies[kPaddle].pose.position, there.bodies[kPaddle].pose.position);
}

TEST(GoneBodies, WhatIsThrownUpComesBack) {
  const Tank tank = thrown({0.0, 12.0, 0.0});
  World world = world_of(tank);
  double highest = 0.0;
  while (world.time() < 2.3) {
    world.step({});
    highest = std::max(highest, seen(world).bodies[kPaddle].pose.position.y);
  }
  EXPECT_GT(highest, 6.0) << "many times the domain's height";
  EXPECT_FALSE(seen(world).bodies[kPaddle].gone);
}

TEST(GoneBodies, AHandTakesItsBodyWhereItWants) {
  const Tank tank = stirred_tank();
  World world = world_of(tank);
  HandleInput hand;
  hand.engaged = true;
  hand.twist.linear = {4.0, 0.0, 0.0};
  while (world.time() < 1.5) {
    hand.pose.position = {-0.05 + 4.0 * world.time(), testing::kPaddleHeight, 0.0};
    world.step({&hand, 1});
  }
  EXPECT_GT(seen(world).bodies[kPaddle].pose.position.x, 4.0);
  EXPECT_FALSE(seen(world).bodies[kPaddle].gone);
  EXPECT_EQ(world.take_status() & kStatusBodyGone, 0u);
  run(world, 1.6);
  EXPECT_TRUE(seen(world).bodies[kPaddle].gone) << "let go out there";
}

TEST(BodyRoom, IsTheDomainAndAllBodiesAndAsMuchAgain) {
  const Tank tank = stirred_tank();
  const BodyRoom room(tank.scene, tank.sampled);
  const glm::dvec3 down{0.0, -9.81, 0.0};
  EXPECT_FALSE(room.lost({0.1, 0.0, 0.0}, down));
  EXPECT_FALSE(room.lost({0.25, -0.2, 0.0}, down)) << "falls off the table, still in sight";
  EXPECT_TRUE(room.lost({0.0, -3.0, 0.0}, down));
  EXPECT_TRUE(room.lost({3.0, 0.0, 0.0}, down));
  EXPECT_FALSE(room.lost({0.0, 3.0, 0.0}, down)) << "comes down again";
  EXPECT_TRUE(room.lost({0.0, 3.0, 0.0}, glm::dvec3(0.0))) << "does not";
  EXPECT_TRUE(room.lost({0.0, 1e7, 0.0}, down));
  EXPECT_TRUE(room.lost(glm::dvec3(std::nan("")), down));
}

}  // namespace
}  // namespace slosh
