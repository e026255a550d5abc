// One hand on a bucket of real water, over a delay: particles, models and replica, in virtual time.
#include "tests/lab/coupling/water_study.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace slosh::coupling {
namespace {

/// 24 mm at 0.99 Hz: 10 % are asked for.
TEST(WaterAtADistance, AHandThatSwingsItFeelsItAsIfItWereHere) {
  WaterCase c;
  c.way = 2;
  const WaterRun run = run_water(c).value();
  const WaterSplit split = split_water(run);
  std::printf("%.1f N; of it a rigid mass leaves %.0f %%, modes %.1f %%, with their lift %.1f %%\n",
              water_force(run), 1e2 * split.rigid, 1e2 * split.modes, 1e2 * split.lifts);
  EXPECT_GT(split.rigid, 0.25);
  EXPECT_LT(split.lifts, 0.05);
  ReplicaTuning by_line;
  by_line.follows_slosh = false;
  for (const auto& [round_trip, most] : {std::pair{0.05, 0.065}, {0.1, 0.09}, {0.2, 0.08}, {0.4, 0.085}}) {
    const double off = water_error(feel_water(run, round_trip).value(), run);
    const double line = water_error(feel_water(run, round_trip, by_line).value(), run);
    std::printf("%.0f ms: force off by %.1f %%, by the host's line alone %.1f %%\n", 1e3 * round_trip,
                1e2 * off, 1e2 * line);
    EXPECT_LE(off, most);
    EXPECT_GT(line, 2.0 * off);
  }
}

/// A simulated person on the same way, whose arm gives way: what they feel moves them elsewhere, by a
/// millimetre, and so the water. What the coupling is answerable for is the force off what would be right for
/// the motion that there was.
TEST(WaterAtADistance, APersonWhoGivesWayFeelsWhatIsRightForWhereTheyWent) {
  WaterCase c;
  c.way = 2;
  c.grip = "tight,correction=0";
  const WaterRun run = run_water(c).value();
  std::vector<DeviceReport> went;
  const std::vector<Wrench> felt = feel_water(run, 0.4, {}, &went).value();
  const double off = water_error(felt, run_water_again(c, went).value()), whole = water_error(felt, run);
  std::printf("400 ms: force off by %.1f %% for the same motion, by %.1f %% with where it led\n", 1e2 * off,
              1e2 * whole);
  EXPECT_LE(off, 0.085);
  EXPECT_LE(whole, 0.35);
}

/// One with a loose arm, who lets the bucket tip: 17 of 23 N pour out within a second, which no model
/// foresees. Off by as much as if the whole force were known late; 38 % where weight was trusted over a
/// second.
TEST(WaterAtADistance, AnArmWhoseBucketPoursFeelsItGoLighter) {
  WaterCase c;
  c.way = 2;
  c.grip = "loose,correction=0";
  const WaterRun run = run_water(c).value();
  std::vector<DeviceReport> went;
  const std::vector<Wrench> felt = feel_water(run, 0.1, {}, &went).value();
  const WaterRun right = run_water_again(c, went).value();
  const double off = water_error(felt, right), late = late_error(right, 0.1);
  const double lost = right.steps.back().felt.force.y - right.steps.front().felt.force.y;
  std::printf("100 ms: %.1f N poured out, force off by %.1f %% for the same motion, known late by %.1f %%\n",
              lost, 1e2 * off, 1e2 * late);
  EXPECT_GT(lost, 8.0);
  EXPECT_LE(off, 0.14);  // 12.7 % on an Intel Xeon, 13.1 on an AMD EPYC, which rounds otherwise
}

/// 23 mm near the water's own pace, where it goes round and splashes: no model holds, and two runs that
/// nobody could tell apart differ by a quarter. What is felt stays a force of that size.
TEST(WaterAtADistance, WaterThatGoesWildIsNoBlow) {
  WaterCase c;
  c.way = 1;
  const WaterRun run = run_water(c).value();
  for (const double round_trip : {0.1, 0.2, 0.4}) {
    const double off = water_error(feel_water(run, round_trip).value(), run);
    std::printf("%.0f ms: force off by %.0f %% of %.1f N\n", 1e3 * round_trip, 1e2 * off, water_force(run));
    EXPECT_LE(off, 0.8);
  }
}

}  // namespace
}  // namespace slosh::coupling
