// A library that throws what a stranger wrote: the terminal is shown text.
#include "peer/app/uncaught.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include "net/text/clean.h"

namespace slosh {
namespace {

const std::runtime_error kHostile("\x1b]0;owned\x07\x1b[2J\u009b31m\u202e\xff a scene\rslosh: all is well\n" +
                                  std::string(100'000, 'x'));

void expect_clean(const std::string& said) {
  EXPECT_EQ(said.rfind("slosh: ?]0;owned??[2J?31m? a scene?slosh: all is well\n", 0), 0u)
      << said.substr(0, 80);
  EXPECT_LT(said.size(), 2 * kMaxTextBytes);
  std::string_view lines = said;
  for (std::size_t end = 0; (end = lines.find('\n')) != std::string_view::npos; lines.remove_prefix(end + 1))
    EXPECT_EQ(text_problem(lines.substr(0, end)), "");
}

TEST(Uncaught, InMainIsSaidClean) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(fail_uncaught(kHostile), 1);
  expect_clean(::testing::internal::GetCapturedStderr());
}

TEST(UncaughtDeathTest, OnAThreadIsSaidCleanBeforeTheEnd) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        say_uncaught_cleanly();
        std::thread([] { throw kHostile; }).join();
      },
      ::testing::KilledBySignal(SIGABRT),
      "^slosh: \\?]0;owned\\?\\?\\[2J\\?31m\\? a scene\\?slosh: all is well\nx+\n");
}

}  // namespace
}  // namespace slosh
