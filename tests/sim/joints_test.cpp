// Hinges, sliders, motors and driven bodies against what mechanics says.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/bodies/skyline.h"
#include "tests/support/linkage.h"

namespace slosh {
namespace {

using testing::add_pendulum;
using testing::frame_along;
using testing::Linkage;
using testing::run_for;
using testing::state_of;

const glm::dvec3 kAlongZ(0, 0, 1);
constexpr double kG = 9.81;

TEST(Skyline, SolvesWhatItFactored) {
  Skyline matrix;
  matrix.clear(3);
  const double a[3][3] = {{4, 0, 1}, {0, 5, 2}, {1, 2, 6}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      if (a[i][j] != 0.0) matrix.add(i, j, a[i][j]);
  ASSERT_TRUE(matrix.factor());
  std::vector<double> x{7, 16, 23};
  matrix.solve(x);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(x[i], static_cast<double>(i) + 1.0, 1e-12);
  matrix.clear(1);
  matrix.add(0, 0, -1.0);
  EXPECT_FALSE(matrix.factor());
}

TEST(Joints, ArePlannedWhereThereAreAny) {
  Linkage link;
  link.add(1.0, glm::dvec3(0.1));
  EXPECT_FALSE(make_plan(link.scene, 0.01).has(PassId::kJoints));
  link.join(JointKind::kHinge, 0, -1, frame_along(kAlongZ, {0, 0.1, 0}));
  EXPECT_TRUE(make_plan(link.scene, 0.01).has(PassId::kJoints));
}

TEST(Joints, AtRestTheReactionIsTheWeight) {
  Linkage link;
  const int body = link.add(2.0, glm::dvec3(0.01), {{0.2, 0.0, 0.0}, {1, 0, 0, 0}});
  Joint& joint = link.join(JointKind::kHinge, body, -1, frame_along(kAlongZ, {0, 0, 0}));
  joint.lower = joint.upper = 0.0;
  World world = link.world();
  run_for(world, 0.5);
  const BodySnapshot state = state_of(world);
  ASSERT_EQ(state.joints.size(), 1u);
  EXPECT_NEAR(state.joints[0].position, 0.0, 1e-9);
  EXPECT_NEAR(glm::distance(state.joints[0].reaction.force, glm::dvec3(0, 2.0 * kG, 0)), 0.0, 1e-8);
  // About the hinge the weight turns by 0.2 m · m g, which the stop takes.
  EXPECT_NEAR(glm::distance(state.joints[0].reaction.torque, glm::dvec3(0, 0, 0.2 * 2.0 * kG)), 0.0, 1e-8);
}

TEST(Joints, StopHoldsAPendulum) {
  Linkage link;
  add_pendulum(link, 1.0, 0.01, 0.3, 1.0);
  link.scene.joints[0].lower = -1.2;
  World world = link.world();
  double lowest = 0.0;
  for (int i = 0; i < 4000; ++i) {
    world.step({});
    lowest = std::min(lowest, state_of(world).joints[0].position);
  }
  EXPECT_NEAR(lowest, -1.2, 1e-4) << "it falls to the stop, and no further";
}

TEST(Joints, SliderGoesDownAnInclineByItsSine) {
  constexpr double kSlope = 0.4;  // rad
  Linkage link;
  const int body =
      link.add(3.0, {0.01, 0.02, 0.03}, {{0.1, 0.2, 0.3}, glm::angleAxis(0.7, glm::dvec3(1, 0, 0))});
  const glm::dvec3 down(std::cos(kSlope), -std::sin(kSlope), 0.0);
  link.join(JointKind::kSlider, body, -1, frame_along(down, {0.0, 0.5, 0.0}));
  World world = link.world();
  run_for(world, 1.0);
  const BodySnapshot state = state_of(world);
  EXPECT_NEAR(state.joints[0].speed, kG * std::sin(kSlope), 1e-9);
  EXPECT_NEAR(state.joints[0].position, 0.5 * kG * std::sin(kSlope), 3e-3) << "half a step is 2 mm of it";
  EXPECT_NEAR(glm::length(state.bodies[0].twist.angular), 0.0, 1e-9);
  EXPECT_NEAR(glm::length(state.joints[0].reaction.force), 3.0 * kG * std::cos(kSlope), 1e-6);
}

TEST(Joints, MotorTurnsByItsTorqueUpToItsSpeed) {
  constexpr double kInertia = 0.05, kTorque = 0.2, kSpeed = 3.0;
  Linkage link;
  link.scene.gravity = glm::dvec3(0.0);
  const int wheel = link.add(1.0, glm::dvec3(kInertia));
  Joint& joint = link.join(JointKind::kHinge, wheel, -1, frame_along(kAlongZ, {0, 0, 0}));
  joint.motor_speed = kSpeed;
  joint.motor_limit = kTorque;
  World world = link.world();
  run_for(world, 0.5);
  EXPECT_NEAR(state_of(world).joints[0].speed, 0.5 * kTorque / kInertia, 1e-9);
  EXPECT_NEAR(state_of(world).joints[0].motor, kTorque, 1e-12);
  run_for(world, 0.5);
  EXPECT_NEAR(state_of(world).joints[0].speed, kSpeed, 1e-9);
  EXPECT_NEAR(state_of(world).joints[0].motor, 0.0, 1e-9);
  run_for(world, 10.0);
  EXPECT_NEAR(state_of(world).joints[0].position, kSpeed * 11.0 - 0.5 * kSpeed * kSpeed * kInertia / kTorque,
              5e-3)
      << "whole turns are counted";
}

TEST(Joints, DamperTakesASpeedAwayByItsTime) {
  Linkage link;
  link.scene.gravity = glm::dvec3(0.0);
  const int wheel = link.add(1.0, glm::dvec3(0.05), {}, {{}, {0, 0, 2.0}});
  link.join(JointKind::kHinge, wheel, -1, frame_along(kAlongZ, {0, 0, 0})).damping = 0.1;
  World world = link.world();
  run_for(world, 0.5);
  EXPECT_NEAR(state_of(world).joints[0].speed, 2.0 * std::exp(-1.0), 2e-3);
}

// Nothing from outside: momentum and angular momentum about the origin stay to rounding.
TEST(Joints, TwoBodiesInSpaceKeepTheirMomenta) {
  for (const JointKind kind : {JointKind::kHinge, JointKind::kSlider}) {
    Linkage link;
    link.scene.gravity = glm::dvec3(0.0);
    const int a = link.add(1.0, {0.01, 0.02, 0.03}, {{-0.2, 0.0, 0.0}, {1, 0, 0, 0}}, {{0, 1, 0}, {1, 2, 3}});
    const int b =
        link.add(4.0, {0.05, 0.03, 0.02}, {{0.3, 0.1, 0.0}, {1, 0, 0, 0}}, {{1, 0, 0.5}, {-2, 1, 0}});
    Joint& joint = link.join(kind, a, b, frame_along({1, 1, 0}, {0.0, 0.0, 0.05}));
    joint.motor_speed = 1.0;
    joint.motor_limit = 0.02;
    World world = link.world();
    const auto momenta = [&] {
      const BodySnapshot state = state_of(world);
      Twist sum;
      for (int body : {a, b}) {
        const MassProperties& mass = link.scene.bodies[body].mass;
        const BodyState& s = state.bodies[body];
        const glm::dmat3 r = glm::mat3_cast(s.pose.orientation);
        sum.linear += mass.mass * s.twist.linear;
        sum.angular += r * (mass.inertia * (glm::transpose(r) * s.twist.angular)) +
                       glm::cross(s.center_of_mass, mass.mass * s.twist.linear);
      }
      return sum;
    };
    world.step({});
    const Twist first = momenta();
    EXPECT_NEAR(glm::length(first.linear - glm::dvec3(4, 1, 2)), 0.0, 1e-12);
    run_for(world, 5.0);
    EXPECT_NEAR(glm::length(momenta().linear - first.linear), 0.0, 1e-11);
    EXPECT_NEAR(glm::length(momenta().angular - first.angular), 0.0, 1e-11);
  }
}

// An off-centre rotor that turns by a radian in a step keeps its hinge and gains nothing; a pendulum beside
// it does not even notice.
TEST(Joints, AFastRotorDisturbsNobodyElse) {
  Linkage both, alone;
  for (Linkage* link : {&both, &alone}) {
    link->time_step = 0.004;
    add_pendulum(*link, 1.0, 0.01, 0.3, 1.0);
  }
  const Twist spin{glm::cross(250.0 * kAlongZ, glm::dvec3(0.05, 0, 0)), 250.0 * kAlongZ};
  const int rotor = both.add(0.2, glm::dvec3(1e-4), {{2.05, 0, 0}, {1, 0, 0, 0}}, spin);
  both.join(JointKind::kHinge, rotor, -1, frame_along(kAlongZ, {2, 0, 0}));
  World with = both.world(), without = alone.world();
  for (int i = 0; i < 1000; ++i) {
    with.step({});
    without.step({});
    const BodyState state = state_of(with).bodies[static_cast<std::size_t>(rotor)];
    ASSERT_LT(glm::distance(transform_point(state.pose, {-0.05, 0, 0}), glm::dvec3(2, 0, 0)), 1e-6) << i;
    ASSERT_LT(state.twist.angular.z, 260.0) << i;
  }
  EXPECT_NEAR(state_of(with).joints[0].position, state_of(without).joints[0].position, 1e-9);
}

// What hangs on a held body by joints takes part in a settling, and nothing else does.
TEST(Joints, SettleWithTheHandThatHoldsOneOfThem) {
  Linkage link;
  const int upper = link.add(0.5, glm::dvec3(0.01), {{0.0, -0.1, 0.0}, {1, 0, 0, 0}});
  const int lower = link.add(0.5, glm::dvec3(0.01), {{0.0, -0.3, 0.0}, {1, 0, 0, 0}});
  const int alone = link.add(0.5, glm::dvec3(0.01), {{0.5, -0.3, 0.1}, {1, 0, 0, 0}});
  link.join(JointKind::kHinge, upper, -1, frame_along(kAlongZ, {0, 0, 0}));
  link.join(JointKind::kHinge, lower, upper, frame_along(kAlongZ, {0, -0.2, 0}));
  link.join(JointKind::kHinge, alone, -1, frame_along(kAlongZ, {0.4, 0, 0}));
  Grip grip;
  grip.name = "hand";
  grip.body = lower;
  grip.stiffness = 1e4;
  grip.rotational_stiffness = 0.0;
  link.scene.grips.push_back(grip);
  World world = link.world();
  HandleInput hand;
  hand.engaged = true;
  hand.pose.position = {0.1, -0.25, 0.0};
  world.settle(2.0, {&hand, 1});
  const BodySnapshot state = state_of(world);
  EXPECT_NEAR(glm::distance(state.bodies[1].pose.position, hand.pose.position), 0.0, 2e-3);
  EXPECT_NEAR(glm::distance(transform_point(state.bodies[1].pose, {0, 0.1, 0}),
                            transform_point(state.bodies[0].pose, {0, -0.1, 0})),
              0.0, 1e-8);
  EXPECT_EQ(state.bodies[static_cast<std::size_t>(alone)].pose.position, glm::dvec3(0.5, -0.3, 0.1));
}

TEST(Joints, ALoopOfFourBarsHoldsTogether) {
  Linkage link;
  const auto bar = [&](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 along = to - from;
    return link.add(1.0, glm::dvec3(0.01),
                    {0.5 * (from + to), glm::angleAxis(std::atan2(along.y, along.x), kAlongZ)});
  };
  const glm::dvec3 p(0, 0, 0), q(0.1, 0.3, 0), r(0.5, 0.35, 0), s(0.5, 0, 0);
  const int crank = bar(p, q), coupler = bar(q, r), rocker = bar(r, s);
  link.join(JointKind::kHinge, crank, -1, frame_along(kAlongZ, p));
  link.join(JointKind::kHinge, crank, coupler, frame_along(kAlongZ, q));
  link.join(JointKind::kHinge, coupler, rocker, frame_along(kAlongZ, r));
  link.join(JointKind::kHinge, rocker, -1, frame_along(kAlongZ, s));
  World world = link.world();
  const double energy = testing::energy_of(link.scene, state_of(world));
  run_for(world, 5.0);
  const BodySnapshot state = state_of(world);
  const auto end = [&](int body, double side) {
    return transform_point(state.bodies[static_cast<std::size_t>(body)].pose, glm::dvec3(side, 0, 0));
  };
  const double half = 0.5 * glm::distance(p, q), coupled = 0.5 * glm::distance(q, r);
  EXPECT_NEAR(glm::distance(end(crank, half), end(coupler, -coupled)), 0.0, 1e-8);
  EXPECT_NEAR(glm::distance(end(crank, -half), p), 0.0, 1e-8);
  EXPECT_LT(std::abs(testing::energy_of(link.scene, state) - energy), 0.05) << "of 6 J that go to and fro";
}

TEST(Joints, ASavedWorldGoesOnBitwise) {
  Linkage link;
  const int first = add_pendulum(link, 1.0, 0.01, 0.3, 2.0);
  const glm::dquat turn = link.scene.bodies[0].pose.orientation;
  const glm::dvec3 end = turn * glm::dvec3(0, -0.6, 0);
  const int second = link.add(0.5, {0.01, 0.002, 0.01}, {end + glm::dvec3(0.2, 0, 0), {1, 0, 0, 0}});
  Joint& joint = link.join(JointKind::kHinge, second, first, frame_along(kAlongZ, end));
  joint.motor_speed = 20.0;
  joint.motor_limit = 0.3;
  joint.upper = 7.0;
  const glm::dquat half = glm::angleAxis(1.0, kAlongZ);
  const int driven = link.add_driven({{0.0, {}}, {0.4, {{0.1, 0, 0}, half}}, {1.0, {}}}, true);
  const int hung = link.add(0.2, glm::dvec3(0.01), {{0.0, -0.3, 0.0}, {1, 0, 0, 0}});
  link.join(JointKind::kSlider, hung, driven, frame_along({1, 0, 0}, {0, 0, 0})).damping = 0.1;
  World world = link.world();
  run_for(world, 0.7);
  std::vector<std::uint8_t> saved;
  ASSERT_TRUE(world.save(saved));
  World other = link.world();
  const Result<bool> restored = other.restore(saved);
  ASSERT_TRUE(restored) << restored.error().text();
  const BodySnapshot here = state_of(world), there = state_of(other);
  for (std::size_t j = 0; j < here.joints.size(); ++j) {
    EXPECT_EQ(here.joints[j].position, there.joints[j].position);
    EXPECT_EQ(here.joints[j].motor, there.joints[j].motor);
    EXPECT_EQ(here.joints[j].reaction.force, there.joints[j].reaction.force);
  }
  run_for(world, 0.9);
  run_for(other, 0.9);
  EXPECT_EQ(world.hash(), other.hash());
  EXPECT_EQ(state_of(world).joints[1].position, state_of(other).joints[1].position);
  EXPECT_GT(state_of(world).joints[1].position, 3.5) << "it has gone round by then";

  link.scene.joints[1].motor_limit = 0.4;
  World changed = link.world();
  EXPECT_FALSE(changed.restore(saved)) << "of another scene";
}

}  // namespace
}  // namespace slosh
