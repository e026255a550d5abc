// When steps of a guided task are done, in worlds whose motion is known.
#include "host/guided_task.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/make/solid.h"
#include "scenes/sample.h"
#include "tests/physics/lab.h"

namespace slosh {
namespace {

constexpr double kSpacing = 0.012;  // m

/// A tank with 60 mm of water falls from rest beside a block that stands; a region hangs on the tank.
Scene falling_tank() {
  lab::SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  const int tank = b.add_free("tank", lab::tank_at_floor({0.2, 0.15, 0.1}, 0.03), 2.0);
  b.add_fixed("block", make::box({0.5, -0.1, -0.1}, {0.7, 0.1, 0.1}));
  b.add_volume(make::box({-0.1, 0.0, -0.05}, {0.1, 0.06, 0.05}));
  b.set_domain({-5.0, -20.0, -5.0}, {5.0, 5.0, 5.0});
  Scene scene = b.scene;
  lab::SceneBuilder shapes;
  shapes.add_volume(make::box({-0.2, -0.1, -0.2}, {0.2, 0.3, 0.2}));
  scene.meshes.push_back(shapes.scene.meshes[0]);
  scene.regions.push_back({"in tank", static_cast<int>(scene.meshes.size()) - 1, tank, {}});
  return scene;
}

Goal at_least(GoalKind kind, int thing, double value) {
  Goal goal;
  goal.kind = kind;
  goal.thing = thing;
  goal.at_least = value;
  return goal;
}
Goal together(GoalKind kind, std::vector<Goal> parts) {
  Goal goal;
  goal.kind = kind;
  goal.parts = std::move(parts);
  return goal;
}
TaskStep step(Goal until, double hold = 0.0, double within = 0.0) {
  TaskStep out;
  out.say = "fall";
  out.until = std::move(until);
  out.hold = hold;
  out.within = within;
  return out;
}

struct Guided {
  Scene scene;
  SampledScene sampled = sample_scene(scene, kSpacing).value();
  World world{scene, sampled, make_plan(scene, kSpacing), WorldOptions{1, Backend::kCpu}};
  GuidedTask task{scene, sampled};

  explicit Guided(Scene made) : scene(std::move(made)) { task.follow(world); }
  const TaskState& until(double time) {
    while (world.time() < time) {
      world.step({});
      task.follow(world);
    }
    return task.state();
  }
};

TEST(GuidedTask, StepsAreDoneWhenTheWorldSaysSo) {
  Scene scene = falling_tank();
  const double whole = 0.2 * 0.1 * 0.06 * 1000.0;  // kg
  scene.task = {step(at_least(GoalKind::kSpeed, 0, 1.0)), step(at_least(GoalKind::kSpeed, 0, 2.0), 0.0, 0.05),
                step(at_least(GoalKind::kMass, 0, 0.9 * whole), 0.2),
                step(at_least(GoalKind::kDistance, 0, 1e3))};
  scene.task[3].until.other = 1;
  Guided run(scene);
  const TaskState& end = run.until(0.7);
  // 1 m/s after 102 ms and 2 after 204 of a fall; the world is looked at every 50.
  ASSERT_EQ(end.done.size(), 3u);
  EXPECT_NEAR(end.done[0].took, 0.15, 0.011);
  EXPECT_FALSE(end.done[0].late);
  EXPECT_NEAR(end.done[1].took, 0.10, 0.021);
  EXPECT_TRUE(end.done[1].late) << "50 ms were given";
  EXPECT_NEAR(end.done[2].took, 0.25, 0.021) << "held for 0.2 s from the next look on";
  ASSERT_NE(end.asked, nullptr);
  EXPECT_EQ(end.asked->kind, GoalKind::kDistance);
  // 0.6 m apart at the start, and 9.81 · 0.7² / 2 below each other.
  EXPECT_NEAR(end.measured, std::hypot(0.6, 2.4), 0.15);
  EXPECT_NEAR(end.now - end.begun, 0.2, 0.03);
}

// Oil of 80 °C on as much water of 20: what each goal of a region measures before anything moves.
TEST(GuidedTask, ARegionTellsMoreThanItsMass) {
  const auto measured = [](GoalKind kind, int fluid) {
    Scene scene = falling_tank();
    scene.fluids.push_back(scene.fluids[0]);
    scene.fluids[1].name = "oil";
    scene.fluids[1].heat.temperature = 80.0;
    scene.fluids[1].heat.starts_set = true;
    scene.fluid_volumes.push_back(scene.fluid_volumes[0]);
    scene.fluid_volumes[1].fluid = 1;
    lab::SceneBuilder shapes;
    shapes.add_volume(make::box({-0.096, 0.0, -0.048}, {0.096, 0.048, 0.048}));
    shapes.add_volume(make::box({-0.096, 0.048, -0.048}, {0.096, 0.096, 0.048}));
    for (int v = 0; v < 2; ++v) {
      scene.fluid_volumes[static_cast<std::size_t>(v)].mesh = static_cast<int>(scene.meshes.size());
      scene.meshes.push_back(shapes.scene.meshes[static_cast<std::size_t>(v)]);
    }
    Goal goal = at_least(kind, 0, 1e9);
    goal.other = fluid;
    scene.task = {step(goal)};
    return Guided(scene).task.state().measured;
  };
  EXPECT_NEAR(measured(GoalKind::kTemperature, -1), 50.0, 1e-3);
  EXPECT_NEAR(measured(GoalKind::kTemperature, 1), 80.0, 1e-3);
  EXPECT_NEAR(measured(GoalKind::kSet, -1), 0.5, 1e-6);
  EXPECT_NEAR(measured(GoalKind::kSet, 0), 0.0, 1e-6);
  EXPECT_NEAR(measured(GoalKind::kSpread, -1), 0.192 * 0.096, 0.003);
  EXPECT_GT(measured(GoalKind::kEvenness, 0), 0.95);
  EXPECT_LT(measured(GoalKind::kMixing, 1), 0.35) << "samples at the middle have both";
}

TEST(GuidedTask, GoalsGoTogether) {
  Scene scene = falling_tank();
  const Goal slow = [] {
    Goal goal = at_least(GoalKind::kSpeed, 0, 0.0);
    goal.at_most = 0.5;
    return goal;
  }();
  const Goal fast = at_least(GoalKind::kSpeed, 0, 1.0);
  const Goal tilted = at_least(GoalKind::kTilt, 0, 20.0);
  scene.task = {step(together(GoalKind::kAny, {fast, slow})), step(together(GoalKind::kNot, {slow})),
                step(together(GoalKind::kAll, {fast, together(GoalKind::kNot, {tilted})})),
                step(together(GoalKind::kAll, {fast, tilted}))};
  Guided run(scene);
  EXPECT_EQ(run.task.state().done.size(), 1u) << "slow at the start, by the first look";
  const TaskState& end = run.until(0.5);
  ASSERT_EQ(end.done.size(), 3u) << "it never leans";
  ASSERT_NE(end.asked, nullptr);
  EXPECT_EQ(end.asked->kind, GoalKind::kTilt) << "what is missing is what is told";
  EXPECT_NEAR(end.measured, 0.0, 1.0);
}

TEST(GuidedTask, AFluidIsWeighedAloneOrWithAll) {
  Scene scene = falling_tank();
  scene.fluids.push_back(scene.fluids[0]);
  scene.fluids[1].name = "none of it";
  Goal other = at_least(GoalKind::kMass, 0, 0.1);
  other.other = 1;
  Goal own = other;
  own.other = 0;
  scene.task = {step(own), step(at_least(GoalKind::kMass, 0, 0.1)), step(other)};
  Guided run(scene);
  const TaskState& end = run.until(0.3);
  EXPECT_EQ(end.done.size(), 2u);
  EXPECT_EQ(end.measured, 0.0);
}

TEST(GuidedTask, WhatCannotBeToldMeetsNothing) {
  Scene scene = falling_tank();
  scene.gauges.push_back({"far from fluid", -1, {3.0, 0.0, 0.0}});
  Goal level = at_least(GoalKind::kLevel, 0, -1e9);
  scene.task = {step(level)};
  Guided run(scene);
  const TaskState& end = run.until(0.2);
  EXPECT_TRUE(end.done.empty());
  EXPECT_TRUE(std::isnan(end.measured));
}

TEST(GuidedTask, AWorldThatIsSetBackBeginsItAnew) {
  Scene scene = falling_tank();
  scene.task = {step(at_least(GoalKind::kSpeed, 0, 1.0)), step(at_least(GoalKind::kSpeed, 0, 1e3))};
  Guided run(scene);
  EXPECT_EQ(run.until(0.3).done.size(), 1u);
  World again(run.scene, run.sampled, make_plan(run.scene, kSpacing), WorldOptions{1, Backend::kCpu});
  EXPECT_TRUE(run.task.follow(again));
  EXPECT_TRUE(run.task.state().done.empty());
  EXPECT_EQ(run.task.state().begun, 0.0);
}

}  // namespace
}  // namespace slosh
