// Taking hold, letting go and silence at the gate: no blow from any of them.
#include <gtest/gtest.h>

#include <limits>
#include <span>

#include "tests/host/input_gate_kit.h"

namespace slosh {
namespace {

/// What the coupling of a step pulls at the hand with.
double pull(const HandleInput& input, const GripState& grip, const Grip& of) {
  const CouplingGains gains{of.stiffness, of.damping, of.rotational_stiffness, of.rotational_damping};
  return input.scale *
         glm::length(coupling_wrench_on_hand(gains, input.pose, input.twist, grip.pose, grip.twist).force);
}

TEST(InputGate, AGripThatIsTakenFarFromTheBodyIsLetInSlowly) {
  Scene scene = scene_with_grips(2);
  scene.grips[1].body = 1;  // nobody else holds what it takes
  InputGate gate(scene);
  Channel channel(2, BodyMessage{}, 1 << 20);
  BodySnapshot now = snapshot_with_grips(2);
  tell(channel, message(0, 0.001));  // on the grip
  tell(channel, message(1, 0.30));   // 300 N away from it
  std::span<const HandleInput> input = gate.take(channel, now);
  EXPECT_EQ(input[0].pose.position.x, 0.001);
  EXPECT_NEAR(pull(input[1], now.grips[1], scene.grips[1]), 0.0, 1e-9);
  double before = input[1].pose.position.x;
  for (int i = 1; i < 10000; ++i) {
    now.time = 0.001 * i;
    input = gate.take(channel, now);
    EXPECT_LE(input[1].pose.position.x - before, 0.001 * kRampSpeed + 1e-9);
    before = input[1].pose.position.x;
  }
  EXPECT_EQ(before, 0.30);
}

// A hand that held on while its body was away takes hold of it where that comes, and is not tied to nowhere.
TEST(InputGate, ABodyThatComesIsTakenHoldOfWhereItIs) {
  const Scene scene = scene_with_grips(1);
  InputGate gate(scene);
  Channel channel(1, BodyMessage{}, 1000);
  BodySnapshot now = snapshot_with_grips(1);
  now.grips[0].pose.position = glm::dvec3(kAway);
  tell(channel, message(0, 0.30));
  for (int i = 0; i < 100; ++i) {
    now.time = 0.001 * i;
    EXPECT_FALSE(gate.take(channel, now)[0].engaged);
  }
  now.grips[0].pose = {};
  for (int i = 0; i < 100; ++i) {
    now.time = 0.1 + 0.001 * i;
    const HandleInput input = gate.take(channel, now)[0];
    EXPECT_TRUE(input.engaged);
    EXPECT_LE(input.pose.position.x, 0.001 * kRampSpeed * (i + 1) + 1e-9);
  }
}

/// A hand that holds quietly, then is elsewhere: 0.2 m and 200 N away.
struct MovedHand {
  Scene scene = scene_with_grips(1);
  Channel channel{1, BodyMessage{}, 1000};
  InputGate gate{scene};
  BodySnapshot now = snapshot_with_grips(1);
  std::int64_t clock = 1'000'000'000;

  MovedHand() {
    say(0.0);
    EXPECT_EQ(step(), 0.0);
  }
  void say(double x, std::uint32_t hold = 0) {
    PoseMessage m = message(0, x, clock);
    m.hold = hold;
    tell(channel, m);
  }
  double step() {
    now.time += 0.001;
    clock += 1'000'000;
    return pull(gate.take(channel, now, clock)[0], now.grips[0], scene.grips[0]);
  }
};

TEST(InputGate, AHandThatWasNotHeardForLongTakesHoldAnew) {
  MovedHand hand;
  for (int i = 0; i < 150; ++i) hand.step();
  hand.say(0.2);
  EXPECT_LT(hand.step(), 1.0);
  EXPECT_TRUE(hand.gate.rejected() == 0);

  MovedHand late;
  for (int i = 0; i < 30; ++i) late.step();
  late.say(0.02);
  EXPECT_NEAR(late.step(), 20.0, 1.0) << "30 ms are a late datagram, and the hand has pulled";
}

TEST(InputGate, AHandThatIsSuddenlyElsewhereTakesHoldAnew) {
  for (const int late : {5, 30, 90}) {  // ms
    MovedHand hand;
    for (int i = 0; i < late; ++i) hand.step();
    hand.say(0.2);
    for (int i = 0; i < 20; ++i) EXPECT_LT(hand.step(), 2.0) << "200 N by the spring";
  }
  // Kept back by a link: read long apart, and coming at once.
  MovedHand hand;
  hand.clock += 80'000'000;
  hand.say(0.001);
  hand.step();
  hand.clock += 1'000'000;
  PoseMessage m = message(0, 0.2, hand.clock + 800'000'000);
  tell(hand.channel, m);
  EXPECT_LT(hand.step(), 2.0);
  EXPECT_EQ(hand.gate.rejected(), 0u);
}

TEST(InputGate, AfterAPauseAHandTakesHoldWhereItIs) {
  MovedHand hand;
  hand.clock += 5'000'000'000;
  hand.say(0.2);
  hand.gate.stood_still();
  EXPECT_LT(hand.step(), 1.0);
}

TEST(InputGate, AnotherHandMayBeAnywhere) {
  MovedHand hand;
  hand.say(0.2, 1);
  EXPECT_LT(hand.step(), 1.0);
  EXPECT_EQ(hand.gate.rejected(), 0u);
}

TEST(InputGate, ABodyThatAlreadyHangsInTheHandIsNotLetDrop) {
  const Scene scene = scene_with_grips(1);
  InputGate gate(scene);
  Channel channel(1, BodyMessage{}, 1 << 20);
  BodySnapshot now;
  now.grips.resize(1);
  now.grips[0].pose.position.y = -0.013;  // 13 mm below the hand,
  now.grips[0].on_hand.force.y = -13.0;   // and the coupling carries it already
  tell(channel, message(0));
  const HandleInput input = gate.take(channel, now)[0];
  EXPECT_EQ(input.scale, 1.0);
  EXPECT_EQ(input.pose.position, glm::dvec3(0.0));
}

// A hand whose contact was lost lets go gently: where it was, at rest, ever weaker.
TEST(InputGate, ALostHandFadesWhereItWasLast) {
  const Scene scene = scene_with_grips(1);
  Channel channel(1, BodyMessage{}, 1000);
  InputGate gate(scene);
  BodySnapshot now = snapshot_with_grips(1);
  now.time = 1.0;
  PoseMessage held = message(0, 0.2);
  held.engaged = true;
  held.time = 1.0;
  held.twist.linear.x = 0.5;
  ASSERT_TRUE(gate.accept(held, 0));
  now.time = 2.0;  // the ramp is over
  EXPECT_TRUE(gate.take(channel, now, 0)[0].engaged);
  now.time = 3.0;
  const HandleInput last = gate.take(channel, now, 0)[0];
  ASSERT_EQ(last.scale, 1.0);

  PoseMessage lost = message(0, 0.9);
  lost.lost = true;
  lost.engaged = false;
  ASSERT_TRUE(gate.accept(lost, 0));
  double before = 1.01;
  for (double after = 0.0; after < 0.395; after += 0.01) {
    now.time = 3.0 + after;
    const HandleInput input = gate.take(channel, now, 0)[0];
    ASSERT_TRUE(input.engaged) << after;
    EXPECT_LT(input.scale, before);
    EXPECT_NEAR(input.scale, 1.0 - after / kLostFade, 1e-9);
    EXPECT_EQ(input.pose.position, last.pose.position);
    EXPECT_EQ(input.twist.linear, glm::dvec3(0.0));
    before = input.scale;
    ASSERT_TRUE(gate.accept(lost, 0)) << "said again, it does not start anew";
  }
  now.time = 3.41;
  EXPECT_FALSE(gate.take(channel, now, 0)[0].engaged);
}

TEST(InputGate, AHandThatLetsGoByItselfIsGoneAtOnce) {
  const Scene scene = scene_with_grips(1);
  Channel channel(1, BodyMessage{}, 1000);
  InputGate gate(scene);
  PoseMessage m = message(0);
  m.engaged = true;
  ASSERT_TRUE(gate.accept(m, 0));
  EXPECT_TRUE(gate.take(channel, snapshot_with_grips(1), 0)[0].engaged);
  m.engaged = false;
  ASSERT_TRUE(gate.accept(m, 0));
  EXPECT_FALSE(gate.take(channel, snapshot_with_grips(1), 0)[0].engaged);
}

TEST(InputGate, AHandThatFallsSilentComesToRestWithoutABlow) {
  const Scene scene = scene_with_grips(1);
  Channel channel(1, BodyMessage{}, 1000);
  InputGate gate(scene);
  BodySnapshot now = snapshot_with_grips(1);
  PoseMessage m = message(0, 0.1);
  m.engaged = true;
  m.twist.linear.x = 1.0;
  constexpr std::int64_t kStart = 1'000'000'000;
  ASSERT_TRUE(gate.accept(m, kStart));
  constexpr double kStep = 0.002;
  double x = 0.1;
  double speed = 1.0;
  for (int i = 1; i <= 1000; ++i) {
    now.time = kStep * i;
    // The grip moves with the hand.
    now.grips[0].pose.position.x = x + kStep * speed;
    now.grips[0].twist.linear.x = speed;
    const HandleInput input = gate.take(channel, now, kStart + to_nanoseconds(now.time))[0];
    EXPECT_TRUE(input.engaged);
    EXPECT_NEAR(input.pose.position.x, x + kStep * speed, 1e-9) << "it goes on as it says";
    EXPECT_LE(input.twist.linear.x, speed);
    EXPECT_GE(input.twist.linear.x, speed - 1.02 * kStep / kRunOut);
    if (now.time < kStaleTwist) {
      EXPECT_EQ(input.twist.linear.x, 1.0);
    }
    x = input.pose.position.x;
    speed = input.twist.linear.x;
  }
  EXPECT_LT(speed, 1e-6);
  EXPECT_NEAR(x, 0.1 + kStaleTwist + kRunOut, 0.005);
}

/// The springs that act in the world, on their way to what was asked for.
TEST(InputGate, AHoldGoesByTheStiffnessThatActs) {
  for (const double acting : {0.25, 4.0}) {
    MovedHand hand;
    for (int i = 0; i < 150; ++i) hand.step();
    hand.now.grips[0].stiffness = acting;
    hand.now.grips[0].on_hand.force.x = -10.0;
    hand.say(0.2);
    hand.now.time += 0.001;
    hand.clock += 1'000'000;
    const HandleInput input = hand.gate.take(hand.channel, hand.now, hand.clock)[0];
    EXPECT_NEAR(input.pose.position.x, 10.0 / (acting * hand.scene.grips[0].stiffness), 1e-9)
        << "what acts goes on as it is";
  }
}

TEST(InputGate, AfterAResetHandsHoldAtTheStartUntilTheyReportAnew) {
  const Scene scene = scene_with_grips(1);
  Channel channel(1, BodyMessage{}, 1000);
  InputGate gate(scene);
  BodySnapshot now = snapshot_with_grips(1);
  PoseMessage m = message(0, 0.8);
  m.engaged = true;
  m.time = now.time = 5.0;
  ASSERT_TRUE(gate.accept(m, 0));
  gate.take(channel, now, 0);
  BodySnapshot start = snapshot_with_grips(1);
  start.grips[0].handle.position = {0.01, 0.0, 0.0};
  start.grips[0].on_hand.force = {-10.0, 0.0, 0.0};
  gate.reset(start, 0);
  m.time = 5.01;
  EXPECT_FALSE(gate.accept(m, 1'000'000)) << "still of the run before";
  EXPECT_EQ(gate.rejected(), 0u) << "which is nobody's fault";
  HandleInput input = gate.take(channel, start, 1'000'000)[0];
  EXPECT_TRUE(input.engaged);
  EXPECT_EQ(input.pose.position.x, 0.01);
  m.time = 0.002;
  m.pose.position.x = 0.8;
  EXPECT_TRUE(gate.accept(m, 2'000'000)) << "wherever the hand is";
  start.time = 0.002;
  input = gate.take(channel, start, 2'000'000)[0];
  EXPECT_LT(std::abs(input.pose.position.x), 0.02) << "far from the body: it re-engages";
}

}  // namespace
}  // namespace slosh
