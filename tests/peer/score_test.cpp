// Scores of a guided task: kept row by row, read back, and told beside each other.
#include "peer/output/score.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "peer/output/summary.h"

namespace slosh {
namespace {

class ScoreTest : public ::testing::Test {
 protected:
  std::filesystem::path table_ =
      std::filesystem::path(::testing::TempDir()) / ("scores_" + std::to_string(getpid()) + ".csv");
  void SetUp() override { std::filesystem::remove(table_); }
  void TearDown() override { std::filesystem::remove(table_); }
  void append(const std::string& text) const { std::ofstream(table_, std::ios::app) << text; }
};

/// Two of three steps done, one of them late, by two hands of which one felt something.
RunSummary two_of_three() {
  RunSummary summary;
  summary.scene = "=kitchen, small";
  summary.spacing = 0.008;
  summary.spilled_mass = 0.0125;
  summary.task = {{"stir", true, false, 2.5, {"mixing of milk in bowl 0.8"}},
                  {"pour", true, true, 4.25, {}},
                  {"eat", false, false, 0.0, {}}};
  summary.devices = {{"left", "script", 7.5, 0.1, 0.0, 3.0}, {"right", "script", 0.0, 0.0, 0.0, 0.0}};
  return summary;
}

TEST_F(ScoreTest, ComesBackAsItWasKept) {
  const Score score = score_of(two_of_three());
  EXPECT_EQ(score.done, 2u);
  EXPECT_EQ(score.late, 1u);
  EXPECT_EQ(score.time, 6.75);
  EXPECT_EQ(score.peak_force, 7.5);
  EXPECT_EQ(score.mean_force, 3.0) << "of the hand that felt any";
  for (int run = 0; run < 2; ++run) {
    const Result<bool> kept = append_score(table_, score);
    ASSERT_TRUE(kept) << kept.error().text();
  }
  const Result<std::vector<Score>> back = read_scores(table_);
  ASSERT_TRUE(back) << back.error().text();
  ASSERT_EQ(back.value().size(), 2u);
  const Score& last = back.value().back();
  EXPECT_EQ(last.scene, "=kitchen; small") << "a comma parts fields";
  EXPECT_EQ(last.steps, 3u);
  EXPECT_EQ(last.step_times, (std::vector<double>{2.5, 4.25}));
  EXPECT_NEAR(last.spilled, 0.0125, 1e-9);
  EXPECT_NEAR(last.spacing, 0.008, 1e-9);
  EXPECT_EQ(last.measured, "mixing of milk in bowl 0.8");
  std::ifstream rows(table_);
  std::string line;
  std::getline(rows, line);
  std::getline(rows, line);
  EXPECT_NE(line.find(",'=kitchen"), std::string::npos) << "no spreadsheet runs it: " << line;
}

TEST_F(ScoreTest, ATableOfSomethingElseStaysAsItIs) {
  append("time,force\n1,2\n");
  const Result<bool> refused = append_score(table_, Score{});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("is no table of scores"), std::string::npos);
  std::ifstream rows(table_);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(rows), {}), "time,force\n1,2\n");
}

TEST_F(ScoreTest, ARowThatIsNoneIsSaidWithItsLine) {
  ASSERT_TRUE(append_score(table_, score_of(two_of_three())));
  append("yesterday,pour,3\n");
  const Result<std::vector<Score>> refused = read_scores(table_);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find(":3"), std::string::npos) << refused.error().text();
}

TEST_F(ScoreTest, RunsAreToldALineEachAndThisOneLast) {
  Score first = score_of(two_of_three()), second = first;
  first.date = "2026-11-29 10:00:00";
  const std::string words = score_words(std::vector<Score>{first, second});
  EXPECT_NE(words.find("2026-11-29 10:00:00"), std::string::npos) << words;
  EXPECT_NE(words.find("this run"), std::string::npos) << words;
  EXPECT_LT(words.find("2026-11-29"), words.find("this run"));
  EXPECT_NE(words.find("2 of 3"), std::string::npos) << words;
  EXPECT_EQ(score_words({}), "");
}

}  // namespace
}  // namespace slosh
