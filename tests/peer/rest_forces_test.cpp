// Hands at rest in a sweep over viscosities: told where they have not settled, silent where they have.
#include "tests/lab/verbs/rest_forces.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace slosh {
namespace {

struct Hand {
  WrenchSeries felt;
  std::vector<Pose> poses;
};

/// 3 s at 100 Hz: still for 1 s, then 1 s of motion, then still again; the force goes from `first` N to
/// `last` meanwhile, and changes by `drift` N in each second at rest.
Hand hand(double first, double last, double drift) {
  Hand made;
  for (int k = 0; k <= 300; ++k) {
    const double t = 0.01 * k;
    const double way = std::clamp(t - 1.0, 0.0, 1.0);
    const double rest = drift * (std::min(t, 1.0) + std::max(t - 2.0, 0.0));
    made.felt.time.push_back(t);
    made.felt.on_hand.push_back({{0.0, -(first + way * (last - first) + rest), 0.0}, glm::dvec3(0.0)});
    made.poses.push_back({{0.1 * way, 0.0, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)});
  }
  return made;
}

std::vector<RestForce> rests(double first, double last, double drift = 0.0) {
  const Hand made = hand(first, last, drift);
  return rest_forces(made.felt, made.poses);
}

TEST(RestForces, AreFoundBeforeAndAfterTheMotion) {
  const std::vector<RestForce> found = rests(4.0, 5.0);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].from, 0.0, 1e-9);
  EXPECT_NEAR(found[0].to, 1.0, 0.011);
  EXPECT_NEAR(found[0].force, 4.0, 1e-9);
  EXPECT_NEAR(found[1].from, 2.0, 0.011);
  EXPECT_NEAR(found[1].to, 3.0, 1e-9);
  EXPECT_NEAR(found[1].force, 5.0, 1e-9);
}

TEST(RestForces, AHandThatNeverMovesHasOne) {
  Hand still = hand(4.0, 4.0, 0.0);
  std::fill(still.poses.begin(), still.poses.end(), Pose{});
  EXPECT_EQ(rest_forces(still.felt, still.poses).size(), 1u);
}

TEST(RestForces, ThreePercentByViscosityIsTold) {
  const std::string text =
      unsettled_text("spoon_hand", {rests(4.0, 5.0), rests(4.06, 5.0, 0.1), rests(4.06, 5.0, 0.16)});
  for (const char* word : {"spoon_hand", "from 0 to", "4 to 4.18 N", "4.3 %", "not settled", "settle_s"})
    EXPECT_NE(text.find(word), std::string::npos) << word << " is not in: " << text;
  const std::string after = unsettled_text("spoon_hand", {rests(4.0, 5.0), rests(3.925, 4.9, 0.1)});
  EXPECT_NE(after.find("a last key later"), std::string::npos) << after;
}

/// What stands still with it is no matter of time.
TEST(RestForces, WhatNoLongerChangesIsAMatterOfTheSpacing) {
  const std::string text = unsettled_text("spoon_hand", {rests(4.0, 5.0), rests(4.12, 5.0)});
  EXPECT_NE(text.find("--spacing"), std::string::npos) << text;
  EXPECT_EQ(text.find("settle_s"), std::string::npos) << text;
}

TEST(RestForces, WhatAgreesIsNotTold) {
  EXPECT_EQ(unsettled_text("a", {rests(4.0, 5.0), rests(4.01, 5.02)}), "");
  EXPECT_EQ(unsettled_text("a", {rests(0.001, 0.002), rests(0.003, 0.004)}), "") << "millinewtons are noise";
  EXPECT_EQ(unsettled_text("a", {rests(4.0, 5.0)}), "") << "one run is compared with nothing";
}

}  // namespace
}  // namespace slosh
