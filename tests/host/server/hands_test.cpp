#include "host/server/hands.h"

#include <gtest/gtest.h>

#include "net/clock.h"
#include "net/grip_start.h"
#include "tests/host/server/scripted_peer.h"

namespace slosh {
namespace {

class Hands : public ::testing::Test {
 protected:
  const PoseMessage& newest(std::size_t grip) {
    channel.pose(grip).update();
    return channel.pose(grip).front();
  }
  bool sample(std::uint64_t number, double x, std::int64_t stamp_ns = 0, bool engaged = true,
              std::uint32_t grip = 0) {
    return sample_of(number, x, stamp_ns, engaged ? wire::HoldsOn::kYes : wire::HoldsOn::kNo, grip);
  }
  /// A hand that holds on and that its person does not feel yet.
  bool unfelt(std::uint64_t number, double x, std::int64_t stamp_ns = 0) {
    return sample_of(number, x, stamp_ns, wire::HoldsOn::kUnfelt, 0);
  }
  bool sample_of(std::uint64_t number, double x, std::int64_t stamp_ns, wire::HoldsOn engaged,
                 std::uint32_t grip) {
    wire::PoseSample s;
    s.grip = grip;
    s.number = number;
    s.stamp_ns = stamp_ns;
    s.pose.position = {x, 0.0, 0.0};
    s.engaged = engaged;
    return hands.sample(s, now);
  }
  Scene scene = served_scene();
  Channel channel{scene.grips.size(), BodyMessage{}, 1000};
  HandTable hands{scene, channel};
  std::int64_t now = to_nanoseconds(100.0);
  std::uint64_t number_ = 0;
};

TEST_F(Hands, TheHostHoldsWhatNobodyHasTaken) {
  hands.stand_all(now);
  for (std::size_t i = 0; i < scene.grips.size(); ++i) {
    EXPECT_TRUE(newest(i).engaged);
    EXPECT_EQ(newest(i).pose.position, grip_start(scene, i).position);
    EXPECT_EQ(newest(i).twist.linear, glm::dvec3(0.0));
  }
  hands.let_go(0, now);
  EXPECT_TRUE(newest(0).engaged) << "a stand stays";
  hands.let_go(0, now, true);
  EXPECT_FALSE(newest(0).engaged);
  EXPECT_TRUE(newest(0).lost);
}

/// A stand beside a person is a hand that never lets go.
TEST_F(Hands, TheFirstPersonsHandEndsTheStandsOfItsBodyThatNobodyHasTaken) {
  scene.grips.push_back(scene.grips[0]);
  scene.grips.push_back(scene.grips[0]);
  Channel wide{scene.grips.size(), BodyMessage{}, 1000};
  HandTable table{scene, wide};
  const auto told = [&](std::size_t grip) {
    wide.pose(grip).update();
    return wide.pose(grip).front();
  };
  const auto say = [&](std::uint32_t grip, wire::HoldsOn holds) {
    wire::PoseSample s;
    s.grip = grip;
    s.number = ++number_;
    s.engaged = holds;
    table.sample(s, now);
  };
  const auto last = static_cast<std::uint32_t>(scene.grips.size() - 1), taken = last - 1;
  table.stand_all(now);
  EXPECT_TRUE(told(last).stand);
  table.taken(0, now);
  table.taken(taken, now);
  say(0, wire::HoldsOn::kUnfelt);
  EXPECT_TRUE(told(last).engaged) << "it is not felt yet";
  say(0, wire::HoldsOn::kYes);
  EXPECT_FALSE(told(0).stand);
  EXPECT_FALSE(told(last).engaged);
  EXPECT_TRUE(told(last).lost) << "gently";
  EXPECT_TRUE(told(taken).engaged) << "whoever has taken it is on their way";
  for (std::size_t i = 1; i < taken; ++i)
    EXPECT_EQ(told(i).engaged, scene.grips[i].body != scene.grips[0].body) << "other bodies keep theirs";
  table.stand_all(now);
  say(taken, wire::HoldsOn::kYes);
  EXPECT_FALSE(told(last).engaged) << "after a reset as well";
}

TEST_F(Hands, AStandHoldsOnUntilTheHandDoesAndTheWorldIsToldThatItIsAnother) {
  hands.stand_all(now);
  const double start = grip_start(scene, 0).position.x;
  const std::uint32_t stand = newest(0).hold;
  hands.taken(0, now);
  ASSERT_TRUE(sample(1, start + 1.0, 0, false));
  EXPECT_EQ(newest(0).pose.position.x, start) << "not engaged yet: the stand holds on";
  EXPECT_EQ(newest(0).hold, stand);
  ASSERT_TRUE(sample(2, start + 1.0));
  EXPECT_EQ(newest(0).pose.position.x, start + 1.0);
  const std::uint32_t first = newest(0).hold;
  EXPECT_NE(first, stand);
  ASSERT_TRUE(sample(3, start + 1.1));
  EXPECT_EQ(newest(0).hold, first) << "the same hand";
  hands.let_go(0, now);
  hands.taken(0, now);
  ASSERT_TRUE(sample(1, start));
  EXPECT_NE(newest(0).hold, first) << "and somebody else's";
}

/// Else it would move the body by a spring that its person feels nothing of.
TEST_F(Hands, AStandHoldsOnUntilTheHandIsFeltAndItsSamplesAreAnswered) {
  hands.stand_all(now);
  const double start = grip_start(scene, 0).position.x;
  const std::uint32_t stand = newest(0).hold;
  hands.taken(0, now);
  EXPECT_EQ(hands.used(0, newest(0).number).number, 0u);
  for (std::uint64_t number : {1u, 2u, 7u}) {
    ASSERT_TRUE(unfelt(number, start + 1.0, static_cast<std::int64_t>(1000 * number)));
    EXPECT_EQ(newest(0).pose.position.x, start);
    EXPECT_EQ(newest(0).hold, stand);
    EXPECT_EQ(hands.used(0, newest(0).number).number, number) << "or its person would never feel anything";
    EXPECT_EQ(hands.used(0, newest(0).number).stamp_ns, static_cast<std::int64_t>(1000 * number));
  }
  EXPECT_FALSE(unfelt(5, start)) << "an older one";
  EXPECT_TRUE(hands.on_stand(0));
  const std::uint64_t of_stand = newest(0).number;
  ASSERT_TRUE(sample(8, start + 1.1, 8000));
  EXPECT_EQ(hands.used(0, of_stand).number, 7u) << "a state that was made before it came: not back to none";
  EXPECT_EQ(newest(0).pose.position.x, start + 1.1);
  EXPECT_NE(newest(0).hold, stand);
  EXPECT_EQ(hands.used(0, newest(0).number).stamp_ns, 8000);
}

/// A silence has taken its force: to the world it is silent, too, until it is felt again.
TEST_F(Hands, AHandThatIsFeltNoMoreMovesNothingAndIsAnswered) {
  hands.let_go(0, now, true);
  hands.taken(0, now);
  ASSERT_TRUE(unfelt(1, 0.2));
  EXPECT_FALSE(newest(0).engaged) << "nothing held it, and nothing does";
  ASSERT_TRUE(sample(2, 0.3));
  const std::uint32_t hold = newest(0).hold;
  ASSERT_TRUE(unfelt(3, 0.4, 3000));
  EXPECT_EQ(newest(0).pose.position.x, 0.3);
  EXPECT_EQ(hands.used(0, newest(0).number).stamp_ns, 3000);
  ASSERT_TRUE(sample(4, 0.5));
  EXPECT_EQ(newest(0).pose.position.x, 0.5);
  EXPECT_EQ(newest(0).hold, hold) << "the world knows of the silence by itself";
  ASSERT_TRUE(unfelt(5, 0.6));
  ASSERT_TRUE(sample(6, 0.6, 0, false));
  EXPECT_FALSE(newest(0).engaged) << "who opens the hand is not waited for";

  ASSERT_TRUE(sample(7, 0.6));
  ASSERT_TRUE(unfelt(8, 0.7));
  hands.lose(0, now);
  EXPECT_TRUE(newest(0).engaged) << "nobody would catch it";
  EXPECT_EQ(newest(0).pose.position.x, 0.6) << "where it was felt last";
  hands.taken(0, now);
  ASSERT_TRUE(unfelt(1, 0.9));
  EXPECT_EQ(newest(0).pose.position.x, 0.6) << "nor moves it before";
  ASSERT_TRUE(sample(2, 0.9));
  EXPECT_EQ(newest(0).pose.position.x, 0.9);
  hands.let_go(0, now);
  EXPECT_EQ(hands.used(0, 0).number, 0u);
}

TEST_F(Hands, ALostHandLetsGoToOneThatIsHeardAndElseStays) {
  ASSERT_EQ(scene.grips[0].body, scene.grips[1].body);
  for (std::uint32_t grip : {0u, 1u}) {
    hands.let_go(grip, now, true);
    hands.taken(grip, now);
    ASSERT_TRUE(sample(1, 0.3, 0, true, grip));
  }
  hands.lose(0, now);
  EXPECT_TRUE(newest(0).lost) << "the other one carries on";

  // A link of both goes dark: neither is heard when the first of them is missed.
  ASSERT_TRUE(sample(2, 0.4));
  ASSERT_TRUE(sample(2, 0.6, 0, true, 1));
  const std::uint32_t hold = newest(0).hold;
  now += to_nanoseconds(0.5);
  hands.lose(0, now);
  hands.lose(1, now);
  EXPECT_TRUE(newest(0).engaged);
  EXPECT_EQ(newest(0).pose.position.x, 0.4);
  EXPECT_NE(newest(0).hold, hold) << "the stand is another hand";
  EXPECT_TRUE(newest(1).engaged);
  hands.lose(0, now);
  EXPECT_TRUE(newest(0).engaged) << "missed twice: nothing changes";

  ASSERT_TRUE(sample(3, 0.5)) << "it is back";
  EXPECT_EQ(newest(0).pose.position.x, 0.5);
  now += to_nanoseconds(0.5);
  hands.lose(0, now);
  EXPECT_TRUE(newest(0).engaged);
  hands.let_go(0, now);
  EXPECT_FALSE(newest(0).engaged) << "who leaves is not waited for";
}

/// What persons put in is counted for the grip, whoever holds it: others count on the sum. It was none on a
/// stand, and the whole again with the hand.
TEST_F(Hands, WhatWasPutInIsCountedOnOverStandsAndHolders) {
  const auto put_in = [&](std::uint64_t number, double energy, wire::HoldsOn engaged = wire::HoldsOn::kYes) {
    wire::PoseSample s;
    s.number = number;
    s.engaged = engaged;
    s.energy = energy;
    return hands.sample(s, now, true);
  };
  hands.stand_all(now);
  hands.taken(0, now);
  ASSERT_TRUE(put_in(1, 0.0));
  ASSERT_TRUE(put_in(2, 0.4));
  EXPECT_DOUBLE_EQ(newest(0).energy, 0.4);
  now += to_nanoseconds(0.5);
  hands.lose(0, now);
  ASSERT_TRUE(hands.on_stand(0));
  EXPECT_DOUBLE_EQ(newest(0).energy, 0.4) << "on the stand";
  ASSERT_TRUE(put_in(3, 0.4, wire::HoldsOn::kUnfelt));
  ASSERT_TRUE(put_in(4, 0.5));
  EXPECT_DOUBLE_EQ(newest(0).energy, 0.5) << "back";
  now += to_nanoseconds(0.5);
  hands.lose(0, now);
  for (const double begins_at : {0.0, 7.0}) {
    const double before = newest(0).energy;
    hands.taken(0, now);
    ASSERT_TRUE(put_in(1, begins_at, wire::HoldsOn::kUnfelt));
    ASSERT_TRUE(put_in(2, begins_at - 0.1));
    EXPECT_NEAR(newest(0).energy, before - 0.1, 1e-12)
        << "another holder, whose count begins at " << begins_at;
    hands.let_go(0, now);
  }
}

TEST_F(Hands, AHandThatHeldNothingLeavesNothingBehind) {
  hands.let_go(0, now, true);
  hands.taken(0, now);
  ASSERT_TRUE(sample(1, 0.3, 0, false));
  hands.lose(0, now);
  EXPECT_FALSE(newest(0).engaged);
}

TEST_F(Hands, OnlyNewerSamplesCountAndRepeatsAreCountedOnce) {
  hands.let_go(0, now, true);
  hands.taken(0, now);
  EXPECT_TRUE(sample(5, 0.5));
  EXPECT_FALSE(sample(5, 0.9));
  EXPECT_FALSE(sample(4, 0.9)) << "before the first: not counted";
  EXPECT_TRUE(sample(9, 0.6));
  EXPECT_FALSE(sample(7, 0.9));
  EXPECT_FALSE(sample(7, 0.9));
  EXPECT_EQ(newest(0).pose.position.x, 0.6);
  EXPECT_EQ(hands.delivery(0).received, 3u);
  EXPECT_EQ(hands.delivery(0).expected, 5u);
}

TEST_F(Hands, StampsComeBackOnTheHoldersClock) {
  hands.taken(0, now);
  const std::int64_t far = -to_nanoseconds(1e6);  // a clock that is far off
  for (std::uint64_t i = 1; i <= 500; ++i) {
    now += 2'000'000;
    ASSERT_TRUE(sample(i, 0.5, far + static_cast<std::int64_t>(i) * 2'000'000));
  }
  const PoseMessage& message = newest(0);
  EXPECT_NEAR(to_seconds(now - message.stamp_ns), 0.0, 1e-3) << "on the host's clock";
  EXPECT_EQ(hands.used(0, message.number).number, 500u);
  EXPECT_EQ(hands.used(0, message.number).stamp_ns, far + 500 * 2'000'000);
  EXPECT_EQ(hands.used(0, message.number - 499).number, 1u);
  EXPECT_EQ(hands.used(0, 0).number, 0u);
  hands.taken(0, now);  // somebody else
  EXPECT_EQ(hands.used(0, message.number).number, 0u) << "another's number is nobody's";
  ASSERT_TRUE(sample(1, 0.5, 77));
  EXPECT_EQ(hands.used(0, newest(0).number).stamp_ns, 77);
}

TEST_F(Hands, ALateSampleKeepsItsDistanceInTime) {
  hands.taken(0, now);
  std::int64_t stamp = 0;
  std::int64_t before = 0;
  for (std::uint64_t i = 1; i <= 200; ++i) {
    stamp += 4'000'000;
    now += 4'000'000;
    const std::int64_t jitter = i % 7 == 3 ? 3'000'000 : 0;
    now += jitter;
    ASSERT_TRUE(sample(i, 0.5, stamp));
    now -= jitter;
    const std::int64_t mapped = newest(0).stamp_ns;
    if (i > 1) {
      EXPECT_NEAR(static_cast<double>(mapped - before), 4e6, 2e4);
    }
    before = mapped;
  }
}

TEST_F(Hands, AfterARestartWhatWasHeldStandsWhereTheHandWas) {
  BodySnapshot bodies;
  bodies.grips.resize(scene.grips.size());
  bodies.grips[1].handle.position = {3.0, 2.0, 1.0};
  bodies.grips[1].on_hand.force = {0.0, -5.0, 0.0};
  hands.carry_on(bodies, now);
  EXPECT_TRUE(newest(1).engaged);
  EXPECT_EQ(newest(1).pose.position.x, 3.0);
  EXPECT_FALSE(newest(0).engaged);
}

}  // namespace
}  // namespace slosh
