#include "net/histogram.h"

#include <gtest/gtest.h>

#include <limits>

namespace slosh {
namespace {

TEST(Histogram, PercentilesOfAKnownSpread) {
  Histogram h;
  for (int i = 1; i <= 1000; ++i) h.add(1e-6 * i);  // 1 µs to 1 ms, evenly
  EXPECT_EQ(h.count(), 1000u);
  EXPECT_NEAR(h.percentile(0.5), 500e-6, 0.002 * 500e-6);
  EXPECT_NEAR(h.percentile(0.99), 990e-6, 0.002 * 990e-6);
  EXPECT_EQ(h.max(), 1e-3);
  EXPECT_LE(h.percentile(1.0), h.max());
  EXPECT_NEAR(h.mean(), 500.5e-6, 1e-9);
}

TEST(Histogram, EmptyIsZero) {
  const Histogram h;
  EXPECT_EQ(h.percentile(0.5), 0.0);
  EXPECT_EQ(h.max(), 0.0);
  EXPECT_EQ(h.mean(), 0.0);
}

TEST(Histogram, ExtremesLandInTheEndBins) {
  Histogram h;
  h.add(0.0);
  h.add(1e9);
  h.add(-1.0);                                      // not a duration
  h.add(std::numeric_limits<double>::quiet_NaN());  // nor this
  EXPECT_EQ(h.count(), 2u);
  EXPECT_EQ(h.max(), 1e9);
  EXPECT_GT(h.percentile(1.0), 90.0);
  EXPECT_LT(h.percentile(0.5), 2e-7);
}

}  // namespace
}  // namespace slosh
