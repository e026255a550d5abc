// The delays that follow jitter, and the moments of films.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "peer/remote/adaptive_delay.h"
#include "peer/remote/film_times.h"
#include "peer/remote/shown_time.h"

namespace slosh {
namespace {

TEST(AdaptiveDelay, CoversNearlyAllArrivalsAndNoMore) {
  AdaptiveDelay delay;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<> jitter(0.0, 0.040);
  for (int i = 0; i < 5000; ++i) {
    delay.add(0.030 + jitter(random));
    delay.advance(0.002);
  }
  EXPECT_NEAR(delay.value(), 0.030 + 0.95 * 0.040, 0.003);
}

TEST(AdaptiveDelay, MovesSlowlyButLeapsWhereCreepingWouldTakeTooLong) {
  AdaptiveDelay delay;
  for (int i = 0; i < 600; ++i) delay.add(0.010);
  delay.advance(1.0);
  EXPECT_NEAR(delay.value(), 0.010, 1e-9);
  for (int i = 0; i < 600; ++i) delay.add(0.110);
  const double before = delay.value();
  delay.advance(0.1);
  EXPECT_NEAR(delay.value() - before, 0.015, 1e-9) << "15 % of the time that passed";
  for (int i = 0; i < 600; ++i) delay.add(0.9);
  delay.advance(0.001);
  EXPECT_NEAR(delay.value(), 0.9, 1e-9);
}

TEST(AdaptiveDelay, IsNeverNegativeAndIgnoresNonsense) {
  AdaptiveDelay delay;
  for (int i = 0; i < 100; ++i) delay.add(-0.01);
  delay.add(std::numeric_limits<double>::quiet_NaN());
  delay.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(delay.advance(1.0), 0.0);
}

TEST(ShownTime, RunsEvenlyBehindTheWorld) {
  ShownTime shown;
  shown.restart();
  std::mt19937_64 random(5);
  std::uniform_real_distribution<> jitter(0.0, 0.020);
  double last = -1.0;
  int in_time = 0;
  int asked = 0;
  double newest_frame = 0.0;
  for (int ms = 0; ms < 20000; ++ms) {
    const double world = 1e-3 * ms;
    if (ms % 16 == 0) {
      // The frame of 40 ms ago comes in, with jitter.
      const double late = 0.040 + jitter(random);
      shown.arrived(world - late, world);
      newest_frame = std::max(newest_frame, world - late);
    }
    const double at = shown.at(world, std::int64_t{ms} * 1'000'000);
    EXPECT_GE(at, last);
    last = at;
    if (ms < 5000) continue;
    asked += 1;
    if (at <= newest_frame + 0.016) in_time += 1;
  }
  EXPECT_GT(in_time, asked * 9 / 10);
  EXPECT_NEAR(shown.delay(), 0.059, 0.006);
}

TEST(ShownTime, GoesBackOnlyAfterAReset) {
  ShownTime shown;
  shown.restart();
  EXPECT_NEAR(shown.at(10.0, 0), 10.0, 1e-9);
  EXPECT_NEAR(shown.at(9.9, 1), 10.0, 1e-9) << "reckoning jitters, what is shown does not";
  EXPECT_NEAR(shown.at(0.5, 2), 0.5, 1e-9) << "the world was started again";
}

TEST(FilmTimes, LieOnTheGridOfTheWorldsTime) {
  FilmTimes times(30.0);
  EXPECT_FALSE(times.started());
  times.start(1.01);
  EXPECT_DOUBLE_EQ(times.next(), 31.0 / 30.0);
  times.taken();
  EXPECT_DOUBLE_EQ(times.next(), 32.0 / 30.0);
  times.start(2.0);
  EXPECT_DOUBLE_EQ(times.next(), 2.0) << "a moment that is on the grid is taken";
}

TEST(FilmTimes, LongGapsAreLeftOutAndShortOnesAreNot) {
  FilmTimes times(10.0);
  times.start(0.0);
  times.follow(2.0);
  EXPECT_DOUBLE_EQ(times.next(), 0.0);
  times.follow(1e6);
  EXPECT_DOUBLE_EQ(times.next(), 1e6) << "a host cannot ask for a million seconds of film";
  times.follow(5.0);
  EXPECT_DOUBLE_EQ(times.next(), 5.0);
}

}  // namespace
}  // namespace slosh
