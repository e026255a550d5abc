// The replica of a held body against the host's own solve, and its parts against what they promise.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "net/clock.h"
#include "peer/replica/body_replica.h"
#include "peer/replica/load_work.h"
#include "sim/bodies/body_solve.h"

namespace slosh {
namespace {

constexpr double kTick = 0.001;

ReplicaBody replica_bucket() {
  ReplicaBody body;
  body.mass = 2.5;
  body.inertia = glm::dmat3(0.0);
  body.inertia[0][0] = 0.03;
  body.inertia[1][1] = 0.02;
  body.inertia[2][2] = 0.04;
  body.center = {0.01, 0.02, -0.01};
  return body;
}

std::vector<ReplicaGrip> replica_grips() {
  const CouplingGains gains{2000.0, 60.0, 20.0, 0.6};
  return {{{{0.15, 0.1, 0.0}, {1, 0, 0, 0}}, gains},
          {{{-0.15, 0.1, 0.02}, glm::normalize(glm::dquat(0.9, 0.1, 0.2, 0.0))}, gains}};
}

ReplicaHand hand_at(double time, int i) {
  ReplicaHand hand;
  hand.engaged = hand.own = true;
  const double s = i == 0 ? 1.0 : -0.5;
  hand.handle.position = {0.15 * (i == 0 ? 1 : -1) + 0.05 * s * std::sin(5.0 * time), 0.1,
                          0.03 * s * std::sin(7.0 * time)};
  hand.twist.linear = {0.25 * s * std::cos(5.0 * time), 0.0, 0.21 * s * std::cos(7.0 * time)};
  hand.handle.orientation = rotate_by({1, 0, 0, 0}, {0.0, 0.4 * s * std::sin(3.0 * time), 0.0});
  hand.twist.angular = {0.0, 1.2 * s * std::cos(3.0 * time), 0.0};
  return hand;
}

/// The same body as the host solves it, free and at rest.
RigidBody on_the_host(const ReplicaBody& body) {
  RigidBody host;
  host.free = true;
  host.mass = body.mass;
  host.inertia = body.inertia;
  host.inverse_inertia = glm::inverse(body.inertia);
  host.local_center = body.center;
  host.position = body.center;
  return host;
}

/// With hands of this site alone, it is the host's own solve at the device loop's step.
TEST(Replica, MovesAsTheHostsSolveDoes) {
  const ReplicaBody body = replica_bucket();
  const std::vector<ReplicaGrip> grips = replica_grips();
  BodyReplica replica(body, grips);
  RigidBody host = on_the_host(body);
  replica.restart({host.position, host.orientation, {}});
  FluidLoad weight;
  weight.wrench = {0.0, -9.81 * body.mass, 0.0, 0.0, 0.0, 0.0};
  replica.set_load(weight);
  std::vector<ReplicaHand> hands(2);
  double farthest = 0.0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<ActiveCoupling> couplings;
    for (int g = 0; g < 2; ++g) {
      const auto at = static_cast<std::size_t>(g);
      hands[at] = hand_at(kTick * i, g);
      ActiveCoupling c;
      c.grip = g;
      c.gains = grips[at].gains;
      c.handle = hands[at].handle;
      c.handle_twist = hands[at].twist;
      c.grip_pose = compose(host.mesh_pose(), grips[at].pose);
      c.arm = c.grip_pose.position - host.position;
      couplings.push_back(c);
    }
    BodySolve solve;
    ASSERT_TRUE(solve_body(host, {{0.0, -9.81 * body.mass, 0.0}, {}}, couplings, kTick, solve));
    advance_body(host, solve, kTick);
    replica.advance(hands, kTick, i + 1);
    farthest = std::max(farthest, glm::length(replica.motion().position - host.position));
    farthest = std::max(farthest,
                        0.1 * glm::length(rotation_between(host.orientation, replica.motion().orientation)));
  }
  // The host keeps angular momentum over a turn, the replica the gyroscopic torque of its start: 0.07 mm
  // here.
  EXPECT_LT(farthest, 2e-4);
  EXPECT_GT(glm::length(host.velocity), 0.01) << "it moves";
}

/// Weight and a drag on a body that a hand swings and turns: what they gave is told by the body's motion and
/// by what its couplings were given, also where most words are lost.
TEST(LoadWork, IsWhatActsBesidesGave) {
  const ReplicaBody body = replica_bucket();
  const std::vector<ReplicaGrip> grips = replica_grips();
  for (const int each : {1, 3, 5}) {
    LoadWork work(body, grips);
    RigidBody host = on_the_host(body);
    const double dt = 0.002;
    double truth = 0.0, most = 0.0, more = 0.0, less = 0.0;
    for (int i = 0; i < 2000; ++i) {
      std::vector<ActiveCoupling> couplings;
      for (int g = 0; g < 2; ++g) {
        const ReplicaHand hand = hand_at(dt * i, g);
        ActiveCoupling& c = couplings.emplace_back();
        c.gains = grips[static_cast<std::size_t>(g)].gains;
        c.handle = hand.handle;
        c.handle_twist = hand.twist;
        c.grip_pose = compose(host.mesh_pose(), grips[static_cast<std::size_t>(g)].pose);
        c.arm = c.grip_pose.position - host.position;
      }
      const Wrench acting{glm::dvec3(0.0, -9.81 * body.mass, 0.0) - 8.0 * host.velocity,
                          -0.05 * host.angular_velocity};
      const RigidBody before = host;
      BodySolve solve;
      ASSERT_TRUE(solve_body(host, acting, couplings, dt, solve));
      advance_body(host, solve, dt);
      truth += glm::dot(acting.force, host.position - before.position) +
               glm::dot(acting.torque, rotation_between(before.orientation, host.orientation));
      // An implicit step takes this out of the motion; nobody gets it.
      const glm::dvec3 gained = host.velocity - before.velocity;
      const glm::dvec3 spun = host.angular_velocity - before.angular_velocity;
      const glm::dmat3 r = glm::mat3_cast(host.orientation);
      truth -= 0.5 * body.mass * glm::dot(gained, gained) +
               0.5 * glm::dot(spun, r * body.inertia * glm::transpose(r) * spun);
      std::vector<HostHand> said(2);
      for (std::size_t g = 0; g < 2; ++g) {
        const Wrench on_body = coupling_wrench(couplings[g], solve, dt);
        said[g].on_hand = {-on_body.force, -on_body.torque};
      }
      if (i % each != 0) continue;
      HostUpdate word;
      word.time = dt * i;
      word.time_step = dt;
      word.motion = {host.position, host.orientation, {host.velocity, host.angular_velocity}};
      word.hands = said;
      if (i == 0) truth = 0.0;
      work.receive(word);
      most = std::max(most, std::abs(truth));
      more = std::max(more, work.work() - truth);
      less = std::max(less, truth - work.work());
    }
    std::printf("each %d. word: %.1f %% more or %.1f %% less than %.2f J at most\n", each,
                100.0 * more / most, 100.0 * less / most, most);
    EXPECT_LT(more, 0.05 * most) << each;
    EXPECT_LT(less, (each == 1 ? 0.05 : 0.12 * each) * most) << each;
  }
}

/// A load that is not trusted gives nothing: what it drove is taken out of the motion.
TEST(Replica, ALoadThatIsNotBelievedDrivesNothing) {
  for (const double trust : {1.0, 0.0}) {
    BodyReplica replica(replica_bucket(), replica_grips());
    replica.restart({});
    replica.trust_load(trust);
    FluidLoad push;
    push.wrench = {5.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    replica.set_load(push);
    const std::vector<ReplicaHand> nobody(2);
    for (int i = 0; i < 500; ++i) replica.advance(nobody, kTick, to_nanoseconds(kTick * (i + 1)));
    const double speed = replica.motion().twist.linear.x;
    if (trust == 1.0) {
      EXPECT_NEAR(speed, 1.0, 0.01);
      EXPECT_NEAR(replica.work(), replica.stored(), 0.01);
    } else {
      EXPECT_LT(speed, 0.1);
    }
    // The host's own count is trusted in any case.
    replica.receive({replica.motion(), to_nanoseconds(0.4), 0.7});
    replica.advance(nobody, kTick, to_nanoseconds(0.501));
    EXPECT_EQ(replica.work_received(), 0.7);
  }
}

TEST(Replica, TakesTheHostsWordOverByItsTimeConstant) {
  BodyReplica replica(replica_bucket(), {});
  replica.restart({});
  replica.set_delay({0.1, 0.0});
  EXPECT_NEAR(replica.time_constant(), 0.2, 1e-12);
  for (int i = 0; i < 100; ++i) replica.advance({}, kTick, 1'000'000 * (i + 1));
  RigidMotion word;
  word.position = {0.01, 0.0, 0.0};
  word.orientation = rotate_by(word.orientation, {0.0, 0.02, 0.0});
  for (int i = 100; i < 300; ++i) {
    replica.receive({word, 1'000'000 * (i - 50)});
    replica.advance({}, kTick, 1'000'000 * (i + 1));
  }
  // A time constant later 63 % is made good: the history moved along, so nothing was made good twice.
  const double left = std::exp(-1.0);
  EXPECT_NEAR(replica.motion().position.x, 0.01 * (1.0 - left), 1e-5);
  EXPECT_NEAR(rotation_between({1, 0, 0, 0}, replica.motion().orientation).y, 0.02 * (1.0 - left), 2e-5);
}

TEST(Replica, AWordOfAMomentThatIsStillToComeWaitsForIt) {
  BodyReplica replica(replica_bucket(), {});
  RigidMotion moving;
  moving.twist.linear = {1.0, 0.0, 0.0};
  replica.restart(moving);
  for (int i = 0; i < 100; ++i) {
    replica.advance({}, kTick, 1'000'000 * (i + 1));
    RigidMotion word = moving;  // just where the replica is going to be 2 ms from now
    word.position.x = kTick * (i + 3);
    replica.receive({word, 1'000'000 * (i + 3)});
  }
  EXPECT_NEAR(replica.motion().position.x, 0.1, 1e-9);
}

TEST(Replica, OthersPullLessTheLaterTheyArrive) {
  BodyReplica replica(replica_bucket(), replica_grips());
  replica.restart({});
  std::vector<ReplicaHand> hands{hand_at(0.0, 0), hand_at(0.0, 1)};
  hands[1].own = false;
  double before = 2.0;
  for (const double round_trip : {0.0, 0.02, 0.1, 0.5}) {
    replica.set_delay({round_trip, 0.0});
    replica.advance(hands, kTick, 1);
    // s = 1/(1 + (0.7·ω₀·RTT)²), ω₀² = ΣK/M.
    const double late = 0.7 * round_trip;
    EXPECT_NEAR(replica.softness(), 1.0 / (1.0 + late * late * 4000.0 / 2.5), 1e-12);
    EXPECT_LT(replica.softness(), before);
    before = replica.softness();
  }
  EXPECT_NEAR(replica.shared(), 0.5, 1e-12);
}

/// Somebody elsewhere whose own count says that they gave nothing cannot drive the body here.
TEST(Replica, AHandThatPutNothingInGivesNothing) {
  const auto speed_after = [](bool counted) {
    BodyReplica replica(replica_bucket(), replica_grips());
    replica.restart({replica_bucket().center, {1, 0, 0, 0}, {}});
    std::vector<ReplicaHand> hands(2);
    double fastest = 0.0;
    for (int i = 0; i < 2000; ++i) {
      hands[0] = hand_at(kTick * i, 0);
      hands[0].own = false;
      hands[0].energy = counted ? 10.0 * kTick * i : 0.0;
      replica.advance(hands, kTick, i + 1);
      fastest = std::max(fastest, glm::length(replica.motion().twist.linear));
    }
    return fastest;
  };
  EXPECT_GT(speed_after(true), 0.2);
  EXPECT_LT(speed_after(false), 0.8 * speed_after(true));
  std::printf("%.3f m/s with energy behind it, %.3f without\n", speed_after(true), speed_after(false));
}

TEST(FluidLoad, WhatWouldDriveIsLeftOut) {
  FluidLoad load;
  load.wrench[1] = -3.0;
  load.d_velocity[0][0] = 5.0;  // a damper that pushes
  load.d_pose[2][2] = -10.0;
  EXPECT_EQ(made_safe(load).d_velocity[0][0], 0.0);
  EXPECT_EQ(made_safe(load).d_pose[2][2], -10.0);
  EXPECT_EQ(made_safe(load).wrench[1], -3.0);
  load.d_velocity[0][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(made_safe(load).wrench[1], 0.0);
  FluidLoad light;
  light.added_mass[3][3] = -1.0;
  EXPECT_EQ(made_safe(light).added_mass[3][3], 0.0);
}

TEST(FluidLoad, ANumberThatIsNoneInAnyFieldLeavesNothing) {
  int fields = 0;
  for_each_load_field([&](const auto& row) {
    FluidLoad load;
    load.wrench[1] = -3.0;
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    std::memcpy(static_cast<void*>(&(load.*row.field)), &kNone, sizeof kNone);
    EXPECT_EQ(made_safe(load).wrench[1], 0.0) << fields;
    fields += 1;
  });
  EXPECT_EQ(fields, 13);
}

TEST(Replica, NoLoadMakesItLeaveTheWorld) {
  BodyReplica replica(replica_bucket(), {});
  replica.restart({});
  FluidLoad load;
  load.wrench[0] = std::numeric_limits<double>::infinity();
  replica.set_load(load);
  replica.advance({}, kTick, 1);
  EXPECT_EQ(replica.motion().position, glm::dvec3(0.0));
}

TEST(LoopDelay, IsTheEnvelopeOfTheAges) {
  LoopDelayEstimate estimate;
  EXPECT_FALSE(estimate.known());
  for (int i = 0; i < 5000; ++i) estimate.note(0.1 + 0.04 * ((i * 37) % 100) / 99.0, 0.002);
  EXPECT_NEAR(estimate.delay().round_trip, 0.1, 0.004);
  EXPECT_NEAR(estimate.delay().jitter, 0.04, 0.006);
  for (int i = 0; i < 15000; ++i) estimate.note(0.3, 0.002);  // another way through the network
  EXPECT_NEAR(estimate.delay().round_trip, 0.3, 0.002);
  EXPECT_LT(estimate.delay().jitter, 0.001);
  estimate.note(std::numeric_limits<double>::quiet_NaN(), 0.002);
  estimate.note(1e9, 0.002);
  EXPECT_LE(estimate.delay().round_trip + estimate.delay().jitter, LoopDelayEstimate::kLongest);
}

}  // namespace
}  // namespace slosh
