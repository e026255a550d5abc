// A world that is saved, restored and changed while it runs: bitwise on the CPU; tests/cross has the GPU.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "sim/step_limits.h"
#include "sim/viscosity/stability.h"
#include "sim/world.h"
#include "tests/support/stirred_tank.h"

namespace slosh {
namespace {

using testing::make_tank;
using testing::stirred_tank;
using testing::Tank;
using testing::world_of;
using Bytes = std::vector<std::uint8_t>;

// Takes hold, is rejected for a while (so that the last input counts), lets go.
HandleInput hand_at(std::uint64_t tick, double time) {
  HandleInput hand = testing::paddle_hand(time);
  hand.engaged = tick < 330;
  hand.scale = std::min(1.0, static_cast<double>(tick) / 50.0);
  if (tick > 140 && tick < 170) hand.pose.position.x = std::numeric_limits<double>::quiet_NaN();
  return hand;
}

void run(World& world, std::uint64_t until) {
  while (world.tick() < until) {
    const HandleInput hand = hand_at(world.tick(), world.time());
    world.step({&hand, 1});
  }
}

Bytes saved(const World& world) {
  Bytes bytes;
  EXPECT_TRUE(world.save(bytes));
  return bytes;
}

void expect_same(const BodySnapshot& a, const BodySnapshot& b) {
  EXPECT_EQ(a.tick, b.tick);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.status, b.status);
  ASSERT_EQ(a.bodies.size(), b.bodies.size());
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    EXPECT_EQ(a.bodies[i].pose.position, b.bodies[i].pose.position);
    EXPECT_EQ(a.bodies[i].twist.linear, b.bodies[i].twist.linear);
    EXPECT_EQ(a.bodies[i].fluid.force, b.bodies[i].fluid.force);
  }
  for (std::size_t i = 0; i < a.grips.size(); ++i) {
    EXPECT_EQ(a.grips[i].on_hand.force, b.grips[i].on_hand.force);
    EXPECT_EQ(a.grips[i].handle.position, b.grips[i].handle.position);
  }
}

class SavedModel : public ::testing::TestWithParam<ParticleModel> {};

TEST_P(SavedModel, GoesOnToTheBit) {
  Tank tank = stirred_tank();
  tank.scene.model = GetParam();
  World whole = world_of(tank);
  std::vector<Bytes> at;
  for (const std::uint64_t tick : {0u, 150u, 320u}) {
    run(whole, tick);
    at.push_back(saved(whole));
  }
  run(whole, 400);
  BodySnapshot end;
  whole.fill(end);
  for (const Bytes& bytes : at) {
    World again = world_of(tank, 2);
    run(again, 7);  // what it was before does not matter
    const Result<bool> restored = again.restore(bytes);
    ASSERT_TRUE(restored) << restored.error().text();
    EXPECT_EQ(saved(again), bytes);
    run(again, 400);
    EXPECT_EQ(again.hash(), whole.hash());
    BodySnapshot snapshot;
    again.fill(snapshot);
    expect_same(snapshot, end);
  }
}

// Of the incompressible model with the pressures that the next solve begins with.
INSTANTIATE_TEST_SUITE_P(Models, SavedModel,
                         ::testing::Values(ParticleModel::kCorrected, ParticleModel::kIncompressible),
                         [](const auto& p) { return name(p.param); });

TEST(SavedWorld, KeepsRetiredParticlesOutAndTheOrderOfTheOthers) {
  Tank tank = stirred_tank();
  tank.scene.domain_max.y = 0.14;
  for (std::size_t i = 0; i < 60; ++i) tank.sampled.fluid_velocities[i * 7] = {0.0f, 1e3f, 0.0f};
  tank.sampled.fluid_positions[3].x = std::numeric_limits<float>::quiet_NaN();
  World whole = world_of(tank);
  std::vector<Bytes> at;
  while (whole.tick() < 120) {
    at.push_back(saved(whole));
    run(whole, whole.tick() + 10);
  }
  ASSERT_GT(whole.diagnostics().retired, 1u);
  for (const Bytes& bytes : at) {
    World again = world_of(tank);
    const Result<bool> restored = again.restore(bytes);
    ASSERT_TRUE(restored) << restored.error().text();
    run(again, 120);
    EXPECT_EQ(again.hash(), whole.hash());
    EXPECT_EQ(again.diagnostics().retired, whole.diagnostics().retired);
    EXPECT_EQ(again.diagnostics().lost, 1u);
    EXPECT_EQ(again.diagnostics().spilled, whole.diagnostics().spilled);
  }
}

TEST(SavedWorld, OfTheVersionBeforeGoesOnToTheBit) {
  const Tank tank = stirred_tank();
  World whole = world_of(tank);
  run(whole, 60);
  Bytes bytes = saved(whole);
  run(whole, 120);
  // Without the counts of lost and of waiting particles, behind tick, status, gravity and age.
  constexpr std::uint32_t kEarlier = 5;
  constexpr std::ptrdiff_t kCount = 2 * 4 + 10 * 8 + 8 + 4 + 8 + 8;
  std::memcpy(bytes.data() + 4, &kEarlier, 4);
  bytes.erase(bytes.begin() + kCount, bytes.begin() + kCount + 16);
  World again = world_of(tank);
  const Result<bool> restored = again.restore(bytes);
  ASSERT_TRUE(restored) << restored.error().text();
  run(again, 120);
  EXPECT_EQ(again.hash(), whole.hash());
  EXPECT_EQ(again.diagnostics().lost, 0u);
}

TEST(SavedWorld, OfAProbeGoesOnToTheBit) {
  Tank tank = make_tank({});
  testing::add_grip(tank, testing::add_probe(tank, {0.0, 0.15, 0.0}));
  World whole = world_of(tank);
  run(whole, 60);
  const Bytes bytes = saved(whole);
  run(whole, 160);
  World again = world_of(tank);
  ASSERT_TRUE(again.restore(bytes));
  run(again, 160);
  EXPECT_EQ(again.hash(), whole.hash());
}

TEST(SavedWorld, OfAnotherSceneSpacingOrPlanIsRefusedInWords) {
  const Tank tank = stirred_tank();
  const Bytes bytes = saved(world_of(tank));
  const auto expect_refused = [&](const Tank& other, const char* words) {
    World world = world_of(other);
    const std::uint64_t before = world.hash();
    const Result<bool> restored = world.restore(bytes);
    ASSERT_FALSE(restored);
    EXPECT_NE(restored.error().text().find(words), std::string::npos) << restored.error().text();
    EXPECT_EQ(world.hash(), before);
  };
  Tank heavier = tank;
  heavier.scene.bodies[1].mass.mass *= 1.01;
  expect_refused(heavier, "another scene");
  Tank stiffer = tank;
  stiffer.scene.stiffness = 1.3 * make_plan(tank.scene, tank.sampled.spacing).stiffness;
  expect_refused(stiffer, "time step");
  Tank fewer = tank;
  fewer.sampled.fluid_positions.pop_back();
  fewer.sampled.fluid_velocities.pop_back();
  fewer.sampled.fluid_index.pop_back();
  expect_refused(fewer, "number of fluid particles");
}

// Every length, and every byte changed: an error or another sound state, never harm.
TEST(SavedWorld, DamagedBytesDoNoHarm) {
  Tank tank = stirred_tank();
  tank.sampled.fluid_positions.resize(40);
  tank.sampled.fluid_velocities.resize(40);
  tank.sampled.fluid_index.resize(40);
  World world = world_of(tank);
  run(world, 20);
  const Bytes bytes = saved(world);
  World other = world_of(tank);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    ASSERT_FALSE(other.restore({bytes.data(), length})) << length;
  }
  Bytes longer = bytes;
  longer.push_back(0);
  EXPECT_FALSE(other.restore(longer));
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const std::uint8_t change : {0x01, 0x80, 0x7f}) {
      Bytes damaged = bytes;
      damaged[at] ^= change;
      if (other.restore(damaged) && at % 11 == 0) run(other, other.tick() + 1);
      ASSERT_LE(other.diagnostics().particles, 40u);
    }
  }
}

TEST(SavedWorld, RefusesParticlesThatCannotBe) {
  const Tank tank = stirred_tank();
  World world = world_of(tank);
  run(world, 3);
  const Bytes bytes = saved(world);
  const std::size_t n = world.fluid_count();
  const std::size_t columns =
      bytes.size() - 33 * n;  // x is the first, then y …; ids are the eighth, gone the last
  const auto refused = [&](std::size_t at, const void* value, std::size_t size, const char* words) {
    Bytes damaged = bytes;
    std::memcpy(damaged.data() + at, value, size);
    const std::uint64_t before = world.hash();
    const Result<bool> restored = world.restore(damaged);
    ASSERT_FALSE(restored) << words;
    EXPECT_NE(restored.error().text().find(words), std::string::npos) << restored.error().text();
    EXPECT_EQ(world.hash(), before);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float far = 1e6f;
  const float none = 0.0f;
  for (int column = 0; column < 7; ++column) refused(columns + 4 * (column * n + 5), &nan, 4, "not finite");
  refused(columns + 4 * 9, &far, 4, "outside the domain");
  refused(columns + 4 * (6 * n + 2), &none, 4, "not finite");
  std::uint32_t id = 0;
  std::memcpy(&id, bytes.data() + columns + 4 * (7 * n), 4);
  refused(columns + 4 * (7 * n + 1), &id, 4, "twice");
  id = static_cast<std::uint32_t>(n);
  refused(columns + 4 * (7 * n + 1), &id, 4, "not of this world");
}

TEST(SavedWorld, RefusesAPressureThatIsNone) {
  Tank tank = stirred_tank();
  tank.scene.model = ParticleModel::kIncompressible;
  World world = world_of(tank);
  run(world, 3);
  const Bytes bytes = saved(world);
  const std::size_t n = world.fluid_count();
  for (const float none : {-1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    Bytes damaged = bytes;
    std::memcpy(damaged.data() + damaged.size() - 5 * n + 4 * 7, &none, 4);  // behind it who is retired
    const Result<bool> restored = world.restore(damaged);
    ASSERT_FALSE(restored);
    EXPECT_NE(restored.error().text().find("pressure"), std::string::npos) << restored.error().text();
  }
}

TEST(LiveViscosity, ThickensUpToWhatTheStepHolds) {
  const Tank tank = make_tank({.viscosity = 0.0});
  World world = world_of(tank);
  ASSERT_FALSE(world.plan().viscous());
  const Result<bool> refused = world.set_viscosity(0, 1e4);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().mend.find("Pa·s will do"), std::string::npos) << refused.error().text();
  const double most = max_viscosity_allowed(tank.scene, world.plan(), drag_layer(tank.scene, world.plan()));
  EXPECT_GT(most, 0.1);
  EXPECT_FALSE(world.set_viscosity(0, 1.001 * most));
  EXPECT_FALSE(world.set_viscosity(0, -1.0));
  EXPECT_FALSE(world.set_viscosity(0, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(world.set_viscosity(1, 0.1)) << "no such fluid";
  ASSERT_TRUE(world.set_viscosity(0, most));
  EXPECT_TRUE(world.plan().viscous()) << "the pass that was left out is there now";
  EXPECT_EQ(world.viscosity(0), most);
  for (int i = 0; i < 400; ++i) world.step({});
  EXPECT_EQ(world.diagnostics().retired, 0u);
  EXPECT_LT(world.diagnostics().max_speed, 0.2) << "stable at the bound";
}

// A world made with a viscosity and one that came to it are the same.
// As far as both are thin, or neither: which of a wall's particles drag stays for the run
// (viscosity/wall_drag.h).
TEST(LiveViscosity, IsAsIfTheSceneHadIt) {
  const Tank thin = make_tank({.viscosity = 0.01});
  const Tank thick = make_tank({.viscosity = 0.1});
  const Plan plan = make_plan(thin.scene, thin.sampled.spacing);
  Plan plan_thick = make_plan(thick.scene, thick.sampled.spacing);
  ASSERT_EQ(plan.time_step, plan_thick.time_step) << "sound decides both";
  World changed(thin.scene, thin.sampled, plan, {1, Backend::kCpu});
  World made(thick.scene, thick.sampled, plan_thick, {1, Backend::kCpu});
  ASSERT_TRUE(changed.set_viscosity(0, 0.1));
  for (int i = 0; i < 100; ++i) {
    changed.step({});
    made.step({});
  }
  EXPECT_EQ(changed.hash(), made.hash());
}

TEST(LiveGravity, ScalesWeightAndIsBounded) {
  const Tank tank = make_tank({});
  World world = world_of(tank);
  EXPECT_FALSE(world.set_gravity_scale(2.1));
  EXPECT_FALSE(world.set_gravity_scale(-0.1));
  EXPECT_FALSE(world.set_gravity_scale(std::numeric_limits<double>::quiet_NaN()));
  world.settle(0.4);
  const double most = std::min(2.0, most_gravity_allowed(tank.scene, world.plan()));
  ASSERT_GT(most, 1.2);
  ASSERT_TRUE(world.set_gravity_scale(most));
  world.settle(0.8);
  BodySnapshot snapshot;
  double weight = 0.0;
  for (int i = 0; i < 100; ++i) {
    world.step({});
    world.fill(snapshot);
    weight -= snapshot.bodies[0].fluid.force.y / 100.0;
  }
  EXPECT_NEAR(weight / (world.diagnostics().mass * 9.81), most, 0.02);
  EXPECT_EQ(world.diagnostics().retired, 0u);
}

TEST(LiveParameters, AreSavedAndRestored) {
  const Tank tank = stirred_tank();
  World whole = world_of(tank);
  run(whole, 20);
  ASSERT_TRUE(whole.set_viscosity(1, 0.2));
  ASSERT_TRUE(whole.set_gravity_scale(0.5));
  const Bytes bytes = saved(whole);
  World again = world_of(tank);
  ASSERT_TRUE(again.restore(bytes));
  EXPECT_EQ(again.viscosity(1), 0.2);
  EXPECT_EQ(again.gravity_scale(), 0.5);
  run(whole, 120);
  run(again, 120);
  EXPECT_EQ(again.hash(), whole.hash());
  World unchanged = world_of(tank);
  run(unchanged, 120);
  EXPECT_NE(unchanged.hash(), whole.hash());
}

}  // namespace
}  // namespace slosh
