// Body states off the wire: parts, loss, order, runs, clocks.
#include "peer/remote/body_inbox.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "net/clock.h"
#include "net/engagement.h"

namespace slosh {
namespace {

constexpr double kStep = 0.002;

Scene two_bodies() {
  Scene scene;
  scene.bodies.resize(2);
  scene.bodies[0].mass.center_of_mass = {0.0, 0.1, 0.0};
  Grip grip;
  grip.body = 1;
  grip.pose.position = {0.2, 0.0, 0.0};
  scene.grips.push_back(grip);
  return scene;
}

wire::Bodies state(std::uint64_t tick, std::uint32_t parts = 1, std::uint32_t part = 0) {
  wire::Bodies m;
  m.tick = tick;
  m.time = kStep * static_cast<double>(tick);
  m.stamp_ns = to_nanoseconds(50.0 + m.time);
  m.rate = 1.0;
  m.parts = parts;
  m.part = part;
  if (parts == 1 || part == 0) {
    wire::BodyEntry entry;
    entry.body = 0;
    entry.pose.position.x = static_cast<double>(tick);
    m.bodies.push_back(entry);
  }
  if (parts == 1 || part == 1) {
    wire::BodyEntry entry;
    entry.body = 1;
    entry.pose.position.x = 100.0 + static_cast<double>(tick);
    m.bodies.push_back(entry);
  }
  return m;
}

/// The same clock at both ends; states arrive `late` after their stamps.
struct Inbox {
  Scene scene = two_bodies();
  BodyInbox inbox{scene, kStep};
  ClockSync clock;
  double late = 0.030;

  Inbox() { clock.add(0, 0, 0, 0); }
  void take(const wire::Bodies& m) { inbox.take(m, m.stamp_ns + to_nanoseconds(late), clock); }
  /// What is due at the moment that state `tick` comes in.
  const BodyMessage* next(std::uint64_t tick) {
    return inbox.next(state(tick).stamp_ns + to_nanoseconds(late), clock);
  }
};

TEST(BodyInbox, StartsAsTheSceneHasIt) {
  const Inbox kit;
  const BodyMessage& first = kit.inbox.state();
  EXPECT_EQ(first.bodies.grips[0].pose.position.x, 0.2);
  EXPECT_EQ(first.bodies.bodies[0].center_of_mass.y, 0.1);
  EXPECT_EQ(first.rate, 0.0);
  EXPECT_FALSE(kit.inbox.started());
}

TEST(BodyInbox, GripsFollowFromTheirBody) {
  Inbox kit;
  wire::Bodies m = state(1);
  wire::BodyEntry& body = m.bodies[1];
  body.pose.orientation = glm::angleAxis(1.57079632679489662, glm::dvec3(0, 0, 1));
  body.center_of_mass = body.pose.position;
  body.twist.linear = {1.0, 0.0, 0.0};
  body.twist.angular = {0.0, 0.0, 2.0};
  wire::GripEntry grip;
  grip.handle.position.y = 7.0;
  grip.on_hand.force.z = -3.0;
  m.grips.push_back(grip);
  kit.take(m);
  const BodyMessage* out = kit.next(1);
  ASSERT_NE(out, nullptr);
  const GripState& g = out->bodies.grips[0];
  EXPECT_NEAR(g.pose.position.x, 101.0, 1e-12);
  EXPECT_NEAR(g.pose.position.y, 0.2, 1e-12);
  EXPECT_NEAR(g.twist.linear.x, 1.0 - 0.4, 1e-12) << "ω × r";
  EXPECT_NEAR(g.twist.angular.z, 2.0, 1e-12);
  EXPECT_EQ(g.handle.position.y, 7.0);
  EXPECT_EQ(g.on_hand.force.z, -3.0);
}

TEST(BodyInbox, PartsOfATickAreJoined) {
  Inbox kit;
  kit.take(state(1, 2, 1));
  kit.take(state(1, 2, 0));
  const BodyMessage* out = kit.next(1);
  ASSERT_NE(out, nullptr);
  EXPECT_EQ(out->bodies.bodies[0].pose.position.x, 1.0);
  EXPECT_EQ(out->bodies.bodies[1].pose.position.x, 101.0);
  EXPECT_EQ(kit.inbox.counts().incomplete, 0u);
  EXPECT_TRUE(kit.inbox.started());
}

TEST(BodyInbox, AMissingPartLeavesItsBodiesAsTheyWere) {
  Inbox kit;
  kit.take(state(1, 2, 0));
  kit.take(state(1, 2, 1));
  kit.take(state(2, 2, 0));
  const BodyMessage* out = kit.next(2);
  ASSERT_NE(out, nullptr);
  EXPECT_EQ(out->bodies.tick, 2u);
  EXPECT_EQ(out->bodies.bodies[0].pose.position.x, 2.0);
  EXPECT_EQ(out->bodies.bodies[1].pose.position.x, 101.0);
  EXPECT_EQ(kit.inbox.counts().incomplete, 1u);
}

TEST(BodyInbox, OldTicksAndRepeatsAreDropped) {
  Inbox kit;
  kit.take(state(5));
  ASSERT_NE(kit.next(5), nullptr);
  kit.take(state(4));
  kit.take(state(5));
  EXPECT_EQ(kit.next(5), nullptr);
  EXPECT_EQ(kit.inbox.counts().late, 2u);
  kit.take(state(6, 2, 0));
  kit.take(state(6, 2, 0));
  EXPECT_EQ(kit.inbox.counts().late, 3u);
}

TEST(BodyInbox, ReorderAndLossNeverLetTimeGoBack) {
  Inbox kit;
  std::mt19937_64 random(11);
  std::uniform_real_distribution<> chance(0.0, 1.0);
  struct Arrival {
    std::int64_t at_ns;
    wire::Bodies m;
  };
  std::vector<Arrival> arrivals;
  for (std::uint64_t tick = 1; tick <= 2000; ++tick) {
    for (std::uint32_t part = 0; part < 2; ++part) {
      if (chance(random) < 0.05) continue;
      wire::Bodies m = state(tick, 2, part);
      arrivals.push_back({m.stamp_ns + to_nanoseconds(0.030 + 0.020 * chance(random)), m});
    }
  }
  std::sort(arrivals.begin(), arrivals.end(),
            [](const Arrival& a, const Arrival& b) { return a.at_ns < b.at_ns; });
  double last = 0.0;
  std::size_t next = 0;
  int smooth = 0;
  int asked = 0;
  const std::int64_t end_ns = arrivals.back().at_ns;
  for (std::int64_t now_ns = arrivals.front().at_ns; now_ns < end_ns; now_ns += 1'000'000) {
    while (next < arrivals.size() && arrivals[next].at_ns <= now_ns) {
      kit.inbox.take(arrivals[next].m, arrivals[next].at_ns, kit.clock);
      next += 1;
    }
    (void)kit.inbox.next(now_ns, kit.clock);
    const BodyMessage& m = kit.inbox.state();
    EXPECT_GE(m.bodies.time, last);
    last = m.bodies.time;
    if (to_seconds(now_ns - arrivals.front().at_ns) < 1.0) continue;
    // What a device loop would take for the time: within two ticks of the state it has.
    asked += 1;
    if (std::abs(to_seconds(now_ns - m.stamp_ns)) <= 2.0 * m.time_step) smooth += 1;
  }
  EXPECT_GT(smooth, asked * 95 / 100);
  EXPECT_NEAR(kit.inbox.delay(), 0.049, 0.003) << "the jitter's upper end";
}

TEST(BodyInbox, StatesAreHandedOnAtAnEvenPaceOverAFarLink) {
  Inbox kit;
  kit.late = 0.200;
  for (std::uint64_t tick = 1; tick <= 500; ++tick) {
    kit.take(state(tick));
    (void)kit.next(tick);
  }
  const BodyMessage& m = kit.inbox.state();
  const std::int64_t now_ns = state(500).stamp_ns + to_nanoseconds(kit.late);
  EXPECT_NEAR(to_seconds(now_ns - m.stamp_ns), 0.0, 2.1 * kStep)
      << "a stamp on the host's clock would be 0.2 s old, and the force would fade";
  EXPECT_NEAR(kit.inbox.delay(), 0.200, 1e-3);
}

TEST(BodyInbox, ARisingRunStartsAnewAndALowerOneIsOld) {
  Inbox kit;
  kit.take(state(900));
  ASSERT_NE(kit.next(900), nullptr);
  wire::Bodies again = state(1);
  again.run = 1;
  again.stamp_ns = state(901).stamp_ns;
  kit.take(again);
  const BodyMessage* out = kit.next(901);
  ASSERT_NE(out, nullptr);
  EXPECT_EQ(out->run, 1u);
  EXPECT_EQ(out->bodies.tick, 1u);
  kit.take(state(902));
  EXPECT_EQ(kit.next(902), nullptr) << "a straggler of the run before";
}

TEST(BodyInbox, ANewConnectionMayBringALowerRun) {
  Inbox kit;
  wire::Bodies m = state(900);
  m.run = 3;
  kit.take(m);
  ASSERT_NE(kit.next(900), nullptr);
  kit.inbox.restart();
  EXPECT_FALSE(kit.inbox.moment().known);
  kit.take(state(905));
  ASSERT_NE(kit.next(905), nullptr);
  EXPECT_EQ(kit.inbox.state().run, 0u);
}

TEST(BodyInbox, NamesThatTheSceneHasNotAreRefusedWhole) {
  Inbox kit;
  wire::Bodies m = state(1);
  m.bodies[1].body = 2;
  kit.take(m);
  wire::Bodies g = state(2);
  g.grips.push_back({});
  g.grips.back().grip = 1;
  kit.take(g);
  wire::Bodies p = state(3);
  p.part = 1;
  kit.take(p);
  EXPECT_EQ(kit.next(3), nullptr);
  EXPECT_EQ(kit.inbox.counts().wrong, 3u);
}

TEST(BodyInbox, AFloodOfTheFutureTakesLittleMemory) {
  Inbox kit;
  for (std::uint64_t tick = 1; tick <= 5000; ++tick) {
    kit.inbox.take(state(tick * 1000), to_nanoseconds(50.0), kit.clock);
  }
  EXPECT_GT(kit.inbox.counts().late, 4000u);
}

TEST(BodyInbox, APauseIsTold) {
  Inbox kit;
  kit.take(state(10));
  ASSERT_NE(kit.next(10), nullptr);
  kit.inbox.set_paused(true);
  const BodyMessage* out = kit.next(11);
  ASSERT_NE(out, nullptr);
  EXPECT_EQ(out->rate, 0.0);
  EXPECT_EQ(kit.next(12), nullptr) << "once";
  kit.inbox.set_paused(false);
  kit.take(state(13));
  EXPECT_EQ(kit.next(13)->rate, 1.0);
}

TEST(BodyInbox, AStallsBacklogSaysNothingOfHowLateStatesCome) {
  for (const double stall : {0.15, 0.5, 1.0, 10.0}) {
    // At once, or over a while through a narrow place, which is still faster than states are made.
    for (const double drained : {0.0, 0.4 * std::min(stall, 0.5)}) {
      Inbox kit;
      const auto ticks = [](double seconds) { return static_cast<std::uint64_t>(seconds / kStep + 0.5); };
      std::uint64_t tick = 1;
      for (; tick <= 1000; ++tick) {
        kit.take(state(tick));
        (void)kit.next(tick);
      }
      const double usual = kit.inbox.delay();
      const std::uint64_t first = tick;
      const std::uint64_t kept = std::min<std::uint64_t>(ticks(stall), 250);  // a queue is only so long
      const std::int64_t begin_ns = state(first + ticks(stall)).stamp_ns + to_nanoseconds(kit.late);
      const auto drain = static_cast<double>(to_nanoseconds(drained)) / static_cast<double>(kept);
      for (std::uint64_t i = 0; i < kept; ++i) {
        const std::int64_t now_ns = begin_ns + static_cast<std::int64_t>(drain * static_cast<double>(i));
        kit.inbox.take(state(first + i), now_ns, kit.clock);
        (void)kit.inbox.next(now_ns, kit.clock);
        EXPECT_NEAR(kit.inbox.delay(), usual, 0.005) << stall << " s stood, state " << i;
      }
      double most = 0.0;
      for (tick = first + ticks(stall) + ticks(drained) + 1; tick < first + ticks(stall) + 3000; ++tick) {
        kit.take(state(tick));
        (void)kit.next(tick);
        most = std::max(most, kit.inbox.delay());
      }
      EXPECT_LT(most, usual + 0.005) << stall;
      EXPECT_EQ(kit.inbox.state().bodies.tick, tick - 1);
    }
  }
}

TEST(BodyInbox, ALinkThatBecameLongerIsFollowed) {
  Inbox kit;
  std::uint64_t tick = 1;
  for (; tick <= 1000; ++tick) {
    kit.take(state(tick));
    (void)kit.next(tick);
  }
  kit.late = 0.330;  // another route: nothing comes for 0.3 s, then all of it so late
  for (; tick <= 2000; ++tick) {
    kit.take(state(tick));
    (void)kit.next(tick);
  }
  EXPECT_NEAR(kit.inbox.delay(), 0.330, 0.005);
}

TEST(BodyInbox, AWorldThatStandsIsGivenOutAsOftenAsItIsToldOf) {
  Inbox kit;
  wire::Bodies waiting = state(0);
  waiting.rate = 0.0;
  kit.take(waiting);
  ASSERT_NE(kit.next(0), nullptr);
  EXPECT_EQ(kit.next(1), nullptr);
  kit.take(waiting);
  const BodyMessage* const again = kit.next(50);
  ASSERT_NE(again, nullptr) << "so that a device loop knows that somebody still says so";
  EXPECT_EQ(again->rate, 0.0);
  EXPECT_EQ(kit.next(51), nullptr);
  EXPECT_EQ(kit.inbox.counts().late, 0u);

  kit.take(state(60));
  ASSERT_NE(kit.next(60), nullptr);
  wire::Bodies stopped = state(60);
  stopped.rate = 0.0;
  kit.take(stopped);
  ASSERT_NE(kit.next(61), nullptr);
  EXPECT_EQ(kit.inbox.state().rate, 0.0);
}

TEST(BodyInbox, AStateTellsWhichOfOurPosesItFollows) {
  Inbox kit;
  EXPECT_EQ(kit.inbox.state().heard_pose_ns, 0) << "far away before anything came";
  kit.take(state(1));
  ASSERT_NE(kit.next(1), nullptr);
  EXPECT_EQ(kit.inbox.state().heard_pose_ns, 0) << "none yet";
  wire::Bodies m = state(2);
  m.pose_number = 7;
  m.pose_stamp_ns = 123'456;
  kit.take(m);
  ASSERT_NE(kit.next(2), nullptr);
  EXPECT_EQ(kit.inbox.state().heard_pose_ns, 123'456);
  EXPECT_EQ(kit.inbox.state().carry_on, kHoldAnew);
}

TEST(BodyInbox, SparseStatesCountAsLongTicks) {
  Inbox kit;
  for (std::uint64_t tick = 8; tick <= 8000; tick += 8) {
    kit.take(state(tick));
    (void)kit.next(tick);
  }
  EXPECT_NEAR(kit.inbox.state().time_step, 0.016, 0.001) << "a device loop carries on by two of them";
}

TEST(BodyInbox, CutsHoldFromTheirTickOnInTheirRun) {
  Inbox box;
  const auto left = [&](std::uint64_t tick, std::uint32_t run = 0) -> double {
    wire::Bodies m = state(tick);
    m.run = run;
    box.take(m);
    EXPECT_NE(box.inbox.next(m.stamp_ns + to_nanoseconds(1.0), box.clock), nullptr);
    const BodyCuts* cuts = box.inbox.state().bodies.cuts.get();
    return cuts && cuts->of(0) ? cuts->of(0)->mass.mass : 0.0;
  };
  const auto cut = [&](std::uint64_t since, double mass) {
    wire::Cuts cuts{0, since, {{0, {{{{1.0, 0.0, 0.0}, 0.1}}, {mass, {}, glm::dmat3(1.0)}}}}};
    cuts.bodies.push_back({7, cuts.bodies[0].cut});  // a body that the scene has not
    box.inbox.take(cuts);
  };
  EXPECT_EQ(left(1), 0.0);
  cut(3, 0.5);
  EXPECT_EQ(left(2), 0.0) << "it came before its state";
  EXPECT_EQ(left(3), 0.5);
  EXPECT_EQ(left(6), 0.5);
  cut(5, 0.25);
  EXPECT_EQ(left(7), 0.25) << "it came after its state";
  EXPECT_EQ(left(8, 1), 0.0) << "the world was reset";
  box.inbox.restart();
  EXPECT_EQ(left(9), 0.0) << "a host that carries on from before the cut";
}

wire::FluidWrench wrench_on(std::uint32_t body, std::uint64_t tick, double force, std::uint32_t run = 0) {
  wire::FluidWrench m;
  m.run = run;
  m.body = body;
  m.tick = tick;
  m.wrench.force.x = force;
  return m;
}

TEST(BodyInbox, TheNewestModelOfEachBodyGoesWithTheState) {
  Inbox box;
  const auto given = [&](std::uint64_t tick, std::uint32_t run = 0) {
    wire::Bodies m = state(tick);
    m.run = run;
    box.take(m);
    const BodyMessage* message = box.inbox.next(m.stamp_ns + to_nanoseconds(1.0), box.clock);
    EXPECT_NE(message, nullptr);
    return box.inbox.state().fluid_models;
  };
  EXPECT_TRUE(given(1).empty());
  box.inbox.take(wrench_on(1, 2, 20.0));
  box.inbox.take(wrench_on(0, 2, 10.0));
  box.inbox.take(wrench_on(1, 3, 30.0));
  box.inbox.take(wrench_on(1, 1, 40.0));  // overtaken
  box.inbox.take(wrench_on(7, 9, 50.0));  // a body that the scene has not
  std::vector<FluidWrenchModel> models = given(3);
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models[0].body, 1u);
  EXPECT_EQ(models[0].wrench.force.x, 30.0);
  EXPECT_EQ(models[1].wrench.force.x, 10.0);
  EXPECT_EQ(box.inbox.counts().models, 3u);
  EXPECT_EQ(box.inbox.counts().wrong, 1u);

  // The world was reset: models of the run before mean nothing, whichever comes first.
  EXPECT_TRUE(given(1, 1).empty());
  box.inbox.take(wrench_on(1, 500, 60.0, 0));
  box.inbox.take(wrench_on(1, 2, 70.0, 2));
  models = given(2, 2);
  ASSERT_EQ(models.size(), 1u);
  EXPECT_EQ(models[0].wrench.force.x, 70.0);
  box.inbox.restart();
  EXPECT_TRUE(box.inbox.state().fluid_models.empty());
}

}  // namespace
}  // namespace slosh
