// The coupling at a distance in virtual time: a quick part of `slosh report coupling`, held to the project's
// targets.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/lab/coupling/cells.h"
#include "tests/lab/coupling/study.h"

namespace slosh::coupling {
namespace {

constexpr double kMaxGenerated = 1e-3;  // J

Case alone() {
  Case c;
  c.name = "alone";
  c.hands = 1;
  return c;
}

/// Every case that broke a scheme, six axes, to 300 ms of round trip.
TEST(CouplingAtADistance, EveryKnownBreakerIsSteady) {
  for (Case c : known_breakers()) {
    for (const double round_trip : {0.1, 0.3}) {
      c.round_trip = round_trip;
      c.seconds = 10.0;
      const Outcome r = run(c, Scheme::kReplica);
      std::printf("%-28s %3.0f ms: %s, %.2g mJ generated, peak %.1f N, swing %.4f m/s\n", c.name.c_str(),
                  1e3 * round_trip, word(r.verdict), 1e3 * r.generated, r.peak, r.swing);
      const std::string what = c.name + " at " + std::to_string(round_trip);
      EXPECT_EQ(r.verdict, Verdict::kStable) << what;
      EXPECT_LE(r.generated, kMaxGenerated) << what;
    }
  }
}

/// A body with fluid that swings, carried by 2, 4 and 8 at 300 ms: with 40 ms of jitter, with 20 % lost, and
/// with both, soft and hard, tight and loose; 12 s each in the report, less here.
TEST(CouplingAtADistance, FluidCarriedByManyIsSteadyWithJitterAndLossApartAndTogether) {
  int tried = 0;
  for (Case c : map_cases(false)) {
    if (c.load != Load::kCarried || c.pose_rate != 500.0 || c.name.find("fluid carried") == std::string::npos)
      continue;
    c.round_trip = 0.3;
    c.seconds = 8.0;
    const Outcome r = run(c, Scheme::kReplica);
    std::printf("%-48s %s, %.2g mJ generated, peak %.1f N, swing %.2f mm/s\n", c.name.c_str(),
                word(r.verdict), 1e3 * r.generated, r.peak, 1e3 * r.swing);
    EXPECT_EQ(r.verdict, Verdict::kStable) << c.name;
    EXPECT_LE(r.generated, kMaxGenerated) << c.name;
    ++tried;
  }
  EXPECT_EQ(tried, 36);
}

/// Where a passivity controller acts the force goes and comes slowly: a bucket whose weight two hands take
/// over where the balance is empty. 24 and 80 steps when each packet's worth was given at once.
TEST(CouplingAtADistance, AControllerThatActsDoesNotRattle) {
  for (Case c : known_breakers()) {
    if (c.load != Load::kCarried) continue;
    c.round_trip = 0.3;
    c.seconds = 6.0;
    const Outcome r = run(c, Scheme::kReplica);
    std::printf("%s: %d steps above 1 N, controllers acting in %.1f %% of the ticks\n", c.name.c_str(),
                r.steps, 1e2 * r.fired);
    EXPECT_GT(r.fired, 0.0) << c.name << ": it acts here";
    EXPECT_LE(r.steps, 20) << c.name;
  }
}

/// The same cases do break the others, so a case says something.
TEST(CouplingAtADistance, TheOtherSchemesBreak) {
  Case c;
  c.round_trip = 0.05;
  EXPECT_EQ(run(c, Scheme::kHostForce).verdict, Verdict::kDiverged);
  c.grip = "loose,mass=1.5";
  c.round_trip = 0.2;
  EXPECT_EQ(run(c, Scheme::kPeerSpring).verdict, Verdict::kDiverged);
  EXPECT_GT(run(c, Scheme::kPeerSpring).generated, 1.0);
}

TEST(CouplingAtADistance, AloneOnTheBodyTheDelayIsNotFelt) {
  for (const char* grip : {"tight", "loose,mass=1.5"}) {
    Case c = alone();
    c.grip = grip;
    c.seconds = 6.0;
    const Outcome reference = run(c, Scheme::kZeroDelay);
    for (const double round_trip : {0.0, 0.05, 0.2, 0.4}) {
      c.round_trip = round_trip;
      const double off = force_error(run(c, Scheme::kReplica), reference);
      std::printf("alone, %s, %.0f ms: force off by %.1f %%\n", grip, 1e3 * round_trip, 1e2 * off);
      EXPECT_LE(off, 0.03);  // 0.10 is asked for
    }
  }
}

/// 1.5 kg that swing at 1.5 Hz, the hand at 0.9: by the host's linear model alone it is off by 36 % at 50 ms,
/// 64 at 200. 10 % are asked for: 8.1 at 400 ms, 10.0 where the host says nothing of the fluid. Before modes
/// between those of the bank were searched for it was 8, 18, 38 % at 200, 300, 400 ms.
TEST(CouplingAtADistance, AloneOnABodyWhoseFluidSwingsTheDelayIsHardlyFelt) {
  for (const Load load : {Load::kFluid, Load::kFluidUntold}) {
    Case c = alone();
    c.load = load;
    const Outcome reference = run(c, Scheme::kZeroDelay);
    const double at_400 = load == Load::kFluid ? 0.10 : 0.12;
    for (const auto& [round_trip, most] :
         {std::pair{0.0, 0.02}, {0.05, 0.02}, {0.1, 0.03}, {0.2, 0.07}, {0.3, 0.10}, {0.4, at_400}}) {
      c.round_trip = round_trip;
      ReplicaTuning without;
      without.follows_slosh = false;
      const Outcome r = run(c, Scheme::kReplica);
      const double off = force_error(r, reference),
                   line = force_error(run(c, Scheme::kReplica, without), reference);
      std::printf("%s, %.0f ms: force off by %.1f %%, without a mode %.1f %%\n",
                  load == Load::kFluid ? "fluid" : "fluid untold", 1e3 * round_trip, 1e2 * off, 1e2 * line);
      EXPECT_LE(off, most);
      EXPECT_EQ(r.verdict, Verdict::kStable);
      EXPECT_LE(r.generated, kMaxGenerated);
      if (round_trip > 0.0) {
        EXPECT_GT(line, 0.3);
      }
    }
  }
}

TEST(CouplingAtADistance, OneOfTwoHandsMoves) {
  Case c;
  c.motion = Motion::kOneMoves;
  c.seconds = 6.0;
  const Outcome reference = run(c, Scheme::kZeroDelay);
  c.round_trip = 0.05;
  const double off = force_error(run(c, Scheme::kReplica), reference);
  const double spring = force_error(run(c, Scheme::kPeerSpring), reference);
  std::printf("one of two moves, 50 ms: force off by %.0f %%, by the peer's spring %.0f %%\n", 1e2 * off,
              1e2 * spring);
  EXPECT_LE(off, 0.40);  // 0.60 is asked for
  EXPECT_GT(spring, 2.0 * off);
}

TEST(CouplingAtADistance, IsTheSameAgain) {
  Case c;
  c.jitter = 0.04;
  c.loss = 0.2;
  c.seconds = 2.0;
  const Outcome one = run(c, Scheme::kReplica), two = run(c, Scheme::kReplica);
  ASSERT_EQ(one.felt.size(), two.felt.size());
  for (std::size_t i = 0; i < one.felt.size(); ++i) ASSERT_EQ(one.felt[i].force, two.felt[i].force) << i;
}

}  // namespace
}  // namespace slosh::coupling
