// `slosh sweep`: families of runs, refused before they run, kept when they are interrupted.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <sstream>
#include <thread>

#include "process.h"
#include "render/image.h"

namespace slosh {
namespace {

using test::Outcome;
using test::read_text;
using SweepArguments = std::vector<std::string>;

std::vector<std::vector<std::string>> rows(const std::filesystem::path& table) {
  std::vector<std::vector<std::string>> all;
  std::istringstream in(read_text(table));
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> fields;
    std::istringstream row(line);
    for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
    all.push_back(fields);
  }
  return all;
}

class Sweep : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(test::test_folder()); }
  std::filesystem::path out = test::test_folder() / "out";
};

TEST_F(Sweep, AHeavierProbeIsFeltHeavier) {
  const Outcome outcome = test::slosh({"sweep", "probe", "--set", "probe.mass_kg=0.05,0.1,0.2", "--seconds",
                                       "0.3", "--out", "out", "--threads", "1"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto table = rows(out / "sweep.csv");
  ASSERT_EQ(table.size(), 4u);
  EXPECT_EQ(table[0][1], "probe.mass_kg");
  EXPECT_EQ(table[3][1], "0.2");
  // The hand carries the probe's weight, less what the fluid does: 0.1 kg more is 0.98 N more.
  EXPECT_NEAR(std::stod(table[3][3]) - std::stod(table[2][3]), 0.981, 0.1);
  EXPECT_TRUE(read_png(out / "sweep.png"));
  EXPECT_GE(rows(out / "run-2-wrenches.csv").size(), 100u) << "a row a step of 3 ms, and the header";
  const Outcome again = test::slosh({"sweep", "probe", "--set", "probe.mass_kg=0.05", "--out", "out"});
  EXPECT_EQ(again.code, 1) << "an earlier sweep is not lost";
  EXPECT_NE(again.err.find("--overwrite"), std::string::npos) << again.err;
}

TEST_F(Sweep, WhatIsWrongIsSaidBeforeAnythingRuns) {
  const std::vector<std::pair<std::string, SweepArguments>> wrongs{
      {"probe.mass_kg=0.05,-1", {"mass_kg", "-1", "above 0"}},
      {"probe.mass=1", {"mass", "not a property", "mass_kg"}},
      {"boddy.mass_kg=1", {"boddy", "scene, body, fluid", "probe"}},
      {"mass_kg=1", {"OBJECT.FIELD", "body.viscosity_pa_s"}},
      {"probe.mass_kg=1,,2", {"OBJECT.FIELD"}},
      {"scene.model=magic", {"magic", "corrected"}}};
  for (const auto& [set, words] : wrongs) {
    const Outcome outcome = test::slosh({"sweep", "probe", "--set", set, "--out", "out"});
    EXPECT_EQ(outcome.code, 1) << set;
    for (const std::string& word : words)
      EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " is not in: " << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(out)) << "nothing was begun: " << set;
  }
}

TEST_F(Sweep, WhatCannotBeRunIsSaidBeforeAnythingRuns) {
  // The second value alone: a step beside a probe is explicit, and 10⁷ Pa·s ask for one without end.
  const std::vector<std::pair<SweepArguments, SweepArguments>> wrongs{
      {{"--set", "probe.mass_kg=0.05,0.1", "--spacing", "0.05"}, {"thick", "spacing_max_m"}},
      {{"--set", "fluid.viscosity_pa_s=1,1e7"}, {"viscosity of 1e+07", "steps for each simulated second"}}};
  for (const auto& [options, words] : wrongs) {
    SweepArguments arguments{"sweep", "probe", "--out", "out"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = test::slosh(arguments);
    EXPECT_EQ(outcome.code, 1) << options[1];
    for (const std::string& word : words) EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find("interrupted"), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(out)) << "nothing was begun: " << outcome.err;
  }
}

TEST_F(Sweep, EveryCombinationOfSeveral) {
  const Outcome outcome =
      test::slosh({"sweep", "probe", "--set", "scene.model=paper,corrected", "--set",
                   "fluid.viscosity_pa_s=0.1,1", "--seconds", "0.02", "--out", "out", "--threads", "1"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto table = rows(out / "sweep.csv");
  ASSERT_EQ(table.size(), 5u);
  EXPECT_EQ(table[2][1], "paper");
  EXPECT_EQ(table[2][2], "1");
  EXPECT_EQ(table[3][1], "corrected");
}

/// A spreadsheet takes a text that begins so for a formula.
TEST_F(Sweep, ValuesAreTextInTheTable) {
  const Outcome outcome = test::slosh(
      {"sweep", "probe", "--set", "scene.title==1+1", "--seconds", "0.02", "--out", "out", "--threads", "1"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto table = rows(out / "sweep.csv");
  ASSERT_EQ(table.size(), 2u);
  EXPECT_TRUE(table[1][1].ends_with("=1+1")) << table[1][1];
  EXPECT_NE(table[1][1][0], '=');
}

TEST_F(Sweep, AnInterruptKeepsWhatIsDone) {
  test::Process slosh({test::program(), "sweep", "probe", "--set", "probe.mass_kg=0.05,0.1,0.15,0.2,0.25,0.3",
                       "--seconds", "0.5", "--out", "out", "--threads", "1"},
                      test::test_folder());
  // A sanitizer takes minutes for the first run.
  for (int i = 0; i < 30000 && slosh.running() && rows(out / "sweep.csv").size() < 2; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  slosh.signal(SIGINT);
  const Outcome outcome = slosh.wait();
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  const std::size_t kept = rows(out / "sweep.csv").size();
  EXPECT_GE(kept, 2u);
  EXPECT_LT(kept, 7u);
  EXPECT_TRUE(read_png(out / "sweep.png"));
}

}  // namespace
}  // namespace slosh
