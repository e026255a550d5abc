// Fixed joints, and joints that let go and close while the world runs, against what mechanics says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "tests/support/linkage.h"

namespace slosh {
namespace {

using testing::add_pendulum;
using testing::frame_along;
using testing::Linkage;
using testing::run_for;
using testing::state_of;

const glm::dvec3 kUp(0, 1, 0);
constexpr double kGravity = 9.81;

// Momentum, and angular momentum about the origin.
Twist momenta_of(const Linkage& link, const BodySnapshot& state) {
  Twist sum;
  for (std::size_t b = 0; b < link.scene.bodies.size(); ++b) {
    const MassProperties& mass = link.scene.bodies[b].mass;
    const BodyState& s = state.bodies[b];
    const glm::dmat3 r = glm::mat3_cast(s.pose.orientation);
    sum.linear += mass.mass * s.twist.linear;
    sum.angular += r * (mass.inertia * (glm::transpose(r) * s.twist.angular)) +
                   glm::cross(s.center_of_mass, mass.mass * s.twist.linear);
  }
  return sum;
}

void expect_same_momenta(const Twist& a, const Twist& b) {
  EXPECT_LT(glm::length(a.linear - b.linear), 1e-12);
  EXPECT_LT(glm::length(a.angular - b.angular), 1e-12);
}

// 2 kg at the end of a bracket of 0.2 m.
Linkage bracket(double breaks_force, double breaks_torque) {
  Linkage link;
  const int body = link.add(2.0, glm::dvec3(0.01), {{0.2, 0.0, 0.0}, {1, 0, 0, 0}});
  Joint& joint = link.join(JointKind::kFixed, body, -1, frame_along(kUp, {0, 0, 0}));
  joint.breaks_force = breaks_force;
  joint.breaks_torque = breaks_torque;
  return link;
}

TEST(FixedJoint, CarriesAWeightByItsForceAndItsTorque) {
  World world = bracket(0.0, 0.0).world();
  run_for(world, 0.5);
  const BodySnapshot state = state_of(world);
  EXPECT_NEAR(glm::distance(state.joints[0].reaction.force, glm::dvec3(0, 2.0 * kGravity, 0)), 0.0, 1e-9);
  EXPECT_NEAR(glm::distance(state.joints[0].reaction.torque, glm::dvec3(0, 0, 0.2 * 2.0 * kGravity)), 0.0,
              1e-9);
  EXPECT_NEAR(glm::distance(state.bodies[0].pose.position, glm::dvec3(0.2, 0, 0)), 0.0, 1e-10);
  EXPECT_TRUE(state.joints[0].joined);
}

TEST(FixedJoint, BreaksAboveWhatItBearsAndNotBelow) {
  constexpr double kForce = 2.0 * kGravity, kTorque = 0.2 * 2.0 * kGravity, kAway = 1e-6;
  const auto falls = [](double force, double torque) {
    World world = bracket(force, torque).world();
    run_for(world, 0.1);
    const BodySnapshot state = state_of(world);
    EXPECT_EQ(state.joints[0].joined, !(state.bodies[0].pose.position.y < -0.04));
    return !state.joints[0].joined;
  };
  EXPECT_FALSE(falls(kForce * (1.0 + kAway), 0.0));
  EXPECT_TRUE(falls(kForce * (1.0 - kAway), 0.0));
  EXPECT_FALSE(falls(0.0, kTorque * (1.0 + kAway)));
  EXPECT_TRUE(falls(0.0, kTorque * (1.0 - kAway)));
}

// A seam of several: they hold one thing several times, and share its weight in a way that statics leaves
// open.
TEST(FixedJoint, SeveralOfOnePairShareItsWeight) {
  for (const double breaks : {0.0, 0.4 * kGravity}) {
    Linkage link;
    const int body = link.add(2.0, glm::dvec3(0.01));
    for (const double x : {-0.1, 0.0, 0.1})
      link.join(JointKind::kFixed, body, -1, {{x, 0.0, 0.0}, {1, 0, 0, 0}}).breaks_force = breaks;
    World world = link.world();
    run_for(world, 0.5);
    const BodySnapshot state = state_of(world);
    if (breaks > 0.0) {
      for (const JointState& joint : state.joints) EXPECT_FALSE(joint.joined);
      continue;
    }
    glm::dvec3 sum(0.0);
    for (const JointState& joint : state.joints) {
      EXPECT_GT(joint.reaction.force.y, 0.1 * 2.0 * kGravity);
      sum += joint.reaction.force;
    }
    EXPECT_NEAR(glm::distance(sum, glm::dvec3(0, 2.0 * kGravity, 0)), 0.0, 1e-6);
    EXPECT_LT(glm::length(state.bodies[0].pose.position), 1e-8);
  }
}

// Of two joints between the same two bodies one may go: they stay one while the other holds.
TEST(FixedJoint, ThatBreaksLeavesAHingeBesideIt) {
  Linkage link;
  add_pendulum(link, 1.0, 0.01, 0.3, 1.0);
  link.join(JointKind::kFixed, 0, -1, {}).breaks_torque = 0.9 * 0.3 * kGravity * std::sin(1.0);
  World world = link.world();
  run_for(world, 0.3);
  const BodySnapshot state = state_of(world);
  EXPECT_FALSE(state.joints[1].joined);
  EXPECT_TRUE(state.joints[0].joined);
  EXPECT_LT(state.joints[0].position, -0.2) << "it swings";
  EXPECT_LT(glm::length(transform_point(state.bodies[0].pose, {0, 0.3, 0})), 1e-9);
}

// A hinge lets go too: at the bottom of its swing a pendulum pulls by its weight and m ω² L.
TEST(Hinge, BreaksByTheSwingOfWhatHangsOnIt) {
  constexpr double kMass = 1.0, kInertia = 0.01, kLength = 0.3, kAngle = 1.0;
  const double square =
      2.0 * kMass * kGravity * kLength * (1.0 - std::cos(kAngle)) / (kInertia + kMass * kLength * kLength);
  const double pull = kMass * (kGravity + square * kLength);
  for (const double share : {0.999, 1.001}) {
    Linkage link;
    add_pendulum(link, kMass, kInertia, kLength, kAngle);
    link.scene.joints[0].breaks_force = share * pull;
    World world = link.world();
    run_for(world, 2.0);
    EXPECT_EQ(state_of(world).joints[0].joined, share > 1.0) << share;
  }
}

// Two that tumble as one, of unlike masses and moments. `apart`: m between the joint and the middle of the
// first.
Linkage dumbbell(const Twist& twist) {
  Linkage link;
  link.scene.gravity = glm::dvec3(0.0);
  const glm::dvec3 first(-0.2, 0.0, 0.0), second(0.3, 0.1, 0.0);
  const glm::dvec3 middle = (1.0 * first + 4.0 * second) * 0.2;
  const auto moving = [&](const glm::dvec3& at) {
    return Twist{twist.linear + glm::cross(twist.angular, at - middle), twist.angular};
  };
  const int a = link.add(1.0, {0.01, 0.02, 0.03}, {first, {1, 0, 0, 0}}, moving(first));
  const int b = link.add(4.0, {0.05, 0.03, 0.02}, {second, {1, 0, 0, 0}}, moving(second));
  link.join(JointKind::kFixed, a, b, frame_along({1, 1, 0}, {0.0, 0.0, 0.05}));
  return link;
}

TEST(FixedJoint, KeepsMomentaAndItsShapeWhileTwoTumbleAsOne) {
  const Linkage link = dumbbell({{0.1, 0.2, 0.3}, {1, 2, 3}});
  World world = link.world();
  const Twist before = momenta_of(link, state_of(world));
  run_for(world, 5.0);
  const BodySnapshot state = state_of(world);
  expect_same_momenta(momenta_of(link, state), before);
  const Pose between = compose(inverse(state.bodies[0].pose), state.bodies[1].pose);
  EXPECT_NEAR(glm::distance(between.position, glm::dvec3(0.5, 0.1, 0.0)), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(between.orientation.w), 1.0, 1e-12);
}

// Spun about z it is held together by μ ω² r.
TEST(FixedJoint, BreaksByTheForceThatTurnsItsTwoBodies) {
  constexpr double kTurning = 10.0;
  const double pull = 1.0 * 4.0 / 5.0 * kTurning * kTurning * std::hypot(0.5, 0.1);
  for (const double share : {0.99, 1.01}) {
    Linkage link = dumbbell({{0.1, 0.2, 0.3}, {0, 0, kTurning}});
    link.scene.joints[0].breaks_force = share * pull;
    World world = link.world();
    const Twist before = momenta_of(link, state_of(world));
    run_for(world, 0.5);
    const BodySnapshot state = state_of(world);
    EXPECT_EQ(state.joints[0].joined, share > 1.0);
    expect_same_momenta(momenta_of(link, state), before);
    if (state.joints[0].joined) continue;
    const double left = glm::distance(state.bodies[0].pose.position, state.bodies[1].pose.position);
    EXPECT_GT(left, 2.0) << "they fly apart along straight lines";
    EXPECT_EQ(glm::length(state.joints[0].reaction.force), 0.0);
  }
}

// Two that come at each other off their centres and spinning, and are one from then on.
Linkage meeting(double speed, double joins_within = 0.002) {
  Linkage link;
  link.scene.gravity = glm::dvec3(0.0);
  const int a =
      link.add(1.0, {0.01, 0.02, 0.03}, {{-0.3, 0.02, 0.01}, {1, 0, 0, 0}}, {{speed, 0, 0}, {0, 0, 0.2}});
  const int b = link.add(4.0, {0.05, 0.03, 0.02}, {{0.3, 0.0, 0.0}, {1, 0, 0, 0}}, {{0, 0, 0}, {0, 0, 0}});
  Joint& joint = link.join(JointKind::kFixed, a, b, {{-0.2, 0.0, 0.0}, {1, 0, 0, 0}});
  joint.starts_apart = true;
  joint.joins_within = joins_within;
  joint.joins_turn = 0.5;
  joint.meets = Pose{{-0.1, 0.1 * 0.2 * 0.4 / speed, 0.0}, {1, 0, 0, 0}};
  return link;
}

TEST(FixedJoint, ClosesWithoutABounceAndKeepsMomenta) {
  for (const double speed : {0.5, 5.0}) {  // fast it comes 5 mm a step, which is more than it closes from
    const Linkage link = meeting(speed);
    World world = link.world();
    const Twist before = momenta_of(link, state_of(world));
    while (!state_of(world).joints[0].joined && world.time() < 2.0) world.step({});
    ASSERT_TRUE(state_of(world).joints[0].joined) << speed;
    const BodySnapshot met = state_of(world);
    expect_same_momenta(momenta_of(link, met), before);
    const Pose held = compose(inverse(met.bodies[0].pose), met.bodies[1].pose);
    run_for(world, 1.0);
    const BodySnapshot state = state_of(world);
    expect_same_momenta(momenta_of(link, state), before);
    EXPECT_TRUE(state.joints[0].joined);
    const Pose now = compose(inverse(state.bodies[0].pose), state.bodies[1].pose);
    EXPECT_NEAR(glm::distance(now.position, held.position), 0.0, 1e-9) << "held as they were";
    EXPECT_NEAR(glm::length(rotation_between(now.orientation, held.orientation)), 0.0, 1e-9);
    EXPECT_NEAR(glm::distance(state.bodies[0].twist.angular, state.bodies[1].twist.angular), 0.0, 1e-3)
        << "velocities are half a step behind";
  }
}

TEST(FixedJoint, DoesNotCloseWhereItsFramesPassFartherOffOrTurned) {
  Linkage past = meeting(0.5, 0.002);
  past.scene.joints[0].meets->position.z += 0.02;
  Linkage turned = meeting(0.5, 0.002);
  turned.scene.joints[0].joins_turn = 1e-3;
  for (const Linkage* link : {&past, &turned}) {
    World world = link->world();
    run_for(world, 2.0);
    EXPECT_FALSE(state_of(world).joints[0].joined);
  }
}

// A head-on meeting takes the energy of the relative motion, ½ μ v².
TEST(FixedJoint, TakesTheEnergyOfAnInelasticBlow) {
  Linkage link = meeting(1.0);
  for (Body& body : link.scene.bodies)
    body.pose.position.y = body.pose.position.z = body.twist.angular.z = 0.0;
  link.scene.joints[0].pose = {{0.1, 0.0, 0.0}, {1, 0, 0, 0}};
  link.scene.joints[0].meets = Pose{{-0.1, 0.0, 0.0}, {1, 0, 0, 0}};
  World world = link.world();
  const double before = testing::energy_of(link.scene, state_of(world));
  run_for(world, 1.0);
  const double lost = before - testing::energy_of(link.scene, state_of(world));
  EXPECT_NEAR(lost, 0.5 * (1.0 * 4.0 / 5.0), 1e-12);
  EXPECT_NEAR(state_of(world).bodies[0].twist.linear.x, 0.2, 1e-12);
}

// What let go closes again only where it may, and only from farther off.
TEST(FixedJoint, ClosesAgainOnlyWhereItSaysFromWhere) {
  for (const double within : {0.0, 5e-4}) {
    Linkage link;
    const int ball = link.add(1.0, glm::dvec3(0.01));
    Joint& joint = link.join(JointKind::kFixed, ball, -1, {});
    joint.breaks_force = 0.9 * kGravity;
    joint.joins_within = within;
    joint.joins_turn = 0.1;
    Grip grip;
    grip.name = "hand";
    grip.body = ball;
    grip.damping = 200.0;
    link.scene.grips.push_back(grip);
    World world = link.world();
    world.step({});
    EXPECT_FALSE(state_of(world).joints[0].joined);
    world.step({});
    world.step({});
    EXPECT_FALSE(state_of(world).joints[0].joined) << "it is still where it would close";
    HandleInput hand;
    hand.engaged = true;
    const auto go = [&](double y) {
      hand.pose.position = {0.0, y, 0.0};
      for (int i = 0; i < 2000; ++i) world.step({&hand, 1});
    };
    go(-0.05);
    EXPECT_FALSE(state_of(world).joints[0].joined);
    go(kGravity / grip.stiffness);  // it hangs where it was
    EXPECT_EQ(state_of(world).joints[0].joined, within > 0.0);
  }
}

TEST(FixedJoint, ASavedWorldKeepsWhatIsBrokenAndItsStartMendsIt) {
  Linkage link = dumbbell({{0.1, 0.2, 0.3}, {0, 0, 10.0}});
  link.scene.joints[0].breaks_force = 1.0;
  const int c = link.add(0.5, glm::dvec3(0.01), {{2, 0, 0}, {1, 0, 0, 0}}, {{-1, 0, 0}, {0, 0, 0}});
  const int d = link.add(0.5, glm::dvec3(0.01), {{1.5, 0.001, 0}, {1, 0, 0, 0}});
  Joint& catches = link.join(JointKind::kFixed, c, d, {{2, 0, 0}, {1, 0, 0, 0}});
  catches.starts_apart = true;
  catches.joins_within = 0.01;
  catches.joins_turn = 0.1;
  catches.meets = Pose{};
  World world = link.world();
  std::vector<std::uint8_t> at_start, saved;
  ASSERT_TRUE(world.save(at_start));
  run_for(world, 0.7);
  EXPECT_FALSE(state_of(world).joints[0].joined);
  EXPECT_TRUE(state_of(world).joints[1].joined);
  ASSERT_TRUE(world.save(saved));
  World other = link.world();
  const Result<bool> restored = other.restore(saved);
  ASSERT_TRUE(restored) << restored.error().text();
  EXPECT_FALSE(state_of(other).joints[0].joined);
  EXPECT_TRUE(state_of(other).joints[1].joined);
  run_for(world, 0.5);
  run_for(other, 0.5);
  EXPECT_EQ(world.hash(), other.hash());
  ASSERT_TRUE(other.restore(at_start));
  EXPECT_TRUE(state_of(other).joints[0].joined);
  EXPECT_FALSE(state_of(other).joints[1].joined);
  run_for(other, 1.2);
  EXPECT_EQ(world.hash(), other.hash()) << "the run from its start once more";

  link.scene.joints[0].breaks_force = 2.0;
  World changed = link.world();
  EXPECT_FALSE(changed.restore(saved)) << "of another scene";
}

// Version 7 had no word of it: what is joined in the scene was.
TEST(FixedJoint, AWorldSavedBeforeJointsBrokeIsRead) {
  Linkage link;
  add_pendulum(link, 1.0, 0.01, 0.3, 1.0);
  World world = link.world();
  run_for(world, 0.2);
  std::vector<std::uint8_t> saved;
  ASSERT_TRUE(world.save(saved));
  // Of its one joint the byte that says whether it holds, 0, and the pose that a fixed one would hold, none.
  std::vector<std::uint8_t> added(1 + 7 * sizeof(double), 0);
  const double one = 1.0;
  std::memcpy(added.data() + 1 + 3 * sizeof(double), &one, sizeof one);
  const auto at = std::find_end(saved.begin(), saved.end(), added.begin(), added.end());
  ASSERT_NE(at, saved.end());
  saved.erase(at, at + static_cast<std::ptrdiff_t>(added.size()));
  // The number of waiting particles behind what does not move, tick, status, gravity, age and the broken.
  constexpr std::ptrdiff_t kWaiting = 2 * 4 + 10 * 8 + 8 + 4 + 8 + 8 + 8;
  saved.erase(saved.begin() + kWaiting, saved.begin() + kWaiting + 8);
  saved[sizeof(std::uint32_t)] = 7;
  World other = link.world();
  const Result<bool> restored = other.restore(saved);
  ASSERT_TRUE(restored) << restored.error().text();
  EXPECT_TRUE(state_of(other).joints[0].joined);
  run_for(world, 0.3);
  run_for(other, 0.3);
  EXPECT_EQ(world.hash(), other.hash());
}

}  // namespace
}  // namespace slosh
