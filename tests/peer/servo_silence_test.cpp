// The device loop when body states stop, stand or come back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include "peer/haptics/device_loop.h"
#include "peer/haptics/servo.h"
#include "servo_kit.h"

namespace slosh {
namespace {

using test::at;
using test::kTick;
using test::ServoKit;

/// The world runs, the hand takes hold, and goes on by 10 mm: 10 N at 1000 N/m.
void stretch(ServoKit& kit) {
  kit.publish(0.0);
  kit.tick(0.0);
  kit.publish(kTick);
  kit.device->next.pose = at(0.01);
  kit.tick(kTick);
}

TEST(Servo, FadesOutWhenBodyStatesStop) {
  ServoKit kit;
  stretch(kit);
  for (int ms = 1; ms <= 1000; ++ms) {
    const double age = 0.001 * ms;
    kit.tick(kTick + age);
    const double expected = -10.0 * std::clamp(1.0 - (age - kHoldStale) / kFadeStale, 0.0, 1.0);
    ASSERT_NEAR(kit.device->last.force.x, expected, 1e-6) << "held, then faded: " << ms << " ms";
  }
}

/// A host far away whose states come and that has not received us: there is no force that would have to end,
/// however long that lasts. From its first answer on there is: at once for who feels none, over their time
/// for a hand.
TEST(Servo, NoForceBeginsBeforeTheHostHasHeardTheHand) {
  for (const bool hand : {false, true}) {
    DeviceLimits limits = limits_without_a_hand();
    if (hand) limits.engagement_time = 2.0;
    ServoKit kit(limits);
    kit.device->next.pose = at(0.01);
    double now = 0.0;
    double most = 0.0;
    const auto run = [&](double seconds, bool answers) {
      for (const double end = now + seconds; now < end; now += 0.001) {
        kit.publish(now, {}, {}, 1.0, answers ? now - 0.1 : 0.0);
        const double before = kit.device->last.force.x;
        kit.tick(now);
        most = std::max(most, std::abs(kit.device->last.force.x - before));
      }
    };
    run(3.0, false);
    EXPECT_EQ(most, 0.0);
    run(0.002, true);
    EXPECT_NEAR(kit.device->last.force.x, hand ? 0.0 : -10.0, 0.01);
    most = 0.0;
    run(2.1, true);
    EXPECT_NEAR(kit.device->last.force.x, -10.0, 1e-6);
    EXPECT_LT(most, 0.01) << "no step";
    // It receives us no more: poses stop at `now`, and what is on its way still comes.
    const double fault = now - 0.1;
    for (const double end = now + 0.301; now < end; now += 0.001) {
      kit.publish(now, {}, {}, 1.0, fault);
      kit.tick(now);
    }
    EXPECT_EQ(kit.device->last.force.x, 0.0) << "400 ms after the last pose that it heard";
  }
}

/// A host that keeps its stand until a hand is felt: how far the hand went before its force begins stretches
/// nothing, and the host is told from then on. One that does not took the hand with its first pose.
TEST(Servo, TakesHoldWhereTheHandIsWhenItsForceBegins) {
  for (const bool stands : {true, false}) {
    ServoKit kit;
    kit.stands = stands;
    double now = 0.0;
    const auto run = [&](double seconds, bool answers) {
      for (const double end = now + seconds; now < end; now += 0.001) {
        kit.device->next.pose = at(0.1 * now);
        kit.publish(now, {}, {}, 1.0, answers ? now - 0.1 : 0.0);
        kit.tick(now);
      }
      kit.channel.pose(0).update();
      return kit.channel.pose(0).front();
    };
    PoseMessage said = run(0.5, false);
    EXPECT_EQ(kit.device->last.force.x, 0.0);
    EXPECT_TRUE(said.engaged);
    EXPECT_FALSE(said.felt);
    said = run(0.002, true);
    EXPECT_TRUE(said.felt);
    if (!stands) {
      EXPECT_NEAR(kit.device->last.force.x, -50.0, 0.5) << "the world has the same spring";
      continue;
    }
    EXPECT_NEAR(kit.device->last.force.x, 0.0, 0.1);
    // A silence takes its force, and it re-engages after that, too.
    now += 1.0;
    said = run(0.1, false);
    EXPECT_EQ(kit.device->last.force.x, 0.0);
    said = run(0.5, false);
    EXPECT_FALSE(said.felt) << "it speaks again, and no answer came";
    said = run(0.002, true);
    EXPECT_TRUE(said.felt);
    EXPECT_NEAR(kit.device->last.force.x, 0.0, 0.1);
  }
}

/// Nobody feels what a script or a mouse holds, and in one process the answer is there at once.
TEST(Servo, NobodyWaitsForWhoFeelsNothing) {
  ServoKit kit;
  kit.stands = true;
  auto silent_script = std::make_unique<test::FakeDevice>();
  silent_script->feels = false;
  ASSERT_TRUE(kit.servo->set_device(0, std::move(silent_script)));
  kit.publish(0.0, {}, {}, 1.0, 0.0);
  kit.tick(0.0);
  ASSERT_TRUE(kit.channel.pose(0).update());
  EXPECT_TRUE(kit.channel.pose(0).front().felt);
  ServoKit here;
  here.publish(0.0);
  here.tick(0.0);
  ASSERT_TRUE(here.channel.pose(0).update());
  EXPECT_TRUE(here.channel.pose(0).front().felt);
}

TEST(Servo, SilenceStretchesNoSpring) {
  ServoKit kit;
  stretch(kit);
  double most = 0.0;
  for (int ms = 1; ms <= 400; ++ms) {
    kit.device->next.pose = at(0.01 + 0.0005 * ms);  // the hand goes on, and nobody says where the grip is
    kit.tick(kTick + 0.001 * ms);
    // What two ticks and a period carry the hand on by still counts as fresh.
    most = std::max(most, std::abs(kit.device->last.force.x));
  }
  EXPECT_LT(most, 10.0 + 1000.0 * 0.0005 * 5.0 + 0.1);
  EXPECT_EQ(kit.device->last.force.x, 0.0);
}

// A device that talks and says nothing is silent: no hand is left with the force of its last good report.
TEST(Servo, ReportsThatAreNoPosesAreSilence) {
  ServoKit kit;
  stretch(kit);
  kit.device->next.pose.position.x = std::numeric_limits<double>::quiet_NaN();
  double before = 10.0;
  for (int ms = 1; ms <= 400; ++ms) {
    const double now = kTick + 0.001 * ms;
    kit.publish(now);  // the world goes on
    kit.tick(now);
    const double felt = std::abs(kit.device->last.force.x);
    ASSERT_LT(felt, before + 1e-9) << ms << " ms";
    before = felt;
  }
  EXPECT_EQ(kit.device->last.force, glm::dvec3(0.0));
}

/// In every state that a world can be in, silence ends the force.
struct Standing {
  const char* what;
  std::uint32_t run;
  double time;
  double rate;
};

class Silence : public ::testing::TestWithParam<Standing> {};

TEST_P(Silence, EndsTheForceWithin400Milliseconds) {
  const Standing& world = GetParam();
  ServoKit kit;
  const auto say = [&](double wall) {
    BodyMessage& message = kit.channel.bodies().back();
    message = ServoKit::first();
    message.run = world.run;
    message.rate = world.rate;
    message.stamp_ns = to_nanoseconds(wall);
    message.bodies.tick = static_cast<std::uint64_t>(std::lround(world.time / kTick));
    message.bodies.time = world.time;
    kit.channel.bodies().publish();
  };
  double wall = 10.0;
  for (int i = 0; i < 1500; ++i, wall += 0.001) {
    say(wall);
    if (i == 1) kit.device->next.pose = at(0.01);
    kit.tick(wall);
  }
  const bool paused = world.rate <= 0.0 && world.time > 0.0;
  EXPECT_NEAR(kit.device->last.force.x, paused ? 0.0 : -10.0, 1e-6) << world.what;
  double last = kit.device->last.force.x;
  for (int ms = 0; ms < 400; ++ms, wall += 0.001) {
    kit.tick(wall);
    EXPECT_LT(std::abs(kit.device->last.force.x - last), 0.1) << "no jump";
    last = kit.device->last.force.x;
  }
  kit.tick(wall);
  EXPECT_EQ(kit.device->last.force.x, 0.0) << world.what << ": the link was cut 0.4 s ago";
}

INSTANTIATE_TEST_SUITE_P(Servo, Silence,
                         ::testing::Values(Standing{"waiting for the first step", 0, 0.0, 0.0},
                                           Standing{"standing after a reset", 3, 0.0, 0.0},
                                           Standing{"running", 0, 5.0, 1.0},
                                           Standing{"running after a reset", 2, 5.0, 1.0},
                                           Standing{"slow to the extreme", 0, 5.0, 1e-6},
                                           Standing{"paused", 0, 5.0, 0.0}),
                         [](const auto& test) {
                           std::string name = test.param.what;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

TEST(Servo, WaitsAtFullForceForAsLongAsTheWorldSaysSo) {
  ServoKit kit;
  kit.tick(0.0);
  kit.device->next.pose = at(0.01);
  for (int ms = 1; ms <= 5000; ++ms) {
    if (ms % 100 == 0) kit.publish(0.0, {}, {}, 0.0);  // as a host does that waits for people
    kit.tick(0.001 * ms);
    ASSERT_NEAR(kit.device->last.force.x, -10.0, 1e-9) << ms;
  }
}

TEST(Servo, LetsGoOverThreeTenthsOfASecondWhenTheWorldStops) {
  ServoKit kit;
  kit.publish(0.0);
  kit.tick(0.0);
  kit.device->next.pose = at(0.01);
  kit.publish(kTick);
  kit.tick(kTick);
  EXPECT_NEAR(kit.device->last.force.x, -10.0, 1e-9);
  ServoSample sample;
  while (kit.servo->samples().pop(sample)) {
  }
  kit.publish(1.0, {}, {}, 0.0);  // the last state: stopped
  double last = -10.0;
  for (int ms = 0; ms <= 301; ++ms) {
    kit.tick(1.0 + 0.001 * ms);
    EXPECT_LE(kit.device->last.force.x - last, 0.1 / 3.0 + 1e-6);
    last = kit.device->last.force.x;
  }
  EXPECT_NEAR(last, 0.0, 1e-9);
  EXPECT_FALSE(kit.servo->samples().pop(sample)) << "the end is not felt as a drop to zero";
}

TEST(Servo, TheForceComesBackAsGentlyAsItWent) {
  ServoKit kit;
  kit.publish(0.0);
  kit.tick(0.0);
  kit.publish(kTick);
  kit.device->next.pose = at(0.01);
  for (int ms = 1; ms < 1000; ++ms) kit.tick(0.001 * ms);
  EXPECT_EQ(kit.device->last.force.x, 0.0) << "the link was gone for a second";
  double last = 0.0;
  for (int ms = 0; ms <= 4000; ++ms) {
    const double now = 1.0 + 0.001 * ms;
    kit.publish(now);
    kit.tick(now);
    EXPECT_LT(last - kit.device->last.force.x, 0.16) << "no jump at " << ms << " ms";
    last = kit.device->last.force.x;
    if (ms == 100) {
      EXPECT_GT(last, -1.0) << "not even over the time in which a still hand's force comes back";
    }
  }
  EXPECT_NEAR(last, -10.0, 1e-6);
}

TEST(Freshness, WaitsLongerForASlowWorld) {
  EXPECT_EQ(freshness(0.05, 0.001), 1.0);
  EXPECT_EQ(freshness(0.05 + kHoldStale + kFadeStale, 0.001), 0.0);
  EXPECT_EQ(freshness(0.15, 0.04), 1.0) << "a step of 0.04 s may be 0.15 s late";
  EXPECT_EQ(freshness(0.2, 1e6), 1.0);
  EXPECT_EQ(freshness(kSilent, 1e6), 0.0) << "but no world is so slow that a force stays";
}

}  // namespace
}  // namespace slosh
