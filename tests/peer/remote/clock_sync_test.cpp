// The reckoned clock against simulated links: jitter, asymmetry, drift, a host that starts anew.
#include "peer/remote/clock_sync.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "net/clock.h"

namespace slosh {
namespace {

/// Two clocks and the way between them.
struct Way {
  double offset = 1234.5;  // s, host − peer at peer time 0
  double drift = 0.0;
  double there = 0.030;  // s
  double back = 0.030;   // s
  double jitter = 0.0;   // s, exponential, each way
  double peer = 100.0;   // s, the peer's clock
  std::mt19937_64 random{7};

  double host_at(double peer_time) const { return peer_time * (1.0 + drift) + offset; }
  double wait() { return jitter > 0.0 ? std::exponential_distribution<>(1.0 / jitter)(random) : 0.0; }

  bool ping(ClockSync& clock) {
    const double arrives = peer + there + wait();
    const double answered = arrives + 0.0002;
    const double returns = answered + back + wait();
    return clock.add(to_nanoseconds(peer), to_nanoseconds(host_at(arrives)),
                     to_nanoseconds(host_at(answered)), to_nanoseconds(returns));
  }
  /// By how much the clock is wrong now, s.
  double error(const ClockSync& clock, double at) const {
    return to_seconds(clock.to_host(to_nanoseconds(at)) - to_nanoseconds(host_at(at)));
  }
  void burst(ClockSync& clock) {
    for (int i = 0; i < 10; ++i, peer += 0.02) ping(clock);
  }
  void run(ClockSync& clock, double seconds) {
    for (const double end = peer + seconds; peer < end; peer += 0.3) ping(clock);
  }
};

TEST(ClockSync, IsExactOnASymmetricLink) {
  Way way;
  ClockSync clock;
  EXPECT_FALSE(clock.known());
  way.burst(clock);
  EXPECT_TRUE(clock.settled());
  EXPECT_NEAR(way.error(clock, way.peer), 0.0, 1e-6);
  EXPECT_NEAR(clock.round_trip(), 0.060, 1e-6);
}

TEST(ClockSync, IsOffByHalfOfTheAsymmetryAtMost) {
  Way way;
  way.there = 0.050;
  way.back = 0.010;
  ClockSync clock;
  way.burst(clock);
  way.run(clock, 20.0);
  EXPECT_LE(std::abs(way.error(clock, way.peer)), 0.020 + 1e-6);
  EXPECT_LE(std::abs(way.error(clock, way.peer)), clock.error_bound(to_nanoseconds(way.peer)));
}

TEST(ClockSync, TheShortestPingsSeeThroughJitter) {
  Way way;
  way.jitter = 0.020;
  ClockSync clock;
  way.burst(clock);
  way.run(clock, 30.0);
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    way.run(clock, 0.3);
    worst = std::max(worst, std::abs(way.error(clock, way.peer)));
    EXPECT_LE(std::abs(way.error(clock, way.peer)), clock.error_bound(to_nanoseconds(way.peer)));
  }
  EXPECT_LT(worst, 0.010) << "a single ping is off by 10 ms on average, and by 40 now and then";
  EXPECT_EQ(clock.steps(), 0u);
}

TEST(ClockSync, FollowsADriftOf100PartsAMillion) {
  Way way;
  way.drift = 1e-4;
  way.jitter = 0.002;
  ClockSync clock;
  way.burst(clock);
  way.run(clock, 60.0);
  EXPECT_NEAR(clock.drift(), 1e-4, 5e-5);
  for (int i = 0; i < 100; ++i) {
    way.run(clock, 0.3);
    EXPECT_LT(std::abs(way.error(clock, way.peer)), 0.0015);
  }
  EXPECT_EQ(clock.steps(), 0u);
}

TEST(ClockSync, NeverStepsAndNeverRunsFasterThanItSaysOnceSettled) {
  Way way;
  way.jitter = 0.015;
  ClockSync clock;
  way.burst(clock);
  double last_peer = way.peer;
  std::int64_t last_host_ns = clock.to_host(to_nanoseconds(last_peer));
  for (int i = 0; i < 4000; ++i) {
    way.peer += 0.01;
    if (i % 30 == 0) {
      const double here = way.peer;
      way.ping(clock);
      way.peer = here + 0.25;  // after the answer
    }
    const std::int64_t host_ns = clock.to_host(to_nanoseconds(way.peer));
    const double passed = to_seconds(host_ns - last_host_ns);
    const double real = way.peer - last_peer;
    ASSERT_LE(std::abs(passed - real), (kMaxClockSlew + 6e-4) * real + 1e-6) << i;
    last_peer = way.peer;
    last_host_ns = host_ns;
  }
  EXPECT_EQ(clock.steps(), 0u);
}

TEST(ClockSync, ToPeerUndoesToHost) {
  Way way;
  way.drift = 2e-4;
  way.jitter = 0.01;
  ClockSync clock;
  way.burst(clock);
  way.run(clock, 30.0);
  for (double at = way.peer - 1.0; at < way.peer + 3.0; at += 0.1) {
    EXPECT_NEAR(to_seconds(clock.to_peer(clock.to_host(to_nanoseconds(at))) - to_nanoseconds(at)), 0.0, 1e-7);
  }
}

TEST(ClockSync, AHostThatIsStartedAnewHasAnotherClock) {
  Way way;
  ClockSync clock;
  way.burst(clock);
  way.run(clock, 5.0);
  way.offset = -777.0;
  way.run(clock, 3.0);
  EXPECT_EQ(clock.steps(), 1u);
  EXPECT_NEAR(way.error(clock, way.peer), 0.0, 1e-6);
}

TEST(ClockSync, ANewConnectionMayStepAtOnce) {
  Way way;
  ClockSync clock;
  way.burst(clock);
  clock.restart();
  EXPECT_FALSE(clock.settled());
  EXPECT_NEAR(way.error(clock, way.peer), 0.0, 1e-6) << "until then the old mapping holds";
  way.offset = 5.0;
  way.burst(clock);
  EXPECT_NEAR(way.error(clock, way.peer), 0.0, 1e-6);
  EXPECT_EQ(clock.steps(), 0u) << "not settled, so nobody was promised anything";
}

TEST(ClockSync, OneOutlierIsNotBelieved) {
  Way way;
  ClockSync clock;
  way.burst(clock);
  way.run(clock, 3.0);
  const double offset = way.offset;
  way.offset += 10.0;
  way.ping(clock);
  way.offset = offset;
  EXPECT_NEAR(way.error(clock, way.peer + 0.1), 0.0, 1e-6);
}

TEST(ClockSync, WhatCannotBeIsLeftOut) {
  ClockSync clock;
  const std::int64_t huge = std::numeric_limits<std::int64_t>::max();
  const std::int64_t second = kNanosecondsPerSecond;
  EXPECT_FALSE(clock.add(second, 5, 6, second - 1)) << "answered before it was sent";
  EXPECT_FALSE(clock.add(0, 5 * second, 3 * second, second)) << "the host's clock went back";
  EXPECT_FALSE(clock.add(0, 0, 2 * second, second)) << "longer at the host than away";
  EXPECT_FALSE(clock.add(0, 0, 1, 11 * second));
  EXPECT_FALSE(clock.add(0, huge, huge, second));
  EXPECT_FALSE(clock.add(0, -huge, -huge, second));
  EXPECT_FALSE(clock.known());
  // Whatever is asked of it, it answers.
  Way way;
  way.burst(clock);
  for (const std::int64_t stamp : {huge, -huge, std::int64_t{0}}) {
    (void)clock.to_host(stamp);
    (void)clock.to_peer(stamp);
  }
}

TEST(PingSchedule, BurstsAndThenTakesItsTime) {
  PingSchedule pings;
  pings.restart(1000);
  EXPECT_EQ(pings.due_ns(), 1000);
  std::int64_t now_ns = 1000;
  int in_half_a_second = 0;
  int in_ten_seconds = 0;
  for (; now_ns < 10 * kNanosecondsPerSecond; now_ns += 1'000'000) {
    if (now_ns < pings.due_ns()) continue;
    pings.sent(now_ns);
    in_half_a_second += now_ns < kNanosecondsPerSecond / 2 ? 1 : 0;
    in_ten_seconds += 1;
  }
  EXPECT_GE(in_half_a_second, 10);
  EXPECT_LE(in_half_a_second, 12);
  EXPECT_GE(in_ten_seconds, 30);
  EXPECT_LE(in_ten_seconds, 50);
}

}  // namespace
}  // namespace slosh
