// What of the energy that comes out of two hands on the bucket counts as made by nobody.
#include "tests/lab/coupling/link_count.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace slosh::coupling {
namespace {

constexpr double kRow = 0.002;   // s
constexpr double kShare = 15.6;  // N, of the bucket's weight in each hand
constexpr double kStiffness = 2000.0;

/// 3 s of a hand: its height (m) and the upward force on it (N) over the time.
Felt felt_by(const std::function<double(double)>& height, const std::function<double(double)>& force) {
  Felt felt;
  for (int i = 0; i <= 1500; ++i) {
    const double time = kRow * i;
    Pose hand;
    hand.position.y = height(time);
    felt.add(time, hand, {{0.0, force(time), 0.0}, {}});
  }
  return felt;
}

double still(double) {
  return 0.0;
}
double weighs(double) {
  return -kShare;
}
/// 0 to 1 from 1 to 2 s.
double over_a_second(double time) {
  return std::clamp(time - 1.0, 0.0, 1.0);
}

TEST(LinkCount, ARaiseThatIsNotFeltYetTakesNothingOffWhatTheOtherLowers) {
  const auto lowers = [](double time) { return -0.01 * over_a_second(time); };
  const auto raises = [](double time) { return 0.02 * over_a_second(time); };
  const auto late = [](double time) { return time < 2.5 ? 0.0 : -kShare; };
  const Felt one = felt_by(lowers, weighs);
  EXPECT_NEAR(one.put_in.back(), -0.156, 1e-6);
  EXPECT_LT(generated_by({one, felt_by(raises, late)}), 1e-9);
  EXPECT_LT(generated_by({felt_by(raises, late), one}), 1e-9);
  // Felt, it is paid for by who raises, and what the other takes is theirs.
  EXPECT_LT(generated_by({one, felt_by(raises, weighs)}), 1e-9);
}

TEST(LinkCount, WhatPushesAHandToAndFroIsMade) {
  // 5 N with the velocity of 2 cm at 1 Hz: π·F·A a period, and three of them.
  constexpr double kPace = 2.0 * std::numbers::pi;
  const Felt pushed = felt_by([](double time) { return 0.02 * std::sin(kPace * time); },
                              [](double time) { return 5.0 * std::cos(kPace * time) - kShare; });
  EXPECT_NEAR(pushed.put_in.back(), -3.0 * std::numbers::pi * 5.0 * 0.02, 1e-3);
  const double found = generated_by({pushed, felt_by(still, weighs)});
  EXPECT_GT(found, 0.8) << "of 0.94 J";
  EXPECT_LT(found, 0.95);
}

TEST(LinkCount, WhatTheWeightHadTheSpringsHoldMayComeOut) {
  // A hand follows its spring sideways until that holds nothing: no weight sinks.
  Felt loosened;
  for (int i = 0; i <= 1500; ++i) {
    const double gone = over_a_second(kRow * i);
    Pose hand;
    hand.position.x = gone * kShare / kStiffness;
    loosened.add(kRow * i, hand, {{kShare * (1.0 - gone), 0.0, 0.0}, {}});
  }
  EXPECT_NEAR(loosened.put_in.back(), -0.5 * kShare * kShare / kStiffness, 1e-6);
  EXPECT_LT(generated_by({loosened, felt_by(still, weighs)}), 1e-6);
}

TEST(LinkCount, WhatARaiseThatWasNotFeltPutIntoASpringIsNobodys) {
  // It begins with 32 N, which go down to the weight as the hand gives way by 8.2 mm, half of which the
  // bucket sinks.
  const auto raised = [](double time) {
    return time < 1.0 ? 0.0082 * time : 0.0082 * (1.0 - over_a_second(time));
  };
  const auto stretched = [](double time) {
    return time < 1.0 ? 0.0 : -kShare - kStiffness * 0.0082 * (1.0 - over_a_second(time));
  };
  const double took = (kShare + 0.5 * kStiffness * 0.0082) * 0.0082;
  EXPECT_NEAR(generated_by({felt_by(raised, stretched), felt_by(still, weighs)}), took - kShare * 0.0082,
              2e-3);
}

TEST(LinkCount, AForceIsOffByItsShareOfTheReferences) {
  const Felt reference = felt_by(still, weighs);
  EXPECT_TRUE(std::isnan(error_of(reference, {})));
  const Felt heavier = felt_by(still, [](double) { return -1.25 * kShare; });
  EXPECT_NEAR(error_of(heavier, reference), 0.25, 1e-9);
}

}  // namespace
}  // namespace slosh::coupling
