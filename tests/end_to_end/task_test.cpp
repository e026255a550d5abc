// A guided task from the command line to its end.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "play_kit.h"
#include "process.h"

namespace slosh {
namespace {

using test::PlayTest;

/// Stirred, poured, spread, set, pressed and served with butter that is cut, and syrup, by the shipped
/// scene's hands.
TEST_F(PlayTest, ScriptedHandsFinishTheCrepe) {
  const test::Outcome outcome =
      test::slosh({"play", "crepe", "--headless", "--no-render", "--unpaced", "--spacing", "0.009",
                   "--threads", "1", "--out", "out", "--score", "crepe.csv"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto summary = nlohmann::json::parse(test::read_text(out() / "summary.json"));
  ASSERT_EQ(summary["task"].size(), 9u);
  for (const auto& step : summary["task"]) EXPECT_TRUE(step["done"].get<bool>()) << step;
  EXPECT_NE(outcome.out.find("Task: 9 of 9 steps done"), std::string::npos) << outcome.out;
  EXPECT_LT(summary["particles"]["spilled"].get<int>(), 20);
  EXPECT_EQ(summary["particles"]["lost"], 0);
  EXPECT_LT(summary["task_spilled_kg"].get<double>(), 0.03);

  // Its score, and how it is told beside the next run's.
  const std::string rows = test::read_text(test::test_folder() / "crepe.csv");
  EXPECT_EQ(std::ranges::count(rows, '\n'), 2) << rows;
  EXPECT_NE(rows.find(",crepe,9,9,"), std::string::npos) << rows;
  const test::Outcome next =
      test::slosh({"play", "crepe", "--headless", "--no-render", "--unpaced", "--spacing", "0.009",
                   "--seconds", "0.2", "--score", "crepe.csv", "--ghost", "out", "--guide", "3"});
  ASSERT_EQ(next.code, 0) << next.err;
  EXPECT_NE(next.out.find("this run              0 of 9"), std::string::npos) << next.out;
  EXPECT_NE(next.out.find("  9 of 9 "), std::string::npos) << next.out;
}

TEST_F(PlayTest, AScoreOrGhostThatCannotBeIsRefusedBeforeTheRun) {
  const auto refused = [](std::vector<std::string> more, const char* why) {
    std::vector<std::string> words{"play", "pour", "--headless", "--no-render", "--seconds", "0.1"};
    words.insert(words.end(), more.begin(), more.end());
    const test::Outcome outcome = test::slosh(words);
    EXPECT_NE(outcome.code, 0) << outcome.out;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
  };
  std::filesystem::create_directories(test::test_folder());
  std::ofstream(test::test_folder() / "letter.txt") << "Dear Ana,\n";
  refused({"--score", "letter.txt"}, "is no table of scores");
  EXPECT_EQ(test::read_text(test::test_folder() / "letter.txt"), "Dear Ana,\n");
  refused({"--ghost", "nowhere"}, "nowhere");
  refused({"--guide", "2"}, "has no ghost");
  const test::Outcome aimless =
      test::slosh({"play", "spoon", "--headless", "--no-render", "--score", "s.csv"});
  EXPECT_NE(aimless.err.find("has no guided task"), std::string::npos) << aimless.err;
}

/// A step gives the hand at one grip another: its device goes along, in a world of one's own.
TEST_F(PlayTest, ADeviceGoesWithItsHandToAnotherTool) {
  const std::filesystem::path built = std::filesystem::path(test::program()).parent_path().parent_path();
  auto scene = nlohmann::json::parse(test::read_text(built / "scenes" / "pour.gltf"));
  scene["scenes"][0]["extras"]["task"] = {{{"say", "Stand."},
                                           {"until", {{"speed_m_s", "bowl_body"}, {"at_most", 100.0}}},
                                           {"then", {{"hand", "bowl"}, {"takes", "pan"}}}}};
  std::filesystem::create_directories(test::test_folder());
  std::ofstream(test::test_folder() / "hand.gltf") << scene;
  const std::string device = "plugin:" + (built / "lib" / "slosh_noting_device.so").string() + ":" +
                             (test::test_folder() / "sent").string();
  const test::Outcome outcome =
      test::slosh({"play", "hand.gltf", "--headless", "--no-render", "--seconds", "2", "--spacing", "0.012",
                   "--yes", "--device", device, "--device", "script", "--out", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto summary = nlohmann::json::parse(test::read_text(out() / "summary.json"));
  EXPECT_EQ(summary["devices"][1]["device"], summary["devices"][0]["device"]) << summary["devices"];
  EXPECT_NE(summary["devices"][1]["device"], "script") << outcome.err;
}

}  // namespace
}  // namespace slosh
