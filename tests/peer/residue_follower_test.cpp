// What no model explains of a fluid's force, as it is foreseen over a delay.
#include "peer/replica/residue_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <numbers>

namespace slosh {
namespace {

constexpr double kWord = 0.002;  // s
constexpr double kMax = 7.0;     // N

/// N by which `force` is off, rms from `from` to `to`, where it is known `delay` s late.
double off_by(const std::function<double(double)>& force, double delay, double from, double to) {
  ResidueFollower follower;
  double all = 0.0, count = 0.0;
  for (double t = 0.0; t < to; t += kWord) {
    follower.update(kWord, force(t - delay), delay, kMax);
    if (t < from) continue;
    all += std::pow(follower.foreseen() - force(t), 2.0);
    count += 1.0;
  }
  return std::sqrt(all / count);
}

/// 12 N in a second, from the third second on.
double poured(double t) {
  return 24.0 - 12.0 * std::clamp(t - 3.0, 0.0, 1.0);
}

TEST(ResidueFollower, WhatIsPouredOutIsFollowedAsLateAsItIsTold) {
  for (const double delay : {0.05, 0.1, 0.2}) {
    const double all = off_by(poured, delay, 3.0, 5.0), late = 12.0 * delay * std::sqrt(0.5),
                 last = off_by(poured, delay, 3.8, 4.0);
    std::printf("%.0f ms: off by %.2f N, at the end of the pouring by %.2f; late alone %.2f\n", 1e3 * delay,
                all, last, late);
    EXPECT_LT(all, 1.25 * late);
    EXPECT_LT(last, 0.7 * 12.0 * delay) << "as it goes on";
  }
}

/// Followed it would be off by up to twice as much.
TEST(ResidueFollower, WhatGoesToAndFroAsQuickAsTheWayHereIsLeftOut) {
  for (const double delay : {0.2, 0.4}) {
    const double hertz = 0.5 / delay;
    const auto swings = [&](double t) { return 20.0 + 3.0 * std::sin(2.0 * std::numbers::pi * hertz * t); };
    const double off = off_by(swings, delay, 4.0, 8.0);
    std::printf("%.2f Hz over %.0f ms: off by %.2f N rms of %.2f\n", hertz, 1e3 * delay, off,
                3.0 / std::sqrt(2.0));
    EXPECT_LT(off, 1.05 * 3.0 / std::sqrt(2.0));
  }
}

TEST(ResidueFollower, WhereNothingIsLateItIsWhatIsTold) {
  EXPECT_LT(off_by(poured, 0.0, 3.0, 5.0), 0.35);
}

/// What is told by a host may be anything; what goes on is bounded by what was told.
TEST(ResidueFollower, SaysNothingThatIsNoNumberAndNothingFarBeyondWhatWasTold) {
  ResidueFollower follower;
  double low = 0.0, high = 0.0;
  unsigned random = 1;
  for (int i = 0; i < 20000; ++i) {
    random = random * 1664525u + 1013904223u;
    const double told = (i / 300) % 2 ? 40.0 : static_cast<double>(random >> 16) / 65536.0 * 10.0;
    low = std::min(low, told);
    high = std::max(high, told);
    follower.update(kWord, told, 0.4, kMax);
    ASSERT_GE(follower.foreseen(), low - kMax - 1e-9);
    ASSERT_LE(follower.foreseen(), high + kMax + 1e-9);
  }
  follower.update(kWord, std::numeric_limits<double>::quiet_NaN(), 0.4, kMax);
  EXPECT_FALSE(follower.known());
  EXPECT_EQ(follower.foreseen(), 0.0);
  follower.update(kWord, 5.0, 0.4, kMax);
  EXPECT_NEAR(follower.foreseen(), 5.0, 1e-9);
}

}  // namespace
}  // namespace slosh
