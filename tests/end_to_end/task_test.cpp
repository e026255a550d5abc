// A guided task from the command line to its end.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "play_kit.h"
#include "process.h"

namespace slosh {
namespace {

using test::PlayTest;

/// Stirred, poured, spread, set and served, by the shipped scene's hands.
TEST_F(PlayTest, ScriptedHandsFinishTheCrepe) {
  const test::Outcome outcome =
      test::slosh({"play", "crepe", "--headless", "--no-render", "--unpaced", "--spacing", "0.009",
                   "--threads", "1", "--seconds", "28", "--out", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto summary = nlohmann::json::parse(test::read_text(out() / "summary.json"));
  ASSERT_EQ(summary["task"].size(), 5u);
  for (const auto& step : summary["task"]) EXPECT_TRUE(step["done"].get<bool>()) << step;
  EXPECT_NE(outcome.out.find("Task: 5 of 5 steps done"), std::string::npos) << outcome.out;
  EXPECT_LT(summary["particles"]["spilled"].get<int>(), 20);
  EXPECT_EQ(summary["particles"]["lost"], 0);
}

}  // namespace
}  // namespace slosh
