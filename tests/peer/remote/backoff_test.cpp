#include "peer/remote/backoff.h"

#include <gtest/gtest.h>

#include "net/clock.h"

namespace slosh {
namespace {

TEST(Backoff, TriesSoonAndThenEverySecond) {
  Backoff backoff;
  std::int64_t now_ns = 5 * kNanosecondsPerSecond;
  backoff.lost(now_ns);
  for (const double wait : {0.1, 0.2, 0.5, 1.0, 1.0, 1.0}) {
    EXPECT_NEAR(to_seconds(backoff.due_ns() - now_ns), wait, 1e-9);
    now_ns = backoff.due_ns();
    backoff.failed(now_ns);
  }
  backoff.lost(now_ns);
  EXPECT_NEAR(to_seconds(backoff.due_ns() - now_ns), 0.1, 1e-9) << "lost again: soon again";
}

TEST(Backoff, GivesUpAfterItsPatience) {
  Backoff backoff(300.0);
  backoff.lost(0);
  EXPECT_FALSE(backoff.gave_up(299 * kNanosecondsPerSecond));
  EXPECT_TRUE(backoff.gave_up(301 * kNanosecondsPerSecond));
}

}  // namespace
}  // namespace slosh
