// What a host says of its pace, and when its states belong, on a clock that the test moves.
#include "host/pace_line.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <functional>

namespace slosh {
namespace {

constexpr double kStep = 0.002;  // s

struct Said {
  double rate = 0.0;     // at the end
  double least = 1.0;    // in the second half
  double most = 0.0;     // the same
  double crooked = 0.0;  // s, the most that two stamps are off what the rate says between them, second half
  double off = 0.0;      // s, the most that a state's stamp is off when it was ready, second half
  bool slow = false;     // at the end
};

/// `takes(i)`: s that step i takes.
Said said_of(double seconds, double pace, const std::function<double(int)>& takes) {
  Pacer pacer(kStep / pace);
  PaceLine line;
  std::int64_t now = to_nanoseconds(5.0);
  const std::int64_t begin = now;
  pacer.restart(now);
  line.restart(now);
  Said said;
  std::int64_t before = 0;
  for (int i = 0; to_seconds(now - begin) < seconds; ++i) {
    const Pacer::Turn turn = pacer.next(now);
    now = std::max(now, turn.deadline_ns) + to_nanoseconds(takes(i));
    const PaceLine::Moment moment = line.after_step(kStep, pace, turn, now);
    EXPECT_GE(moment.stamp_ns, before);
    EXPECT_GT(moment.rate, 0.0);
    EXPECT_LE(moment.rate, pace);
    if (to_seconds(now - begin) > 0.5 * seconds) {
      said.least = std::min(said.least, moment.rate);
      said.most = std::max(said.most, moment.rate);
      said.crooked =
          std::max(said.crooked, std::abs(to_seconds(moment.stamp_ns - before) - kStep / moment.rate));
      said.off = std::max(said.off, std::abs(to_seconds(moment.stamp_ns - now)));
    }
    before = moment.stamp_ns;
    said.rate = moment.rate;
    said.slow = line.slow();
  }
  return said;
}

TEST(PaceLine, AWorldThatKeepsUpGoesByItsSchedule) {
  // Steps of all lengths, on the whole shorter than there is time for.
  const Said said = said_of(4.0, 1.0, [](int i) { return i % 10 == 0 ? 0.006 : 0.0005; });
  EXPECT_EQ(said.least, 1.0);
  EXPECT_LT(said.crooked, 2e-9);
  const Said slow_motion = said_of(4.0, 0.25, [](int) { return 0.001; });
  EXPECT_EQ(slow_motion.least, 0.25);
  EXPECT_LT(slow_motion.crooked, 2e-9);
}

TEST(PaceLine, ASlowWorldSaysHowSlowAndItsStatesAreEvenlyApart) {
  for (const double slower : {1.1, 2.0, 3.0, 20.0}) {
    const Said said = said_of(6.0, 1.0, [slower](int) { return slower * kStep; });
    std::printf(
        "%4.1f times slower: pace %.4f to %.4f, stamps off their line by %.3f ms, off ready by %.2f ms\n",
        slower, said.least, said.most, 1e3 * said.crooked, 1e3 * said.off);
    EXPECT_TRUE(said.slow);
    EXPECT_NEAR(said.least, 1.0 / slower, 0.001);
    EXPECT_NEAR(said.most, 1.0 / slower, 0.001);
    EXPECT_LT(said.crooked, 1e-4);
    EXPECT_LT(said.off, 1e-3);
  }
}

TEST(PaceLine, OneStepsLuckDoesNotChangeThePace) {
  // Twice as slow on the whole, by steps of one and three lengths.
  const Said said = said_of(6.0, 1.0, [](int i) { return (i % 2 == 0 ? 1.0 : 3.0) * kStep; });
  std::printf("pace %.4f to %.4f, stamps off their line by %.2f ms\n", said.least, said.most,
              1e3 * said.crooked);
  EXPECT_NEAR(said.least, 0.5, 0.02);
  EXPECT_NEAR(said.most, 0.5, 0.02);
  EXPECT_LT(said.crooked, 3e-4);
}

TEST(PaceLine, AWorldThatHangsAndGoesOnIsAsSlowAsItIs) {
  // 0.3 s each time, every hundredth step.
  const Said said = said_of(12.0, 1.0, [](int i) { return i % 100 == 99 ? 0.3 : 0.0005; });
  std::printf("pace %.3f to %.3f\n", said.least, said.most);
  EXPECT_GT(said.least, 0.2);
  EXPECT_LT(said.off, 0.11);
}

TEST(PaceLine, ComesBackToTheSchedule) {
  const Said said = said_of(8.0, 1.0, [](int i) { return i < 200 ? 3.0 * kStep : 0.5 * kStep; });
  EXPECT_FALSE(said.slow);
  EXPECT_EQ(said.rate, 1.0);
  EXPECT_LT(said.crooked, 2e-9) << "in the second half";
}

}  // namespace
}  // namespace slosh
