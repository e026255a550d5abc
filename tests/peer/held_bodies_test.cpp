// When a hand holds this site's replica of a body, and when the host's body as it comes.
#include "peer/haptics/held_bodies.h"

#include <gtest/gtest.h>

#include "net/clock.h"
#include "servo_kit.h"

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
    held.sent(0, {}, true, Pose{}, Twist{}, 0.0, false);
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
    held.sent(0, {}, i >= 1000, hand, Twist{}, 0.0, false);
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
