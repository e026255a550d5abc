// What is kept of a device loop's states for threads that ask less often.
#include "peer/remote/kept_state.h"

#include <gtest/gtest.h>

namespace slosh {
namespace {

BodyMessage message(std::uint32_t run, std::uint64_t tick, double rate) {
  BodyMessage message;
  message.run = run;
  message.rate = rate;
  message.bodies.tick = tick;
  return message;
}

// A world that stands tells so with the step that was told while it ran: Python's rate stayed 1 for good.
TEST(KeptState, APauseIsKeptThoughTheStepIsTheSame) {
  KeptState kept;
  kept.note(message(1, 50, 1.0));
  kept.note(message(1, 50, 0.0));
  EXPECT_EQ(kept.state().rate, 0.0);
  kept.note(message(1, 50, 1.0));
  EXPECT_EQ(kept.state().rate, 1.0);
}

TEST(KeptState, AnotherStepAndAnotherRunAreKept) {
  KeptState kept;
  kept.note(message(1, 0, 0.0));
  EXPECT_EQ(kept.state().run, 1u);
  kept.note(message(1, 7, 0.0));
  EXPECT_EQ(kept.state().bodies.tick, 7u);
  kept.note(message(2, 7, 0.0));
  EXPECT_EQ(kept.state().run, 2u);
}

}  // namespace
}  // namespace slosh
