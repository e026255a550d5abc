// A world that settles before its run: until what, for how long, and what of it is felt.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/steadiness.h"
#include "sim/world.h"
#include "tests/support/stirred_tank.h"

namespace slosh {
namespace {

using testing::make_tank;
using testing::stirred_tank;
using testing::Tank;
using testing::TankOptions;
using testing::world_of;

TEST(World, SettlingBringsRestAndKeepsTime) {
  const Tank tank = make_tank({});
  World world = world_of(tank);
  world.settle(0.5);
  EXPECT_EQ(world.tick(), 0u);
  EXPECT_EQ(world.time(), 0.0);
  BodySnapshot snapshot;
  world.step({});
  world.fill(snapshot);
  const double weight = world.diagnostics().mass * 9.81;
  EXPECT_NEAR(-snapshot.bodies[0].fluid.force.y, weight, 0.05 * weight);
  EXPECT_LT(world.diagnostics().max_speed, 0.1);
}

TEST(World, SettlingHangsABodyInTheHandThatHoldsIt) {
  const Tank tank = stirred_tank();
  World world = world_of(tank);
  HandleInput hand;
  hand.engaged = true;
  hand.pose.position = {-0.05, 0.09, 0.0};
  world.settle(1.0, {&hand, 1});
  BodySnapshot at_rest, later;
  world.fill(at_rest);
  for (int i = 0; i < 100; ++i) world.step({&hand, 1});
  world.fill(later);
  EXPECT_LT(at_rest.bodies[1].pose.position.y, 0.09);
  EXPECT_LT(glm::distance(at_rest.bodies[1].pose.position, later.bodies[1].pose.position), 3e-4);
}

TEST(World, SettlesUntilWhatHandsFeelIsSteady) {
  const Tank tank = stirred_tank();
  HandleInput hand;
  hand.engaged = true;
  hand.pose.position = {-0.05, 0.09, 0.0};
  World world = world_of(tank);
  EXPECT_NEAR(world.settle(0.1, {&hand, 1}), 0.1, 0.01) << "no longer than it is told";
  World steady = world_of(tank);
  const double took = steady.settle(0.1, {&hand, 1}, nullptr, 4.0);
  EXPECT_GT(took, 2.0 * Steadiness::kWindow) << "there are two windows to compare";
  EXPECT_LT(took, 3.9);
  Steadiness felt;
  BodySnapshot now;
  for (int i = 0; i < 1000 && !felt.steady(); ++i) {
    steady.step({&hand, 1});
    steady.fill(now);
    felt.feel(now.grips, steady.plan().time_step);
  }
  EXPECT_LT(steady.time(), 3.0 * Steadiness::kWindow) << "and it was";
  EXPECT_NEAR(steady.settle(0.1, {}, nullptr, 4.0), 0.1, 0.01) << "nobody feels anything";
}

TEST(Steadiness, SeesABounceAndAnOddDrift) {
  std::vector<GripState> grips(1);
  const auto feel = [&](double seconds, auto&& force) {
    Steadiness felt;
    for (double t = 0.0; t < seconds; t += 0.002) {
      grips[0].on_hand.force = {0.0, force(t), 0.0};
      felt.feel(grips, 0.002);
    }
    return felt.steady();
  };
  EXPECT_TRUE(feel(1.0, [](double) { return -10.0; }));
  EXPECT_FALSE(feel(0.3, [](double) { return -10.0; })) << "one window is compared with nothing";
  EXPECT_FALSE(feel(1.0, [](double t) { return -10.0 + 0.1 * std::sin(50.0 * t); }));
  EXPECT_FALSE(feel(1.0, [](double t) { return -10.0 + 0.5 * t; }));
  EXPECT_TRUE(feel(1.0, [](double t) { return 0.004 * std::sin(50.0 * t); }))
      << "below what a device can give";
}

TEST(World, SettlesAsLongAsItIsToldAndAsksNotWhatMoves) {
  Tank tank = make_tank({});
  for (glm::vec3& v : tank.sampled.fluid_velocities) v = {0.3f, 0.0f, 0.0f};
  World world = world_of(tank);
  const std::uint64_t before = world.hash();
  world.settle(0.0);
  EXPECT_EQ(world.hash(), before);
  world.settle(0.5, {}, [] { return true; });
  EXPECT_EQ(world.hash(), before) << "whoever ends does not wait";
  const double moving = world.diagnostics().kinetic_energy;
  world.settle(0.5);
  EXPECT_LT(world.diagnostics().kinetic_energy, 1e-2 * moving);
}

// Honey comes to its level in the time that water takes, and is honey again.
TEST(World, ThickFluidSettlesAsAThinnerOne) {
  for (const double viscosity : {kMaxSettlingViscosity, 1000.0 * kMaxSettlingViscosity}) {
    TankOptions options;
    options.spacing = 0.02;
    options.viscosity = options.wall_viscosity = viscosity;
    Tank tank = make_tank(options);
    tank.scene.bodies[0].dynamic_viscosity = kFluidsViscosity;
    for (glm::vec3& p : tank.sampled.fluid_positions)
      if (p.x > 0.0f) p += glm::vec3(-0.1f, 0.1f, 0.0f);  // a column in one half
    World world = world_of(tank);
    world.settle(1.5);
    EXPECT_NEAR(world.diagnostics().center.x, 0.0, 0.002) << viscosity << " Pa·s";
    EXPECT_NEAR(world.diagnostics().center.y, 0.05, 0.003) << viscosity << " Pa·s";
    EXPECT_EQ(world.viscosity(0), viscosity);
  }
}

}  // namespace
}  // namespace slosh
