// What the paper says of its figures, against runs that are made up: each sentence can hold and can fail.
#include "tests/lab/verbs/figures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace slosh {
namespace {

/// Hands that stand at the origin unless told otherwise, for 10 s at 100 Hz.
ScriptedRun still_run(std::size_t hands) {
  ScriptedRun run;
  run.hands.resize(hands);
  run.poses.resize(hands);
  run.centers.resize(hands);
  for (std::size_t i = 0; i < hands; ++i) {
    for (int k = 0; k <= 1000; ++k) {
      run.hands[i].time.push_back(0.01 * k);
      run.hands[i].on_hand.emplace_back();
      run.poses[i].emplace_back();
      run.centers[i].emplace_back(0.0);
    }
  }
  return run;
}

Pose turned(const glm::dvec3& turn) {
  return {{0.0, 0.0, 0.0}, rotate_by(glm::dquat(1.0, 0.0, 0.0, 0.0), turn)};
}

/// Full rate from 2 to 6 s; torque: a peak while it starts, a plateau, a peak while it stops, each by a
/// factor.
ScriptedRun spin_run(const std::vector<double>& peaks, const std::vector<double>& plateaus) {
  ScriptedRun run = still_run(4);
  for (std::size_t i = 0; i < 4; ++i) {
    double angle = 0.0;
    for (std::size_t k = 1; k < run.poses[i].size(); ++k) {
      const double t = run.hands[i].time[k];
      angle += 0.01 * std::clamp(std::min((t - 2.0) / 0.2, (6.2 - t) / 0.2), 0.0, 1.0);
      run.poses[i][k] = turned({0.0, angle, 0.0});
      const bool starts = t > 2.05 && t < 2.15;
      const bool stops = t > 6.05 && t < 6.15;
      run.hands[i].on_hand[k].torque.y = starts               ? -peaks[i]
                                         : stops              ? peaks[i]
                                         : t > 2.2 && t < 6.0 ? -plateaus[i]
                                                              : 0.0;
    }
  }
  return run;
}

TEST(Figures, TenTellsViscositiesAndPhasesApartOrSaysThatItDoesNot) {
  const FigureParts apart = judge_spin(spin_run({1.0, 2.0, 3.0, 4.0}, {0.3, 0.6, 0.9, 1.2}), "a model");
  ASSERT_EQ(apart.claims.size(), 2u);
  EXPECT_TRUE(apart.claims[0].holds) << apart.claims[0].measured;
  EXPECT_TRUE(apart.claims[1].holds) << apart.claims[1].measured;
  EXPECT_EQ(apart.panels[0].title, "a model: as in the paper, the four are apart");
  EXPECT_TRUE(apart.reproduced);
  ASSERT_EQ(apart.panels[0].spans.size(), 4u);
  const char* const kPhases[] = {"rest", "start", "spin", "stop"};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(apart.panels[0].spans[i].name, kPhases[i]);
  EXPECT_NEAR(apart.panels[0].spans[2].from, 2.2, 0.02);
  EXPECT_NEAR(apart.panels[0].spans[2].to, 6.0, 0.05);
  const FigureParts same = judge_spin(spin_run({1.0, 1.02, 1.04, 1.06}, {0.3, 0.31, 0.31, 0.32}), "a model");
  EXPECT_FALSE(same.claims[0].holds);
  EXPECT_FALSE(same.reproduced);
  EXPECT_EQ(same.panels[0].title, "a model: not as in the paper") << "who has the picture alone is told too";
  EXPECT_TRUE(same.claims[1].holds) << "alike, and in four phases all the same";
  const FigureParts flat = judge_spin(spin_run({1.0, 2.0, 3.0, 4.0}, {0.0, 0.0, 0.0, 0.0}), "a model");
  EXPECT_FALSE(flat.claims[1].holds) << "a spin without a torque is no phase that shows";
}

TEST(Figures, EightWantsAForceAgainstTheMotion) {
  for (const double sign : {-1.0, 1.0}) {
    ScriptedRun run = still_run(1);
    for (std::size_t k = 1; k < run.poses[0].size(); ++k) {
      const double t = run.hands[0].time[k];
      if (t < 1.0) continue;
      const double phase = 2.0 * 3.14159265 * (t - 1.0) / 3.0;
      run.poses[0][k].position.x = 0.05 * (1.0 - std::cos(phase));
      run.hands[0].on_hand[k].force = {sign * std::sin(phase), -0.6, 0.0};
      run.hands[0].on_hand[k].torque = {0.0, 0.0, -0.1 * sign * std::sin(phase)};
    }
    const FigureParts parts = judge_spoon(run, true);
    EXPECT_EQ(parts.claims[0].holds, sign < 0.0) << parts.claims[0].measured;
    EXPECT_TRUE(parts.claims[1].holds) << parts.claims[1].measured;
    EXPECT_TRUE(parts.claims[2].holds) << parts.claims[2].measured;
  }
}

TEST(Figures, ElevenWantsTheLowerHandToCarryMore) {
  ScriptedRun run = still_run(2);
  for (std::size_t k = 0; k < run.poses[0].size(); ++k) {
    const double t = run.hands[0].time[k];
    const double angle = t < 1.0 || t > 7.0 ? 0.0 : 0.8 * std::sin(3.14159265 * (t - 1.0) / 2.0);
    for (std::size_t i = 0; i < 2; ++i) {
      run.poses[i][k] = turned({0.0, 0.0, angle});
      run.hands[i].on_hand[k].force.y = -(15.0 - t) - (i == 0 ? 2.0 : -2.0) * angle;
      run.poses[i][k].position.x = i == 0 ? -0.14 : 0.14;
    }
  }
  FigureParts parts = judge_bucket(run);
  EXPECT_TRUE(parts.claims[0].holds) << parts.claims[0].measured;
  EXPECT_TRUE(parts.claims[1].holds) << parts.claims[1].measured;
  EXPECT_TRUE(parts.claims[2].holds) << "about the middle a hand's force has an arm: "
                                     << parts.claims[2].measured;
  EXPECT_TRUE(parts.claims[3].holds) << parts.claims[3].measured;
  ASSERT_EQ(parts.panels.size(), 3u);
  EXPECT_EQ(parts.panels[2].series.size(), 1u) << "of two curves on each other one is drawn";
  run.hands[1].on_hand[300].torque.z = 1.0;
  EXPECT_EQ(judge_bucket(run).panels[2].series.size(), 2u);
  std::swap(run.hands[0], run.hands[1]);
  EXPECT_FALSE(judge_bucket(run).claims[1].holds) << "the upper hand carries more";
  EXPECT_FALSE(judge_bucket(run).claims[2].holds) << "and has more torque";
  for (auto& hand : run.hands)
    for (Wrench& w : hand.on_hand) w.force = {0.0, -10.0, 0.0};
  EXPECT_FALSE(judge_bucket(run).claims[3].holds) << "nothing is spilled";
}

TEST(Figures, ThereAreFour) {
  for (const int number : {8, 9, 10, 11}) EXPECT_NE(scene_of_figure(number), nullptr);
  EXPECT_EQ(scene_of_figure(7), nullptr);
}

}  // namespace
}  // namespace slosh
