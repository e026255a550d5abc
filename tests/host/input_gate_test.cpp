// Which poses the gate lets through.
#include <gtest/gtest.h>

#include <limits>
#include <span>

#include "tests/host/input_gate_kit.h"

namespace slosh {
namespace {

TEST(InputGate, RefusesWhatIsNoPose) {
  InputGate gate(scene_with_grips(1));
  PoseMessage m = message(0);
  m.pose.position.y = kNaN;
  EXPECT_FALSE(gate.accept(m));
  EXPECT_EQ(gate.last_fault(), PoseFault::kNonFinite);
  m = message(0);
  m.pose.orientation.z = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(gate.accept(m));
  m = message(0);
  m.twist.angular.x = kNaN;
  EXPECT_FALSE(gate.accept(m));
  m = message(0);
  m.time = kNaN;
  EXPECT_FALSE(gate.accept(m));
  m = message(0);
  m.energy = kNaN;  // it would go to everybody who holds the body
  EXPECT_FALSE(gate.accept(m));
  EXPECT_EQ(gate.last_fault(), PoseFault::kNonFinite);
  m = message(0);
  m.pose.orientation = glm::dquat(0, 0, 0, 0);
  EXPECT_FALSE(gate.accept(m));
  EXPECT_EQ(gate.last_fault(), PoseFault::kNotARotation);
  m = message(0, 100.0);
  EXPECT_FALSE(gate.accept(m));
  EXPECT_EQ(gate.last_fault(), PoseFault::kOutOfRange);
  m = message(0);
  m.twist.linear.z = 2.0 * kHandleSpeed;
  EXPECT_FALSE(gate.accept(m));
  EXPECT_EQ(gate.last_fault(), PoseFault::kTooFast);
  EXPECT_FALSE(gate.accept(message(7))) << "no such device";
  EXPECT_EQ(gate.rejected(), 9u);
  EXPECT_TRUE(gate.accept(message(0)));
}

TEST(InputGate, KeepsTheLastGoodPoseStandingStill) {
  const Scene scene = scene_with_grips(1);
  InputGate gate(scene);
  Channel channel(1, BodyMessage{}, 1 << 20);
  BodySnapshot now;
  now.grips.resize(1);
  now.grips[0].pose.position.x = 0.25;  // the grip moves with the hand
  now.grips[0].twist.linear.x = 1.0;

  PoseMessage m = message(0, 0.25);
  m.twist.linear.x = 1.0;
  tell(channel, m);
  EXPECT_EQ(gate.take(channel, now)[0].twist.linear.x, 1.0);

  m.pose.position.x = kNaN;
  tell(channel, m);
  const HandleInput held = gate.take(channel, now)[0];
  EXPECT_EQ(held.pose.position.x, 0.25);
  EXPECT_EQ(held.twist.linear.x, 0.0);
  EXPECT_TRUE(held.engaged);
  EXPECT_EQ(gate.rejected(), 1u);
}

TEST(InputGate, AJumpIsRefusedUntilItCouldHaveBeenTravelled) {
  InputGate gate(scene_with_grips(1));
  EXPECT_TRUE(gate.accept(message(0, 0.0, 0)));
  EXPECT_FALSE(gate.accept(message(0, 0.9, 1'000'000))) << "0.9 m in a millisecond";
  EXPECT_EQ(gate.last_fault(), PoseFault::kTooFast);
  EXPECT_TRUE(gate.accept(message(0, 0.9, 100'000'000))) << "0.9 m in 0.1 s";
}

TEST(InputGate, NormalisesASlightlyOffQuaternion) {
  const Scene scene = scene_with_grips(1);
  InputGate gate(scene);
  Channel channel(1, BodyMessage{}, 1 << 20);
  BodySnapshot now;
  now.grips.resize(1);
  PoseMessage m = message(0);
  m.pose.orientation = glm::dquat(1.005, 0, 0, 0);
  tell(channel, m);
  EXPECT_DOUBLE_EQ(glm::length(gate.take(channel, now)[0].pose.orientation), 1.0);
}

TEST(InputGate, EachDeviceKeepsItsPlace) {
  const Scene scene = scene_with_grips(3);
  InputGate gate(scene);
  Channel channel(3, BodyMessage{}, 1 << 20);
  BodySnapshot now;
  now.grips.resize(3);
  now.grips[2].pose.position.x = 0.5;
  tell(channel, message(2, 0.5));
  const std::span<const HandleInput> input = gate.take(channel, now);
  ASSERT_EQ(input.size(), 3u);
  EXPECT_FALSE(input[0].engaged);
  EXPECT_FALSE(input[1].engaged);
  EXPECT_EQ(input[0].scale, 0.0);
  EXPECT_TRUE(input[2].engaged);
  EXPECT_EQ(input[2].pose.position.x, 0.5);
}

/// The start was settled into both: who holds one of them alone gets all of the weight, and not at once.
TEST(InputGate, AfterAResetAGripThatNobodyHoldsGivesItsShareOver) {
  const Scene scene = scene_with_grips(2);
  Channel channel(2, BodyMessage{}, 1000);
  InputGate gate(scene);
  BodySnapshot now = snapshot_with_grips(2);
  ASSERT_TRUE(gate.accept(message(0), 0));
  EXPECT_FALSE(gate.take(channel, now, 0)[1].engaged);
  for (GripState& grip : now.grips) grip.on_hand.force = {0.0, -10.0, 0.0};
  gate.reset(now, 0);
  double before = 1.0 + 1e-9;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    now.time = share * kHandOver;
    const HandleInput beside = gate.take(channel, now, 0)[1];
    EXPECT_EQ(beside.engaged, share < 1.0) << share;
    EXPECT_NEAR(beside.scale, 1.0 - share, 1e-9);
    EXPECT_LT(beside.scale, before);
    before = beside.scale;
  }
  // What carried nothing in it holds nothing.
  now.grips[1].on_hand = {};
  gate.reset(now, 0);
  EXPECT_FALSE(gate.take(channel, now, 0)[1].engaged);
}

}  // namespace
}  // namespace slosh
