#include "sim/cpu/parallel.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>
#include <string>

namespace slosh {
namespace {

TEST(ThreadTeam, VisitsEveryIndexOnceAndAgain) {
  for (const int threads : {1, 2, 5}) {
    ThreadTeam team(threads);
    EXPECT_EQ(team.size(), threads);
    std::vector<int> visits(10007, 0);
    for (int round = 0; round < 200; ++round) {
      team.run(visits.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++visits[i];
      });
    }
    for (const int count : visits) ASSERT_EQ(count, 200);
  }
}

TEST(ThreadTeam, TakesEmptyAndSmallRanges) {
  ThreadTeam team(3);
  int calls = 0;
  team.run(0, 16, [&](std::size_t, std::size_t) { ++calls; });
  EXPECT_EQ(calls, 0);
  team.run(5, 16, [&](std::size_t begin, std::size_t end) { calls += static_cast<int>(end - begin); });
  EXPECT_EQ(calls, 5);
}

TEST(ThreadTeam, TakesNoMoreThanTheEnvironmentSaysWhereNobodyElseDoes) {
  const char* before = std::getenv("SLOSH_THREADS");
  const std::string kept = before ? before : "";
  unsetenv("SLOSH_THREADS");
  const int there = ThreadTeam(0).size();
  setenv("SLOSH_THREADS", "1", 1);
  EXPECT_EQ(ThreadTeam(0).size(), 1);
  EXPECT_EQ(ThreadTeam(3).size(), 3) << "who says a number gets it";
  for (const char* none : {"", "0", "-2", "many", "100000"}) {
    setenv("SLOSH_THREADS", none, 1);
    EXPECT_EQ(ThreadTeam(0).size(), there) << none;
  }
  unsetenv("SLOSH_THREADS");
  if (before) setenv("SLOSH_THREADS", kept.c_str(), 1);
}

}  // namespace
}  // namespace slosh
