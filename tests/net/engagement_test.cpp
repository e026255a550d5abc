#include "net/engagement.h"

#include <gtest/gtest.h>

namespace slosh {
namespace {

TEST(Engagement, AStretchedCouplingRampsInOverHalfASecond) {
  Engagement e;
  EXPECT_EQ(e.update(true, 10.0, 50.0, 0.0), 0.0);
  EXPECT_NEAR(e.update(true, 10.25, 50.0, 0.0), 0.5, 1e-12);
  EXPECT_EQ(e.update(true, 10.5, 50.0, 0.0), 1.0);
  EXPECT_EQ(e.update(true, 99.0, 50.0, 0.0), 1.0);
}

TEST(Engagement, ASlackCouplingStartsAtFullStrength) {
  Engagement e;
  EXPECT_EQ(e.update(true, 0.0, 0.0, 0.0), 1.0);
  EXPECT_EQ(e.update(true, 0.001, 30.0, 0.0), 1.0) << "a load that comes later is no new engagement";
}

TEST(Engagement, ATwistedCouplingIsNotSlack) {
  Engagement e;
  EXPECT_EQ(e.update(true, 0.0, 0.0, 1.0), 0.0);
}

TEST(Engagement, LettingGoDropsTheForceAndTheNextHoldRampsAgain) {
  Engagement e;
  e.update(true, 0.0, 0.0, 0.0);
  EXPECT_EQ(e.update(false, 1.0, 20.0, 0.0), 0.0);
  EXPECT_EQ(e.update(true, 2.0, 20.0, 0.0), 0.0);
  EXPECT_NEAR(e.update(true, 2.1, 20.0, 0.0), 0.2, 1e-12);
}

}  // namespace
}  // namespace slosh
