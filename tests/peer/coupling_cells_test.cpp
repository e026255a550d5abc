// The coupling report's cells: the same table whatever the threads, and taken up again where a run was ended.
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/lab/coupling/cells.h"
#include "tests/lab/verbs/on_cores.h"
#include "tests/peer/devices/own_folder.h"

namespace slosh::coupling {
namespace {

std::vector<Case> short_cases() {
  std::vector<Case> cases(2);
  cases[0].name = "one, alone";
  cases[0].hands = 1;
  cases[1].name = "two";
  for (Case& c : cases) c.seconds = 1.0;
  return cases;
}
const std::vector<double> kTrips{0.0, 0.1};
constexpr std::size_t kCells = 12;

std::string text_of(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class CouplingCells : public ::testing::Test {
 protected:
  Result<std::vector<Row>> measure(bool resume, int jobs, std::size_t most = kCells) {
    CellRun run;
    run.jobs = jobs;
    run.resume = resume;
    std::atomic<std::size_t> asked{0};
    told_ = 0;
    // Two runs at no delay come first.
    run.stop = [&] { return ++asked > most + 2; };
    run.told = [&](double share, const std::string&) {
      EXPECT_GT(share, 0.0);
      EXPECT_LE(share, 1.0 + 1e-9);
      told_ += 1;
    };
    return measure_cells(short_cases(), kTrips, table_, run);
  }

  test::OwnFolder folder_;
  std::filesystem::path table_ = folder_.path() / "coupling.csv";
  std::size_t told_ = 0;
};

TEST_F(CouplingCells, AreTheSameTableOnAnyNumberOfThreads) {
  const Result<std::vector<Row>> one = measure(false, 1);
  ASSERT_TRUE(one) << one.error().text();
  EXPECT_EQ(one.value().size(), kCells);
  const std::string alone = text_of(table_);
  ASSERT_TRUE(measure(false, 3));
  EXPECT_EQ(text_of(table_), alone);
}

TEST_F(CouplingCells, GoOnWhereARunWasEnded) {
  ASSERT_TRUE(measure(false, 1));
  const std::string whole = text_of(table_);
  const Result<std::vector<Row>> some = measure(false, 1, 5);
  ASSERT_TRUE(some);
  EXPECT_EQ(some.value().size(), 5u);
  // Ended in the middle of a line.
  std::ofstream(table_, std::ios::app) << "two,repl";
  const Result<std::vector<Row>> rest = measure(true, 2);
  ASSERT_TRUE(rest) << rest.error().text();
  EXPECT_EQ(rest.value().size(), kCells);
  EXPECT_LE(told_, 7u + 2u) << "what was there is not measured again";
  EXPECT_EQ(text_of(table_), whole);
  ASSERT_TRUE(measure(true, 2));
  EXPECT_EQ(text_of(table_), whole);
}

TEST_F(CouplingCells, RowsOfAnotherProgramAreNotMixedIn) {
  ASSERT_TRUE(measure(false, 2));
  std::string text = text_of(table_);
  // The peak of the replica alone at 100 ms.
  const std::size_t row = text.find("one; alone,replica,1,1000,tight,100,");
  ASSERT_NE(row, std::string::npos) << text;
  const std::size_t end = text.find('\n', row);
  text.replace(row, end - row, "one; alone,replica,1,1000,tight,100,0,0,500,500,stable,0,0.5,12.34,0,0,0,0");
  std::ofstream(table_) << text;
  const Result<std::vector<Row>> refused = measure(true, 2);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("--overwrite"), std::string::npos) << refused.error().text();
  EXPECT_EQ(text_of(table_), text) << "nothing was touched";
}

TEST(OnCores, DoesEachOnceAndTellsOnTheCallersThread) {
  std::vector<std::atomic<int>> done(100);
  std::vector<int> told(100);
  EXPECT_TRUE(run_on_cores(
      100, 4, [&](std::size_t i) { done[i] += 1; }, [&](std::size_t i) { told[i] += 1; },
      [] { return false; }));
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(done[i], 1);
    EXPECT_EQ(told[i], 1);
  }
  EXPECT_TRUE(run_on_cores(
      0, 4, [](std::size_t) {}, [](std::size_t) {}, [] { return false; }));
}

TEST(OnCores, WhatIsThrownEndsIt) {
  std::size_t told = 0;
  EXPECT_THROW(run_on_cores(
                   1000, 2,
                   [](std::size_t i) {
                     if (i == 10) throw std::runtime_error("ten");
                   },
                   [&](std::size_t) { told += 1; }, [] { return false; }),
               std::runtime_error);
  EXPECT_LT(told, 1000u);
}

}  // namespace
}  // namespace slosh::coupling
