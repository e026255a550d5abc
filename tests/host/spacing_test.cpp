// The choice of a spacing from made-up timings.
#include <gtest/gtest.h>

#include <array>

#include "host/auto_spacing.h"

namespace slosh {
namespace {

/// A cubic metre-ish scene: n = 1/s³ particles, a time step that shrinks with the spacing.
std::vector<SpacingCandidate> candidates() {
  std::vector<SpacingCandidate> list;
  for (double s = 0.020; s > 0.0099; s -= 0.001) list.push_back({s, 1e-3 / (s * s * s), 0.1 * s});
  return list;
}

TEST(ChooseSpacing, TakesTheFinestThatFits) {
  // 10 µs + 1 µs a particle. At 14 mm: 364 particles, 0.374 ms · 1.4 = 0.52 of 1.4 ms. At 10 mm: 1000
  // particles, 1.01 ms · 1.4 = 1.41 of 1.0 ms: too slow. At 11 mm: 751, 0.761 · 1.4 = 1.066 of 1.1: fits.
  const std::array<StepTiming, 2> timings{{{0.020, 125, 135e-6}, {0.015, 296, 306e-6}}};
  const SpacingChoice choice = choose_spacing(timings, candidates(), 1.4);
  EXPECT_TRUE(choice.real_time);
  EXPECT_NEAR(choice.spacing, 0.011, 1e-9);
  EXPECT_NEAR(choice.predicted_step, 10e-6 + 751.3e-6, 1e-6);
  EXPECT_NE(choice.reason.find("1.10 ms"), std::string::npos) << choice.reason;
}

TEST(ChooseSpacing, ALargerMarginChoosesCoarser) {
  const std::array<StepTiming, 2> timings{{{0.020, 125, 135e-6}, {0.015, 296, 306e-6}}};
  EXPECT_GT(choose_spacing(timings, candidates(), 2.5).spacing,
            choose_spacing(timings, candidates(), 1.4).spacing);
}

TEST(ChooseSpacing, SaysSoWhenNothingFits) {
  const std::array<StepTiming, 2> timings{{{0.020, 125, 5e-3}, {0.015, 296, 10e-3}}};
  const SpacingChoice choice = choose_spacing(timings, candidates(), 1.4);
  EXPECT_FALSE(choice.real_time);
  EXPECT_DOUBLE_EQ(choice.spacing, 0.020);
  EXPECT_NE(choice.reason.find("slower than real time"), std::string::npos);
}

TEST(ChooseSpacing, OneTimingIsALineThroughZero) {
  const std::array<StepTiming, 1> timings{{{0.020, 125, 125e-6}}};
  const SpacingChoice choice = choose_spacing(timings, candidates(), 1.0);
  EXPECT_NEAR(choice.predicted_step, choice.particles * 1e-6, 1e-9);
}

TEST(ChooseSpacing, NoiseThatFallsWithParticlesIsNotBelieved) {
  // More particles, less time: believing the line would promise infinitely fine spacings.
  const std::array<StepTiming, 2> timings{{{0.020, 125, 900e-6}, {0.015, 296, 600e-6}}};
  const SpacingChoice choice = choose_spacing(timings, candidates(), 1.4);
  EXPECT_GT(choice.predicted_step, 0.0);
  EXPECT_GE(choice.spacing, 0.014);
}

}  // namespace
}  // namespace slosh
