#include "net/engagement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace slosh {
namespace {

constexpr CouplingGains kGains{1000.0, 20.0, 10.0, 0.2};
constexpr double kTick = 0.001;

Pose at(double x) {
  Pose pose;
  pose.position.x = x;
  return pose;
}

/// The force on the hand at full strength.
Wrench wrench_of(const Engagement::Held& held, const GripState& grip) {
  return coupling_wrench_on_hand(kGains, held.pose, held.twist, grip.pose, grip.twist);
}

TEST(Engagement, AHandFarFromTheGripTakesHoldWithoutAForce) {
  Engagement e;
  const GripState grip;
  Pose hand = at(0.5);
  hand.orientation = rotate_by(hand.orientation, {0.3, -1.2, 0.4});
  const Wrench wrench = wrench_of(e.update(true, 10.0, hand, {}, kGains, grip), grip);
  EXPECT_LT(glm::length(wrench.force), 1e-9);
  EXPECT_LT(glm::length(wrench.torque), 1e-9);
  EXPECT_NEAR(e.distance(), 0.5, 1e-12);
  EXPECT_NEAR(e.angle(), glm::length(glm::dvec3(0.3, -1.2, 0.4)), 1e-9);
  EXPECT_EQ(e.felt(), 0.0);
}

TEST(Engagement, TheForceGoesOnAsItWas) {
  Engagement e;
  GripState grip;
  grip.pose = at(-0.02);
  grip.twist.linear = {0.0, -0.8, 0.0};
  grip.twist.angular = {0.5, 0.0, 0.0};
  grip.on_hand = {{3.0, -12.0, 1.0}, {0.2, 0.1, -0.3}};
  Twist moving;
  moving.linear = {0.4, 0.0, 0.0};
  const Wrench wrench = wrench_of(e.update(true, 10.0, at(0.3), moving, kGains, grip), grip);
  EXPECT_LT(glm::length(wrench.force - grip.on_hand.force), 1e-9);
  EXPECT_LT(glm::length(wrench.torque - grip.on_hand.torque), 1e-9);
}

TEST(Engagement, TheDistanceIsGivenUpAtABoundedSpeedAndWholly) {
  Engagement e;
  const GripState grip;
  const Pose hand = at(0.3);
  double x = e.update(true, 0.0, hand, {}, kGains, grip).pose.position.x;
  EXPECT_NEAR(x, 0.0, 1e-12);
  double fastest = 0.0;
  double told = 0.0;
  double there = 0.0;
  for (double t = kTick; t < 20.0; t += kTick) {
    const Engagement::Held held = e.update(true, t, hand, {}, kGains, grip);
    EXPECT_GE(held.pose.position.x, x);
    const double speed = (held.pose.position.x - x) / kTick;
    EXPECT_LE(speed, kRampSpeed * std::min(1.0, t / kRampRise) + 1e-3);
    if (e.distance() > 0.0) {
      EXPECT_NEAR(held.twist.linear.x, speed, 1e-6) << "the damper is told of it";
    }
    fastest = std::max(fastest, speed);
    told = held.twist.linear.x;
    x = held.pose.position.x;
    if (there == 0.0 && e.distance() == 0.0) there = t;
  }
  EXPECT_NEAR(fastest, kRampSpeed, 1e-3);
  EXPECT_EQ(x, 0.3) << "in the end the hand holds exactly where it is";
  EXPECT_EQ(told, 0.0);
  EXPECT_GT(there, 0.3 / kRampSpeed);
  EXPECT_LT(there, 0.3 / kRampSpeed + 5.0);
  EXPECT_EQ(e.felt(), 1.0);
}

TEST(Engagement, ATurnIsGivenUpTheSameWay) {
  Engagement e;
  const GripState grip;
  Pose hand;
  hand.orientation = rotate_by(hand.orientation, {0.0, 3.0, 0.0});
  double last = 3.0;
  for (double t = 0.0; t < 12.0; t += kTick) {
    e.update(true, t, hand, {}, kGains, grip);
    EXPECT_LE((last - e.angle()) / kTick, kRampTurn + 1e-3);
    last = e.angle();
  }
  EXPECT_EQ(last, 0.0);
}

TEST(Engagement, WhereTheHandGoesMeanwhileTheHoldGoesToo) {
  Engagement e;
  const GripState grip;
  e.update(true, 0.0, at(0.3), {}, kGains, grip);
  Twist moving;
  moving.linear.y = 1.0;
  Pose hand = at(0.3);
  hand.position.y = 0.001;
  const Engagement::Held held = e.update(true, 0.001, hand, moving, kGains, grip);
  EXPECT_NEAR(held.pose.position.y, 0.001, 1e-12);
  EXPECT_NEAR(held.twist.linear.y, 1.0, 1e-12);
}

TEST(Engagement, AHandThatPassesByDoesNotSnatchTheGripAway) {
  Engagement e;
  const GripState grip;  // at rest
  Twist passing;
  passing.linear.x = 0.6;
  passing.angular.z = 1.5;
  const auto hand_at = [&](double t) {
    Pose hand = at(0.2 + 0.6 * t);
    hand.orientation = rotate_by(hand.orientation, {0.0, 0.0, 0.3 + 1.5 * t});
    return hand;
  };
  Engagement::Held held = e.update(true, 0.0, hand_at(0.0), passing, kGains, grip);
  EXPECT_LT(glm::length(held.twist.linear) + glm::length(held.twist.angular), 1e-12);
  EXPECT_LT(glm::length(wrench_of(held, grip).force), 1e-9);
  double x = held.pose.position.x;
  double speed = 0.0;
  for (double t = kTick; t < 10.0; t += kTick) {
    held = e.update(true, t, hand_at(t), passing, kGains, grip);
    const double now = (held.pose.position.x - x) / kTick;
    EXPECT_LT(std::abs(now - speed), kTick * (0.6 / kSlipRise + kRampSpeed / kRampRise) * 1.05 + 1e-9) << t;
    // Within half a tick of the greatest acceleration: one is the end's velocity, the other the tick's mean.
    EXPECT_NEAR(held.twist.linear.x, now, 0.5 * kTick * (0.6 / kSlipRise + kRampSpeed / kRampRise) + 1e-4)
        << "the damper is told";
    speed = now;
    x = held.pose.position.x;
  }
  EXPECT_EQ(e.distance(), 0.0) << "in the end it holds where it is";
  EXPECT_LT(e.angle(), 1e-12);
}

/// The other hand keeps the grip where it is, whatever this one does.
TEST(Engagement, WhereAnotherHandHoldsTooItSlipsAndBearsMoreEachSecond) {
  GripState grip;
  grip.on_hand = {{3.0, -12.0, 0.0}, {0.0, 0.2, 0.0}};
  Pose hand = at(0.3);
  hand.orientation = rotate_by(hand.orientation, {0.0, 0.0, 1.2});
  for (const bool shared : {true, false}) {
    Engagement e;
    double most = 0.0;
    Wrench before = grip.on_hand;
    double t = 0.0;
    for (; t < 12.0 * kHoldDoubles; t += kTick) {
      // To and fro at 0.3 m/s at most: what it drags at the body by is bounded too.
      Twist twist;
      twist.linear.x = 0.3 * std::cos(3.0 * t);
      hand.position.x = 0.3 + 0.1 * std::sin(3.0 * t);
      const Wrench wrench = wrench_of(
          e.update(true, t, hand, twist, kGains, grip, shared ? Company::kShared : Company::kAlone), grip);
      const double more = glm::length(wrench.force - grip.on_hand.force);
      const double twisting = glm::length(wrench.torque - grip.on_hand.torque);
      const double firmness = std::exp2(t / kHoldDoubles);
      if (t < 2.0) most = std::max(most, more);
      if (!shared) continue;
      EXPECT_LE(more, firmness * kHoldForce + 1e-9) << t;
      EXPECT_LE(twisting, firmness * kHoldTorque + 1e-9) << t;
      EXPECT_LT(glm::length(wrench.force - before.force), 2.0 + kTick * 1000.0) << t;
      before = wrench;
    }
    EXPECT_EQ(e.distance(), 0.0) << "in the end the hand holds where it is";
    if (shared) {
      EXPECT_NEAR(most, std::exp2(2.0 / kHoldDoubles) * kHoldForce, 0.1) << "it bears what it may";
    } else {
      EXPECT_GT(most, 150.0);
    }
  }
}

/// One hand came to carry all, and another joins: the body does not fall into its hands.
TEST(Engagement, WhatItCarriesWhenAnotherHandJoinsItCarriesOn) {
  Engagement e;
  GripState grip;
  Twist moving;
  moving.linear.z = moving.angular.z = 0.1;  // no quiet hold
  e.update(true, 0.0, at(0.5), moving, kGains, grip);
  double t = kTick;
  for (; t < 1.0; t += kTick) {  // it sinks by 0.1 m and 0.3 rad
    grip.pose.position.y -= 0.1 * kTick;
    grip.pose.orientation = rotate_by(grip.pose.orientation, {0.0, 0.0, 0.3 * kTick});
    grip.on_hand = wrench_of(e.update(true, t, at(0.5), {}, kGains, grip), grip);
  }
  ASSERT_GT(glm::length(grip.on_hand.force), 80.0);
  ASSERT_GT(glm::length(grip.on_hand.torque), 2.0);
  ASSERT_GT(e.distance(), 0.1) << "still on its way to the hand";
  const Wrench after = wrench_of(e.update(true, t, at(0.5), {}, kGains, grip, Company::kShared), grip);
  EXPECT_LT(glm::length(after.force - grip.on_hand.force), 2.0 * kHoldForce + 0.1);
  EXPECT_LT(glm::length(after.torque - grip.on_hand.torque), 2.0 * kHoldTorque + 0.01);
}

/// A body that a hold drives on: it would be a rocket where the hold followed it with what pulled when it
/// began.
TEST(Engagement, AHoldThatSlipsGivesTheBodyNoMoreThanItsAllowance) {
  for (const Company company : {Company::kShared, Company::kSilent}) {
    for (const bool turning : {false, true}) {
      Engagement e;
      GripState grip;
      grip.pose = at(-0.01);
      grip.on_hand = {{-10.0, 0.0, 0.0}, {0.0, 0.0, -1.0}};
      Twist moving;
      (turning ? moving.angular.z : moving.linear.x) = 0.1;  // no quiet hold
      e.carries(grip.on_hand);
      e.update(true, 0.0, at(0.0), moving, kGains, grip, Company::kShared);
      double gave = 0.0, off = 0.0;
      Wrench before = grip.on_hand;
      for (double t = kTick; t < 4.0; t += kTick) {
        // On and on, the way it is pulled: 3 m and 60 rad.
        if (turning)
          grip.pose.orientation = rotate_by(grip.pose.orientation, {0.0, 0.0, 15.0 * kTick}),
          grip.twist.angular.z = 15.0;
        else
          grip.pose.position.x += 0.75 * kTick, grip.twist.linear.x = 0.75;
        const Wrench wrench = wrench_of(e.update(true, t, at(0.0), {}, kGains, grip, company), grip);
        gave -=
            kTick * (glm::dot(wrench.force, grip.twist.linear) + glm::dot(wrench.torque, grip.twist.angular));
        const double change = turning ? 10.0 * glm::length(wrench.torque - before.torque)
                                      : glm::length(wrench.force - before.force);
        off = std::max(off, change);
        before = wrench;
      }
      // In the end it only takes: friction.
      EXPECT_LT(gave, 0.0);
      EXPECT_LT(off, kHoldForce + 0.01) << "and never jumps, though the grip does in the first tick";
    }
  }
}

/// Given at most over any part of the way, with what the spring held when it began.
TEST(Engagement, WhatAHoldGivesIsBoundedOnEveryWay) {
  Engagement e;
  GripState grip;
  grip.pose = at(-0.01);
  grip.on_hand.force.x = -10.0;
  e.carries(grip.on_hand);
  e.update(true, 0.0, at(0.0), {}, kGains, grip, Company::kShared);
  double gave = 0.0, most = 0.0, counted = 0.0;
  for (double t = kTick; t < 3.0; t += kTick) {
    grip.twist.linear.x = 0.4 + 0.3 * std::sin(9.0 * t);
    grip.pose.position.x += kTick * grip.twist.linear.x;
    const Wrench wrench = wrench_of(e.update(true, t, at(0.0), {}, kGains, grip, Company::kSilent), grip);
    gave -= kTick * wrench.force.x * grip.twist.linear.x;
    most = std::max(most, gave);
    counted += e.given();
  }
  const double spring = 0.5 * 10.0 * 10.0 / kGains.stiffness;
  EXPECT_LT(most, (1.1 + 3.0 / kHoldRecovers) * (kHoldWay * (10.0 + kHoldForce) + spring));
  EXPECT_GT(most, 0.5 * kHoldWay * 10.0) << "it helps to carry over some way";
  EXPECT_GT(counted, most - spring - 0.1) << "and says what it gave";
}

/// Live stiffness: what is strained when it is stiffened would be thrown.
TEST(Engagement, AStiffenedSpringKeepsItsForceAndPutsNothingIn) {
  Engagement e;
  GripState grip;
  grip.pose = at(-0.02);
  grip.pose.orientation = rotate_by(grip.pose.orientation, {0.0, 0.0, -0.1});
  grip.on_hand = {{-20.0, 0.0, 0.0}, {0.0, 0.0, -1.0}};
  double t = 0.0, scale = 1.0;
  const auto turn = [&] {
    const CouplingGains gains = stiffened(kGains, scale);
    const Engagement::Held held = e.update(true, t += kTick, at(0.0), {}, gains, grip);
    return coupling_wrench_on_hand(gains, held.pose, {}, grip.pose, grip.twist);
  };
  turn();
  for (int i = 0; i < 10; ++i) turn();
  scale = 4.0;
  const Wrench wrench = turn();
  EXPECT_NEAR(-wrench.force.x, 20.0, 0.6) << "80 by the stretch; the ramp's share";
  EXPECT_NEAR(-wrench.torque.z, 1.0, 0.1);
  EXPECT_LT(e.given(), 0.0) << "a stiffer spring holds less of the same force";
  Wrench last = wrench;
  for (int i = 0; i < 8000; ++i) {
    const Wrench now = turn();
    EXPECT_LT(glm::length(now.force - last.force), 4.0 * kGains.stiffness * kRampSpeed * kTick + 0.5);
    last = now;
  }
  EXPECT_EQ(e.distance(), 0.0) << "in the end the hand holds where it is";
  // Softened, it keeps its stretch.
  scale = 1.0;
  EXPECT_NEAR(-turn().force.x, 20.0, 1e-9);
  EXPECT_EQ(e.given(), 0.0);
}

TEST(Engagement, WhatTurnsWithTheHandTurnsAsTheHandDoes) {
  Engagement e;
  const GripState grip;
  Pose hand;
  hand.orientation = rotate_by(hand.orientation, {1.2, 0.0, 0.0});
  const glm::dquat before = e.update(true, 0.0, hand, {}, kGains, grip).pose.orientation;
  const glm::dvec3 turn{0.0, 0.02, 0.0};
  hand.orientation = rotate_by(hand.orientation, turn);
  const glm::dquat after = e.update(true, 1e-9, hand, {}, kGains, grip).pose.orientation;
  EXPECT_LT(glm::length(rotation_between(before, after) - turn), 1e-6);
}

TEST(Engagement, AQuietHoldIsTheHandItself) {
  Engagement e;
  GripState grip;
  grip.pose.position.y = -0.013;
  grip.on_hand.force.y = -13.0;  // the coupling carries it already
  const Engagement::Held held = e.update(true, 0.0, at(0.001), {}, kGains, grip);
  EXPECT_EQ(held.pose.position, at(0.001).position);
  EXPECT_EQ(e.felt(), 1.0);
  EXPECT_EQ(e.update(true, 0.1, at(0.2), {}, kGains, grip).pose.position.x, 0.2)
      << "what comes later is no new hold";
}

TEST(Engagement, LettingGoForgetsAndTheNextHoldBeginsAnew) {
  Engagement e;
  const GripState grip;
  e.update(true, 0.0, at(0.2), {}, kGains, grip);
  const Engagement::Held free = e.update(false, 1.0, at(0.7), {}, kGains, grip);
  EXPECT_EQ(free.pose.position.x, 0.7);
  EXPECT_EQ(e.felt(), 0.0);
  EXPECT_EQ(wrench_of(e.update(true, 2.0, at(0.7), {}, kGains, grip), grip).force.x, 0.0);
}

TEST(Engagement, ABodyOutOfThisWorldIsHeldOnceItIsBack) {
  Engagement e;
  GripState grip;
  grip.pose.position.x = std::numeric_limits<double>::quiet_NaN();
  e.update(true, 0.0, at(0.2), {}, kGains, grip);
  EXPECT_FALSE(e.engaged());
  grip.pose.position.x = 0.0;
  EXPECT_LT(glm::length(wrench_of(e.update(true, 0.1, at(0.2), {}, kGains, grip), grip).force), 1e-9);
}

TEST(Engagement, AGripWithoutASpringForTurnsHasNone) {
  Engagement e;
  CouplingGains gains = kGains;
  gains.rotational_stiffness = gains.rotational_damping = 0.0;
  Pose hand = at(0.1);
  hand.orientation = rotate_by(hand.orientation, {0.0, 2.0, 0.0});
  const Engagement::Held held = e.update(true, 0.0, hand, {}, gains, {});
  EXPECT_EQ(held.pose.orientation, rotate_by(hand.orientation, glm::dvec3(0.0)));
  EXPECT_EQ(e.angle(), 0.0);
}

}  // namespace
}  // namespace slosh
