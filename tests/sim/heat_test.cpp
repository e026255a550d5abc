// Heat and setting: laws of one particle, what a whole fluid keeps, and that all of it is saved.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/passes/heat/conduction.h"
#include "sim/world.h"
#include "tests/support/stirred_tank.h"

namespace slosh {
namespace {

using testing::stirred_tank;
using testing::Tank;
using testing::world_of;

// Conducts so well that a tenth of a second shows it.
Heat fast(double celsius) {
  Heat heat;
  heat.temperature = celsius;
  heat.capacity = 1000.0;
  heat.conductivity = 2000.0;
  return heat;
}

// Hot oil on cold water, which a paddle stirs.
Tank warm_tank() {
  Tank tank = stirred_tank();
  tank.scene.fluids[0].heat = fast(20.0);
  tank.scene.fluids[1].heat = fast(80.0);
  return tank;
}

void stir(World& world, int steps) {
  for (int i = 0; i < steps; ++i) {
    const HandleInput hand = testing::paddle_hand(world.time());
    world.step({&hand, 1});
  }
}

TEST(HeatLaw, ViscosityGoesThroughThePointsAndStaysBeyondThem) {
  HeatKind kind;
  kind.points = 2;
  kind.at[0] = 20.0f;
  kind.at[1] = 60.0f;
  kind.log_times[0] = 0.0f;
  kind.log_times[1] = std::log(0.01f);
  EXPECT_FLOAT_EQ(thickness_of(kind, 2.0f, 0.0f, 0.0f), 2.0f);
  EXPECT_FLOAT_EQ(thickness_of(kind, 2.0f, 20.0f, 0.0f), 2.0f);
  EXPECT_FLOAT_EQ(thickness_of(kind, 2.0f, 40.0f, 0.0f), 0.2f);
  EXPECT_FLOAT_EQ(thickness_of(kind, 2.0f, 90.0f, 0.0f), 0.02f);
  kind.log_of_set = std::log(100.0f);
  EXPECT_FLOAT_EQ(thickness_of(kind, 2.0f, 90.0f, 1.0f), 2.0f);
  EXPECT_FLOAT_EQ(thickness_of(kind, 2.0f, 90.0f, 0.5f), 0.2f);
}

TEST(HeatLaw, SetsInTheStatedTimeAndMeltsAgain) {
  HeatKind kind;
  kind.sets_above = 70.0f;
  kind.setting = 0.5f;
  kind.melts_above = 120.0f;
  kind.melting = 2.0f;
  EXPECT_EQ(cure_after(kind, 69.0f, 0.0f, 1.0f), 0.0f);
  EXPECT_EQ(cure_after(kind, 70.0f, 0.0f, 1.0f), 0.5f);
  EXPECT_EQ(cure_after(kind, 70.0f, 0.8f, 1.0f), 1.0f);
  EXPECT_FLOAT_EQ(cure_after(kind, 130.0f, 1.0f, 0.25f), 0.5f);
  HeatKind cold;
  cold.sets_below = 5.0f;
  cold.setting = 1.0f;
  EXPECT_EQ(cure_after(cold, 4.0f, 0.0f, 0.25f), 0.25f);
  EXPECT_EQ(cure_after(cold, 20.0f, 0.25f, 1.0f), 0.25f);
}

TEST(HeatPlan, IsThereOnlyWhereSomethingChanges) {
  Tank tank = stirred_tank();
  const auto has = [&] { return make_plan(tank.scene, 0.01).has(PassId::kHeat); };
  EXPECT_FALSE(has());
  for (Fluid& fluid : tank.scene.fluids) fluid.heat.temperature = 90.0;
  EXPECT_FALSE(has()) << "as warm everywhere";
  tank.scene.bodies[0].temperature = 90.0;
  EXPECT_FALSE(has()) << "as warm as the fluid";
  tank.scene.bodies[0].temperature = 91.0;
  EXPECT_TRUE(has());
  tank.scene.bodies[0].temperature.reset();
  tank.scene.fluids[0].heat.sets_above = 60.0;
  tank.scene.fluids[0].heat.sets_in = 5.0;
  EXPECT_TRUE(has());
}

// The time step holds for all that a fluid may come to.
TEST(HeatPlan, TakesTheThickestAndTheThinnestOfWhatMayCome) {
  Tank tank = warm_tank();
  Fluid& water = tank.scene.fluids[0];
  const double thin = make_plan(tank.scene, 0.01).time_step;
  water.heat.sets_above = 60.0;
  water.heat.sets_in = 5.0;
  water.heat.set_times = 1e6;
  EXPECT_LT(make_plan(tank.scene, 0.01).time_step, thin);
  const ViscosityRange range = viscosity_range(tank.scene, water);
  EXPECT_DOUBLE_EQ(range.least, water.dynamic_viscosity);
  EXPECT_DOUBLE_EQ(range.most, 1e6 * water.dynamic_viscosity);
}

TEST(HeatPlan, TakesManyStepsInOneButNotMoreThanConductionAllows) {
  Tank tank = warm_tank();
  for (Fluid& fluid : tank.scene.fluids) fluid.heat.conductivity = 20.0;
  const Plan plan = make_plan(tank.scene, 0.01);
  EXPECT_EQ(plan.heat_steps, static_cast<int>(kHeatTime / plan.time_step));
  for (Fluid& fluid : tank.scene.fluids) fluid.heat.conductivity = 1000.0;
  const Plan quick = make_plan(tank.scene, 0.01);
  EXPECT_LT(quick.heat_steps, plan.heat_steps);
  EXPECT_LE(quick.heat_steps * quick.time_step, conduction_step(tank.scene, quick));
}

// Nothing but rounding changes the heat of a fluid that is stirred; it evens out.
TEST(Heat, IsKeptWhileItEvensOut) {
  const Tank tank = warm_tank();
  World world = world_of(tank, 2);
  const Diagnostics before = world.diagnostics();
  EXPECT_EQ(before.coldest, 20.0);
  EXPECT_EQ(before.hottest, 80.0);
  stir(world, 300);
  const Diagnostics after = world.diagnostics();
  ASSERT_EQ(after.retired, 0u);
  EXPECT_NEAR(after.heat / before.heat, 1.0, 1e-6);
  EXPECT_EQ(after.heat_from_bodies, 0.0);
  EXPECT_GE(after.coldest, 20.0);
  EXPECT_LE(after.hottest, 80.0);
  EXPECT_LT(after.hottest - after.coldest, 55.0);
}

TEST(Heat, FromABodyIsAccountedFor) {
  Tank tank = warm_tank();
  tank.scene.bodies[0].temperature = 150.0;
  World world = world_of(tank);
  const double before = world.diagnostics().heat;
  stir(world, 300);
  const Diagnostics after = world.diagnostics();
  EXPECT_GT(after.heat_from_bodies, 0.01 * before);
  EXPECT_NEAR((after.heat - before) / after.heat_from_bodies, 1.0, 1e-4);
  EXPECT_LE(after.hottest, 150.0);
}

// Whatever the threads are, and from a saved world on.
TEST(Heat, IsTheSameToTheBit) {
  Tank tank = warm_tank();
  tank.scene.bodies[0].temperature = 150.0;
  tank.scene.fluids[0].heat.viscosity = {{20.0, 1.0}, {80.0, 0.2}};
  tank.scene.fluids[0].heat.sets_above = 60.0;
  tank.scene.fluids[0].heat.sets_in = 0.2;
  tank.scene.fluids[0].heat.set_times = 50.0;
  World one = world_of(tank, 1), two = world_of(tank, 2);
  std::vector<std::uint8_t> saved;
  stir(one, 57);
  ASSERT_TRUE(one.save(saved));
  stir(one, 100);
  stir(two, 157);
  EXPECT_GT(one.diagnostics().cure, 0.0);
  EXPECT_EQ(one.hash(), two.hash());
  World again = world_of(tank);
  stir(again, 7);
  const Result<bool> restored = again.restore(saved);
  ASSERT_TRUE(restored) << restored.error().text();
  stir(again, 100);
  EXPECT_EQ(again.hash(), one.hash());
  EXPECT_EQ(again.diagnostics().heat_from_bodies, one.diagnostics().heat_from_bodies);
}

TEST(Heat, StandsStillWhileAWorldSettles) {
  Tank tank = warm_tank();
  World world = world_of(tank);
  const double before = world.diagnostics().heat;
  world.settle(0.1);
  const Diagnostics after = world.diagnostics();
  EXPECT_EQ(after.heat, before);
  EXPECT_EQ(after.hottest, 80.0);
}

// A slider's change is a change of the whole law, at once.
TEST(Heat, AChangedViscosityReachesEveryParticle) {
  Tank tank = warm_tank();
  tank.scene.fluids[0].heat.viscosity = {{20.0, 1.0}, {80.0, 0.2}};
  World world = world_of(tank);
  World same = world_of(tank);
  stir(world, 5);
  stir(same, 5);
  ASSERT_TRUE(world.set_viscosity(0, 2.0 * world.viscosity(0)));
  stir(world, 1);
  stir(same, 1);
  EXPECT_NE(world.hash(), same.hash());
}

TEST(Heat, WhereNoneIsPassedItIsThatOfTheStart) {
  Tank tank = stirred_tank();
  for (Fluid& fluid : tank.scene.fluids) fluid.heat.temperature = 35.0;
  World world = world_of(tank);
  std::vector<float> temperatures, cures;
  world.fill_heat(temperatures, cures);
  ASSERT_EQ(temperatures.size(), world.fluid_count());
  EXPECT_EQ(temperatures.front(), 35.0f);
  EXPECT_EQ(cures.back(), 0.0f);
}

TEST(Heat, EachHasItsOwnByItsNumber) {
  const Tank tank = warm_tank();
  World world = world_of(tank);
  stir(world, 1);
  std::vector<float> temperatures, cures;
  world.fill_heat(temperatures, cures);
  Snapshot now;
  world.fill(now);
  for (std::size_t i = 0; i < temperatures.size(); ++i)
    ASSERT_NEAR(temperatures[i], now.fluid_index[i] == 0 ? 20.0 : 80.0, 25.0) << i;
}

}  // namespace
}  // namespace slosh
