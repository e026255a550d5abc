// Several hands on one body at the gate: who is silent or lost yields to who is there.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/host/input_gate_kit.h"

namespace slosh {
namespace {

/// Two hands hold one body; the first falls silent, then the body is moved.
struct TwoHands {
  Scene scene = scene_with_grips(2);
  Channel channel{2, BodyMessage{}, 1000};
  InputGate gate{scene};
  BodySnapshot now = snapshot_with_grips(2);
  std::int64_t clock = 1'000'000'000;
  HandleInput silent;

  void step(bool first_speaks, bool second_speaks) {
    now.time += 0.001;
    clock += 1'000'000;
    for (const std::uint32_t i : {0u, 1u}) {
      if (!(i == 0 ? first_speaks : second_speaks)) continue;
      tell(channel, message(i, 0.0, clock));
    }
    silent = gate.take(channel, now, clock)[0];
  }
  glm::dvec3 force() const {
    const Grip& g = scene.grips[0];
    return g.stiffness * (now.grips[0].pose.position - silent.pose.position);
  }
};

TEST(InputGate, ASilentHandGivesWayToOneThatIsHeard) {
  TwoHands hands;
  hands.now.grips[0].pose.position.y = -0.01;
  hands.now.grips[0].on_hand.force.y = -0.01 * hands.scene.grips[0].stiffness;  // its share of a weight
  for (int i = 0; i < 20; ++i) hands.step(true, true);
  const double share = hands.force().y;
  for (int i = 0; i < 200; ++i) hands.step(false, true);
  EXPECT_NEAR(hands.force().y, share, 1e-9) << "nothing moves: it carries on";
  for (int i = 0; i < 500; ++i) {
    hands.now.grips[0].pose.position +=
        glm::dvec3(0.0005, 0.0, 0.0002);  // the other one carries the body away
    hands.now.grips[0].pose.orientation =
        rotate_by(hands.now.grips[0].pose.orientation, glm::dvec3(0.0, 0.0, 0.001));
    hands.step(false, true);
    EXPECT_LT(glm::length(hands.force() - glm::dvec3(0.0, share, 0.0)), kYieldForce + 1e-9);
    const double turned =
        glm::length(rotation_between(hands.silent.pose.orientation, hands.now.grips[0].pose.orientation));
    EXPECT_LT(turned * hands.scene.grips[0].rotational_stiffness, kYieldTorque + 1e-9);
  }
}

/// What it carried it goes on carrying over some way up: it is not there, and has no energy to give.
TEST(InputGate, ASilentHandLiftsNothingForEver) {
  TwoHands hands;
  hands.now.grips[0].pose.position.y = -0.01;
  hands.now.grips[0].on_hand.force.y = -0.01 * hands.scene.grips[0].stiffness;
  for (int i = 0; i < 20; ++i) hands.step(true, true);
  const double share = hands.force().y;
  double gave = 0.0;
  for (int i = 0; i < 4000; ++i) {
    hands.now.grips[0].pose.position.y += 0.0003;
    hands.now.grips[0].twist.linear.y = 0.3;
    hands.step(false, true);
    gave -= 0.0003 * hands.force().y;
    EXPECT_GT(hands.force().y, share - kYieldForce - 1e-9) << "never more than it carried";
  }
  EXPECT_LT(gave, 1.05 * (1.0 + 4.0 / kHoldRecovers) * kHoldWay * (std::abs(share) + kYieldForce) +
                      0.5 * share * share / hands.scene.grips[0].stiffness);
}

/// The host's own stand is nobody: whoever holds the other grip is alone, and their hold is not bounded by
/// it.
TEST(InputGate, AStandIsNobody) {
  for (const bool stand : {true, false}) {
    TwoHands hands;
    PoseMessage other = message(1, 0.0, hands.clock);
    other.stand = stand;
    tell(hands.channel, other);
    hands.now.grips[0].on_hand.force.y = -20.0;
    for (int i = 0; i < 200; ++i) {
      hands.now.time += 0.001;
      hands.clock += 1'000'000;
      tell(hands.channel, message(0, 0.05, hands.clock));
      hands.now.grips[0].pose.position.x -= 0.0005;  // the body swings away from the hand
      hands.silent = hands.gate.take(hands.channel, hands.now, hands.clock)[0];
    }
    const double change = glm::length(hands.force() - glm::dvec3(0.0, -20.0, 0.0));
    if (stand) {
      EXPECT_GT(change, 20.0);
    } else {
      EXPECT_LT(change, 1.2 * kHoldForce);
    }
  }
}

/// In a world that waits no step sees it while it holds.
TEST(InputGate, AStandThatEndsBeforeAStepHasSeenItFadesAllTheSame) {
  TwoHands hands;
  PoseMessage ended = message(0, 0.0, hands.clock);
  ended.stand = ended.lost = true;
  ended.engaged = false;
  tell(hands.channel, ended);
  hands.now.grips[0].pose.position.y = -0.01;
  hands.now.grips[0].on_hand.force.y = -10.0;
  double before = 1.01;
  for (int i = 0; i < 1900; ++i) {
    hands.step(false, true);
    ASSERT_TRUE(hands.silent.engaged) << i;
    EXPECT_LT(hands.silent.scale, before);
    before = hands.silent.scale;
  }
  for (int i = 0; i < 200; ++i) hands.step(false, true);
  EXPECT_FALSE(hands.silent.engaged);
}

// One of two is lost for good: the other gets the weight over kHandOver, and may move meanwhile.
TEST(InputGate, ALostHandsShareGoesToTheOtherSlowly) {
  TwoHands hands;
  hands.now.grips[0].pose.position.y = -0.01;
  hands.now.grips[0].on_hand.force.y = -0.01 * hands.scene.grips[0].stiffness;  // its share of a weight
  for (int i = 0; i < 20; ++i) hands.step(true, true);
  const double share = hands.force().y;
  PoseMessage lost = message(0, 0.0, hands.clock);
  lost.lost = true;
  lost.engaged = false;
  ASSERT_TRUE(hands.gate.accept(lost, hands.clock));
  double before = hands.force().y;
  for (int i = 0; i < 1990; ++i) {
    hands.now.grips[0].pose.position +=
        glm::dvec3(0.0005, 0.0, 0.0002);  // the other one carries the body away
    hands.step(false, true);
    ASSERT_TRUE(hands.silent.engaged) << i;
    const double left = 1.0 - 0.001 * i / kHandOver;
    EXPECT_NEAR(hands.silent.scale, left, 0.002);
    const glm::dvec3 gives = hands.silent.scale * hands.force();
    EXPECT_LE(glm::length(gives - glm::dvec3(0.0, left * share, 0.0)),
              left * kYieldForce + 0.002 * std::abs(share))
        << "it pulls at nobody";
    EXPECT_LE(std::abs(gives.y - before), 2.0 * kYieldForce) << "and never jumps";
    before = gives.y;
  }
  for (int i = 0; i < 20; ++i) hands.step(false, true);
  EXPECT_FALSE(hands.silent.engaged);
}

TEST(InputGate, HandsThatAreAllSilentHoldTheBodyWhereItIs) {
  TwoHands hands;
  for (int i = 0; i < 20; ++i) hands.step(true, true);
  const Pose before = hands.silent.pose;
  for (int i = 0; i < 500; ++i) {
    hands.now.grips[0].pose.position.y -= 0.0005;
    hands.step(false, false);
  }
  EXPECT_EQ(hands.silent.pose.position, before.position) << "nobody else is there to carry it";
}

}  // namespace
}  // namespace slosh
