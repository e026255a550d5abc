#include "tests/lab/report/frontier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace slosh::report {
namespace {

TEST(Frontier, HoldsWhatNothingBeatsInBoth) {
  // Cheap and rough, dear and fine, and two in between of which one is beaten.
  const std::vector<bool> on = on_frontier({{1.0, 10.0}, {10.0, 1.0}, {3.0, 3.0}, {4.0, 5.0}});
  EXPECT_EQ(on, (std::vector<bool>{true, true, true, false}));
}

TEST(Frontier, ATwinBeatsNobodyAndAnEqualErrorForMoreTimeIsBeaten) {
  EXPECT_EQ(on_frontier({{1.0, 1.0}, {1.0, 1.0}}), (std::vector<bool>{true, true}));
  EXPECT_EQ(on_frontier({{1.0, 1.0}, {2.0, 1.0}}), (std::vector<bool>{true, false}));
}

TEST(Frontier, WhatIsNotANumberIsOnNone) {
  const double nan = std::nan("");
  EXPECT_EQ(on_frontier({{1.0, nan}, {nan, 0.0}, {5.0, 5.0}}), (std::vector<bool>{false, false, true}));
  EXPECT_EQ(on_frontier({{1.0, std::numeric_limits<double>::infinity()}}), (std::vector<bool>{false}));
}

TEST(Order, IsTheSlopeOfThePowerLaw) {
  const auto order = order_of({{1.0, -3.0}, {2.0, 12.0}, {4.0, -48.0}});
  ASSERT_TRUE(order);
  EXPECT_NEAR(*order, 2.0, 1e-12);
}

TEST(Order, NeedsTwoSpacingsAndErrors) {
  EXPECT_FALSE(order_of({{1.0, 0.1}}));
  EXPECT_FALSE(order_of({{1.0, 0.1}, {1.0, 0.2}}));
  EXPECT_FALSE(order_of({{1.0, 0.1}, {2.0, 0.0}}));
  EXPECT_FALSE(order_of({{1.0, 0.1}, {2.0, std::nan("")}}));
}

}  // namespace
}  // namespace slosh::report
