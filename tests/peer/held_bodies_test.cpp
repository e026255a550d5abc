// When a hand holds this site's replica of a body, and when the host's body as it comes.
#include "peer/haptics/held_bodies.h"

#include <gtest/gtest.h>

#include <utility>

#include "net/clock.h"
#include "servo_kit.h"
#include "swinging_host.h"

namespace slosh {
namespace {

struct Site {
  Coupling coupling = Coupling::kReplica;
  bool here = true;      // the host is in this process
  bool modelled = true;  // and says a model of the fluid's wrench
};

/// Of tick `i` of a device loop at 1 kHz, beside a world at 100 Hz.
BodyMessage state_at(int i, std::int64_t now_ns) {
  BodyMessage message = test::ServoKit::first();
  message.rate = 1.0;
  message.time_step = 0.01;
  message.stamp_ns = now_ns;
  message.bodies.tick = static_cast<std::uint64_t>(1 + i / 10);
  message.bodies.time = 0.001 * i;
  message.bodies.grips[0].on_hand.force.x = 1e-6;  // somebody holds it
  return message;
}

/// How far the replica counts after `seconds` of states at 100 Hz.
double share_of(const Site& site, double seconds) {
  Scene scene = test::one_grip_scene();
  scene.bodies[0].motion = BodyMotion::kFree;
  scene.bodies[0].mass.mass = 0.2;
  scene.bodies[0].mass.inertia = glm::dmat3(1e-3);
  HeldBodies held(scene, site.coupling);
  std::int64_t now_ns = to_nanoseconds(10.0);
  BodyMessage message;
  for (int i = 0; i < static_cast<int>(seconds / 0.001); ++i, now_ns += 1'000'000) {
    const bool fresh = i % 10 == 0;
    if (fresh) {
      message = state_at(i, now_ns);
      message.heard_pose_ns = site.here ? kPoseNotTold : now_ns;
      message.hands.resize(1);
      message.hands[0].number = message.bodies.tick;
      message.hands[0].read_ns = now_ns - 2'000'000;
      message.hands[0].time = message.bodies.time - 0.01;
      if (site.modelled) {
        FluidWrenchModel& model = message.fluid_models.emplace_back();
        model.body = 0;
        model.tick = message.bodies.tick;
      }
    }
    held.update(message, fresh, now_ns);
    held.sent(0, {}, {true, true, Pose{}, Twist{}, true}, 0.0, false);
    held.advance(now_ns + 1'000'000, 1.0, 0.001);
  }
  return held.share(0);
}

TEST(HeldBodies, InOneProcessTheReplicaIsForWhatTheFluidIsKnownOf) {
  EXPECT_EQ(share_of({}, 1.0), 1.0);
  EXPECT_LT(share_of({}, 0.1), 0.5) << "it comes in over half a second";
  EXPECT_EQ(share_of({Coupling::kReplica, true, false}, 1.0), 0.0) << "else the host's own body is as new";
  EXPECT_EQ(share_of({Coupling::kSpring, true, true}, 1.0), 0.0);
}

TEST(HeldBodies, WhatNobodyHereMovesIsNotFollowed) {
  Scene scene = test::one_grip_scene();
  scene.gravity = glm::dvec3(0.0);
  scene.bodies[0].motion = BodyMotion::kFree;
  scene.bodies[0].mass = {0.2, glm::dvec3(0.0), glm::dmat3(1e-3)};
  HeldBodies held(scene, Coupling::kReplica);
  std::int64_t now_ns = to_nanoseconds(10.0);
  BodyMessage message;
  const auto go_on = [&](int ticks, bool moved) {
    for (int i = 0; i < ticks; ++i, now_ns += 1'000'000) {
      const bool fresh = i % 10 == 0;
      if (fresh) {
        message = state_at(static_cast<int>(now_ns / 1'000'000 - 10'000), now_ns);
        message.bodies.grips[0].on_hand = {};
        message.fluid_models.emplace_back().tick = message.bodies.tick;
      }
      held.update(message, fresh, now_ns);
      if (moved)
        held.sent(0, {}, {true, false, Pose{}, Twist{}, true}, 0.0, false);
      else
        held.not_here(0);
      held.advance(now_ns + 1'000'000, 1.0, 0.001);
    }
  };
  go_on(1000, true);
  EXPECT_TRUE(held.held(0)->started());
  EXPECT_EQ(held.share(0), 1.0);
  go_on(20, false);
  EXPECT_FALSE(held.held(0)->started());
  EXPECT_EQ(held.share(0), 0.0) << "a hand that takes it up goes on from the host's body";
  go_on(100, true);
  EXPECT_TRUE(held.held(0)->started());
  EXPECT_GT(held.share(0), 0.0);
  EXPECT_LT(held.share(0), 0.5);
}

TEST(HeldBodies, OnlyAHandThatFeelsLooksForWhatSwings) {
  const auto found_by = [](bool feels) {
    test::SwingingHost host;
    HeldBodies held(host.scene, Coupling::kReplica);
    for (int ms = 0; ms < 3000; ++ms) {
      const BodyMessage word = host.word(ms);
      const DeviceReport hand = host.hand(ms);
      held.update(word, ms % 2 == 0, to_nanoseconds(0.001 * ms));
      (void)held.guard(0, word.bodies.grips[0].on_hand, hand.pose, hand.twist, 0.001, 500.0, 1.0);
      held.sent(0, word.bodies.grips[0].on_hand, {true, true, hand.pose, hand.twist, feels}, 0.0, false);
      held.advance(to_nanoseconds(0.001 * (ms + 1)), 1.0, 0.001);
    }
    return std::pair(held.held(0)->slosh(0).mode().mass, held.energy(0));
  };
  const auto [swings, energy] = found_by(true);
  EXPECT_GT(swings, 0.5);
  EXPECT_NE(energy, 0.0);
  EXPECT_EQ(found_by(false), std::pair(0.0, energy)) << "what its person puts in is counted all the same";
}

/// Where its grip is after a second in which a hand 1 cm away pulls at the replica.
double pulled_to(double mass, const std::shared_ptr<const BodyCuts>& cuts) {
  Scene scene = test::one_grip_scene();
  scene.gravity = glm::dvec3(0.0);
  scene.bodies[0].motion = BodyMotion::kFree;
  scene.bodies[0].mass = {mass, glm::dvec3(0.0), glm::dmat3(1e-3)};
  HeldBodies held(scene, Coupling::kReplica);
  std::int64_t now_ns = to_nanoseconds(10.0);
  Pose hand;
  hand.position.x = 0.01;
  BodyMessage message;
  for (int i = 0; i < 1005; ++i, now_ns += 1'000'000) {
    const bool fresh = i % 10 == 0;
    if (fresh) {
      message = state_at(i, now_ns);
      message.bodies.cuts = cuts;
      message.fluid_models.emplace_back().tick = message.bodies.tick;
    }
    held.update(message, fresh, now_ns);
    held.sent(0, {}, {true, i >= 1000, hand, Twist{}, true}, 0.0, false);
    held.advance(now_ns + 1'000'000, 1.0, 0.001);
  }
  return held.grip(0, GripState{}).pose.position.x;
}

TEST(HeldBodies, APartThatWasCutOffHasItsOwnMass) {
  const auto cuts = std::make_shared<BodyCuts>();
  cuts->bodies.push_back({{{{1.0, 0.0, 0.0}, 0.0}}, {0.05, glm::dvec3(0.0), glm::dmat3(1e-3)}});
  const double whole = pulled_to(0.2, nullptr), part = pulled_to(0.05, nullptr);
  EXPECT_GT(part, 1.2 * whole) << "the same pull moves it farther";
  EXPECT_EQ(pulled_to(0.2, cuts), part);
}

}  // namespace
}  // namespace slosh
