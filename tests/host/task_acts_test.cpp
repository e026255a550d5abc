// What finished steps of a guided task bring and take away.
#include <gtest/gtest.h>

#include "host/task_tap.h"
#include "scenes/make/solid.h"
#include "scenes/sample.h"
#include "tests/physics/lab.h"

namespace slosh {
namespace {

constexpr double kCoarse = 0.012;  // m

/// A ball falls past a block that waits to appear where the ball is at the start.
Scene ball_and_block() {
  lab::SceneBuilder b;
  b.add_free("ball", make::sphere(0.05, 12, 24), 1.0);
  b.add_free("block", make::box({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}), 1.0);
  b.set_domain({-1.0, -20.0, -1.0}, {1.0, 1.0, 1.0});
  b.scene.bodies[1].starts_away = true;
  return b.scene;
}

TaskStep when_faster(double speed, std::vector<TaskAct> then) {
  TaskStep step;
  step.say = "fall";
  step.until.kind = GoalKind::kSpeed;
  step.until.thing = 0;
  step.until.at_least = speed;
  step.then = std::move(then);
  return step;
}

struct Followed {
  Scene scene;
  SampledScene sampled = sample_scene(scene, kCoarse).value();
  World world{scene, sampled, make_plan(scene, kCoarse), WorldOptions{1, Backend::kCpu}};
  std::vector<HostCommand> asked;
  std::vector<std::string> refused;
  TaskTap tap{scene, sampled, [this](const HostCommand& command, const auto& answer) {
                asked.push_back(command);
                const Result<bool> done = change_world(world, command);
                if (!done) refused.push_back(done.error().text());
                answer(done);
              }};

  explicit Followed(Scene made) : scene(std::move(made)) { tap.on_start(world, {}); }
  void until(double time) {
    while (world.time() < time) {
      world.step({});
      tap.after_step(world);
    }
  }
  bool away(std::size_t body) const {
    BodySnapshot now;
    world.fill(now);
    return now.bodies[body].away();
  }
};

TEST(TaskActs, WhatHasNoRoomComesAsSoonAsItHas) {
  Scene scene = ball_and_block();
  scene.task = {when_faster(0.2, {{TaskActKind::kAppears, 1, -1}}), when_faster(100.0, {})};
  Followed run(scene);
  // 0.2 m/s after 20 ms, when the ball has fallen 2 mm; half a second later it is 1.3 m below.
  run.until(0.3);
  ASSERT_EQ(run.refused.size(), 1u);
  EXPECT_NE(run.refused[0].find("'ball' is in its place"), std::string::npos) << run.refused[0];
  EXPECT_NE(run.tap.lines().hint.find("is in its place"), std::string::npos) << run.tap.lines().hint;
  EXPECT_TRUE(run.away(1));
  run.until(0.8);
  EXPECT_EQ(run.asked.size(), 2u);
  EXPECT_FALSE(run.away(1));
  EXPECT_EQ(run.tap.lines().hint, "");
}

TEST(TaskActs, HappenInTheirOrderAndHandsAreTold) {
  Scene scene = ball_and_block();
  scene.bodies[1].pose.position.x = 0.5;
  scene.grips = {{"ball", 0, {}}, {"block", 1, {}}};
  scene.task = {when_faster(
      0.2,
      {{TaskActKind::kAppears, 1, -1}, {TaskActKind::kHandTakes, 0, 1}, {TaskActKind::kTakesAway, 0, -1}})};
  Followed run(scene);
  run.until(0.5);
  ASSERT_EQ(run.asked.size(), 2u);
  EXPECT_EQ(run.asked[0].action, HostAction::kAppear);
  EXPECT_EQ(run.asked[1].action, HostAction::kTakeAway);
  EXPECT_TRUE(run.away(0));
  EXPECT_FALSE(run.away(1));
  EXPECT_EQ(run.tap.lines().hands, (std::vector<HandMove>{{0, 1}}));
  EXPECT_EQ(run.tap.lines().title, "done");
}

TEST(TaskActs, ABodyDoesNotAppearInFluid) {
  lab::SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("tank", lab::tank_at_floor({0.2, 0.15, 0.1}, 0.03));
  b.add_volume(make::box({-0.1, 0.0, -0.05}, {0.1, 0.06, 0.05}));
  b.add_free("block", make::box({-0.025, 0.01, -0.025}, {0.025, 0.05, 0.025}), 1.0);
  b.set_domain({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
  b.scene.bodies[1].starts_away = true;
  Followed run(b.scene);
  const Result<bool> refused = run.world.appear(1);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("fluid is in its place"), std::string::npos)
      << refused.error().text();
  ASSERT_TRUE(run.world.take_away(2));
  EXPECT_TRUE(run.world.appear(1)) << "when the fluid is gone";
}

// The goal that a step's end takes away is reached where nothing is there.
TEST(TaskActs, WhatIsNotThereNeedNotBeTakenAway) {
  Scene scene = ball_and_block();
  scene.bodies[1].pose.position.x = 0.5;
  scene.task = {when_faster(0.2, {{TaskActKind::kTakesAway, 1, -1}, {TaskActKind::kAppears, 1, -1}})};
  Followed run(scene);
  run.until(0.3);
  EXPECT_EQ(run.refused.size(), 1u);
  EXPECT_FALSE(run.away(1));
}

// A host that died carries on with the world as it is, and at the step where it was.
TEST(TaskActs, AWorldThatCarriesOnIsAtTheStepWhereItWas) {
  Scene scene = ball_and_block();
  scene.bodies[1].pose.position.x = 0.5;
  scene.task = {when_faster(0.2, {{TaskActKind::kAppears, 1, -1}}), when_faster(5.0, {}),
                when_faster(100.0, {})};
  Followed run(scene);
  run.until(0.3);
  std::vector<std::uint8_t> saved;
  ASSERT_TRUE(run.world.save(saved));
  const std::vector<double> took = run.tap.took();
  ASSERT_EQ(took.size(), 1u);
  Followed again(scene);
  ASSERT_TRUE(again.world.restore(saved));
  TaskTap tap(again.scene, again.sampled,
              [&](const HostCommand& command, const auto&) { again.asked.push_back(command); });
  tap.carry_on(took);
  tap.on_start(again.world, {});
  EXPECT_EQ(tap.lines().title, "step 2 of 3");
  while (again.world.time() < 0.6) {
    again.world.step({});
    tap.after_step(again.world);
  }
  EXPECT_EQ(tap.lines().title, "step 3 of 3");
  EXPECT_EQ(tap.done()[0].took, took[0]);
  EXPECT_TRUE(again.asked.empty()) << "what the first step brought is there";
}

TEST(TaskActs, ASetBackTaskDoesThemAnew) {
  Scene scene = ball_and_block();
  scene.bodies[1].pose.position.x = 0.5;
  scene.task = {when_faster(0.2, {{TaskActKind::kAppears, 1, -1}}), when_faster(100.0, {})};
  Followed run(scene);
  std::vector<std::uint8_t> start;
  ASSERT_TRUE(run.world.save(start));
  run.until(0.3);
  EXPECT_FALSE(run.away(1));
  ASSERT_TRUE(run.world.restore(start));
  EXPECT_TRUE(run.away(1));
  run.until(0.3);
  EXPECT_FALSE(run.away(1));
  EXPECT_EQ(run.asked.size(), 2u);
}

}  // namespace
}  // namespace slosh
