// Bodies that go by their keys: where they are, what they do to fluid, what they take along.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/step_limits.h"
#include "tests/support/linkage.h"
#include "tests/support/stirred_tank.h"

namespace slosh {
namespace {

using testing::frame_along;
using testing::Linkage;
using testing::run_for;
using testing::state_of;

TEST(DrivenBody, IsWhereItsKeysSayAtEachKey) {
  Linkage link;
  link.time_step = 1.0 / 240.0;
  std::vector<PoseKey> keys;
  for (int k = 0; k <= 60; ++k) {
    const double t = k / 60.0;
    keys.push_back({t,
                    {{0.3 * std::sin(3.0 * t), 0.1 * t, 0.0},
                     glm::angleAxis(4.0 * t, glm::normalize(glm::dvec3(1.0, 2.0, t)))}});
  }
  link.add_driven(keys);
  World world = link.world();
  for (int k = 1; k <= 60; ++k) {
    for (int i = 0; i < 4; ++i) world.step({});
    const Pose pose = state_of(world).bodies[0].pose;
    EXPECT_NEAR(glm::distance(pose.position, keys[k].pose.position), 0.0, 1e-12) << k;
    EXPECT_NEAR(glm::length(rotation_between(pose.orientation, keys[k].pose.orientation)), 0.0, 1e-10) << k;
  }
  EXPECT_NEAR(state_of(world).bodies[0].twist.linear.y, 0.1, 1e-9);
  run_for(world, 0.5);
  EXPECT_EQ(state_of(world).bodies[0].twist.linear, glm::dvec3(0.0)) << "after its last key it stands";
}

TEST(DrivenBody, BeginsAgainWhereItRepeats) {
  Linkage link;
  link.time_step = 1e-2;
  link.add_driven({{0.0, {}}, {0.5, {{1, 0, 0}, {1, 0, 0, 0}}}, {1.0, {}}}, true);
  World world = link.world();
  run_for(world, 7.25);
  EXPECT_NEAR(state_of(world).bodies[0].pose.position.x, 0.5, 1e-9);
  EXPECT_NEAR(state_of(world).bodies[0].twist.linear.x, 2.0, 1e-6);
}

TEST(DrivenBody, StandsWhileASceneSettles) {
  Linkage link;
  link.add_driven({{0.0, {}}, {1.0, {{1, 0, 0}, {1, 0, 0, 0}}}});
  World world = link.world();
  world.settle(0.2);
  EXPECT_EQ(state_of(world).bodies[0].pose.position, glm::dvec3(0.0));
  run_for(world, 0.1);
  EXPECT_NEAR(state_of(world).bodies[0].pose.position.x, 0.1, 1e-12);
}

TEST(DrivenBody, IsReckonedAsFastAsWhatIsFarthestFromItsAxis) {
  const auto speed_about = [](const glm::dvec3& axis) {
    Scene scene;
    scene.meshes.emplace_back().positions = {{-0.02f, -0.5f, -0.02f}, {0.02f, 0.5f, 0.02f}};
    Body& body = scene.bodies.emplace_back();
    body.mesh = 0;
    body.motion = BodyMotion::kDriven;
    const glm::dquat lies = glm::angleAxis(1.1, glm::dvec3(1, 0, 0));
    for (int k = 0; k < 3; ++k) body.keys.push_back({0.1 * k, {{}, lies * glm::angleAxis(0.2 * k, axis)}});
    return driven_speed(scene);
  };
  EXPECT_NEAR(speed_about({0, 1, 0}), 2.0 * std::hypot(0.02, 0.02), 1e-6) << "a screw about its length";
  EXPECT_NEAR(speed_about({0, 0, 1}), 2.0 * std::hypot(0.02, 0.5), 1e-6) << "end over end";
}

// The paddle of a tank, driven: what it does to the fluid it is told.
testing::Tank driven_tank(ParticleModel model) {
  testing::Tank tank = testing::stirred_tank();
  tank.scene.model = model;
  tank.scene.grips.clear();
  Body& paddle = tank.scene.bodies[1];
  paddle.motion = BodyMotion::kDriven;
  paddle.measured = true;
  for (int k = 0; k <= 30; ++k) {
    const Pose at = testing::paddle_hand(k / 60.0).pose;
    paddle.keys.push_back({k / 60.0, {at.position, glm::angleAxis(0.05 * k, glm::dvec3(0, 1, 0))}});
  }
  paddle.pose = paddle.keys.front().pose;
  return tank;
}

TEST(DrivenBody, FluidAndWrenchesBalanceInEachModel) {
  for (const ParticleModel model : {ParticleModel::kCorrected, ParticleModel::kIncompressible}) {
    for (const double viscosity : {0.05, 20.0}) {  // explicit, implicit
      testing::Tank tank = driven_tank(model);
      for (Fluid& fluid : tank.scene.fluids) fluid.dynamic_viscosity = viscosity;
      for (Body& body : tank.scene.bodies) body.dynamic_viscosity = kFluidsViscosity;
      World world = testing::world_of(tank, 2);
      EXPECT_EQ(world.plan().has(PassId::kImplicitViscosity), viscosity > 1.0);
      EXPECT_FALSE(world.plan().has(PassId::kSolveBodies));
      const double dt = world.plan().time_step, weight = world.diagnostics().mass * 9.81;
      for (int i = 0; i < 60; ++i) {
        const glm::dvec3 before = world.diagnostics().momentum;
        world.step({});
        const BodySnapshot state = state_of(world);
        const glm::dvec3 change = world.diagnostics().momentum - before;
        const glm::dvec3 force =
            weight * glm::dvec3(0, -1, 0) - state.bodies[0].fluid.force - state.bodies[1].fluid.force;
        ASSERT_LE(glm::length(change - dt * force), 2e-4 * weight * dt) << "step " << i;
      }
      EXPECT_GT(glm::length(state_of(world).bodies[1].fluid.force), 1e-3) << "it feels the fluid";
    }
  }
}

TEST(DrivenBody, IsTheSameWhateverTheThreadsAndFromASavedWorld) {
  const testing::Tank tank = driven_tank(ParticleModel::kCorrected);
  World one = testing::world_of(tank, 1), three = testing::world_of(tank, 3);
  for (int i = 0; i < 40; ++i) {
    one.step({});
    three.step({});
  }
  EXPECT_EQ(one.hash(), three.hash());
  std::vector<std::uint8_t> saved;
  ASSERT_TRUE(one.save(saved));
  World other = testing::world_of(tank, 2);
  ASSERT_TRUE(other.restore(saved));
  for (int i = 0; i < 40; ++i) {
    one.step({});
    other.step({});
  }
  EXPECT_EQ(one.hash(), other.hash());
}

// It takes along what hangs on it: a hinge's other side.
TEST(DrivenBody, CarriesWhatIsJoinedToIt) {
  Linkage link;
  const int driven = link.add_driven({{0.0, {}}, {2.0, {{4, 0, 0}, {1, 0, 0, 0}}}});
  const int hung = link.add(1.0, glm::dvec3(0.01), {{0, -0.3, 0}, {1, 0, 0, 0}});
  link.join(JointKind::kHinge, hung, driven, frame_along({0, 0, 1}, {0, 0, 0})).damping = 0.5;
  World world = link.world();
  run_for(world, 1.9);
  const Pose pose = state_of(world).bodies[static_cast<std::size_t>(hung)].pose;
  EXPECT_NEAR(glm::distance(transform_point(pose, {0, 0.3, 0}), glm::dvec3(3.8, 0, 0)), 0.0, 1e-9);
}

}  // namespace
}  // namespace slosh
