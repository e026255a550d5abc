#include "host/server/effect_budget.h"

#include <gtest/gtest.h>

#include "host/server/deed_log.h"
#include "net/clock.h"

namespace slosh {
namespace {

KeyFingerprint budget_key(std::uint8_t value) {
  KeyFingerprint made{};
  made.fill(value);
  return made;
}

class EffectBudgetTest : public ::testing::Test {
 protected:
  /// Asked for, and carried out at once where it is granted.
  std::string ask(std::uint8_t who, const HostCommand& command) {
    std::string why = budget.spend(budget_key(who), command, state, now_ns);
    if (!why.empty()) return why;
    double* const value = command.action == HostAction::kGravityScale ? &state.gravity_scale
                          : command.action == HostAction::kViscosity  ? &state.viscosities[command.index]
                          : command.action == HostAction::kGripStiffness
                              ? &state.grip_stiffness[command.index]
                              : nullptr;
    changes += value == nullptr || *value != command.value ? 1 : 0;
    if (value) *value = command.value;
    return {};
  }
  void wait(double seconds) { now_ns += to_nanoseconds(seconds); }
  /// Asks for one and the other in turns, for so long; how often that changed something.
  int toggle(std::uint8_t who, const HostCommand& one, const HostCommand& other, double every,
             double seconds) {
    changes = 0;
    for (int i = 0; i < static_cast<int>(seconds / every); ++i) {
      ask(who, i % 2 ? one : other);
      wait(every);
    }
    return changes;
  }

  EffectBudget budget;
  HostState state{false, 0, 1.0, {0.001}, {1.0, 1.0}};
  std::int64_t now_ns = to_nanoseconds(100.0);
  int changes = 0;
};

constexpr HostCommand kReset{HostAction::kReset};

TEST_F(EffectBudgetTest, WhoWantsTenResetsASecondGetsAFewAndIsToldWhenMore) {
  EXPECT_EQ(toggle(1, kReset, kReset, 0.1, 59.0), 2 + 5) << "two at once, then one each 10 s";
  const std::string why = ask(1, kReset);
  EXPECT_NE(why.find("as one guest may for now: again in "), std::string::npos) << why;
  const int seconds = std::stoi(why.substr(why.find("again in ") + 9));
  ASSERT_GT(seconds, 0);
  wait(seconds);
  EXPECT_EQ(ask(1, kReset), "") << "it is allowed when it was said to be";
}

TEST_F(EffectBudgetTest, AllGuestsTogetherHaveABudgetToo) {
  for (std::uint8_t who = 1; who <= 20; ++who) {
    ask(who, kReset);
    ask(who, kReset);
  }
  EXPECT_EQ(changes, 4);
  const std::string why = ask(21, kReset);
  EXPECT_NE(why.find("the guests have together"), std::string::npos) << why;
  wait(5.1);
  EXPECT_EQ(ask(21, kReset), "");
}

TEST_F(EffectBudgetTest, GravityCountsByHowMuchItChanges) {
  const HostCommand none{HostAction::kGravityScale, 0, 0.0};
  const HostCommand twice{HostAction::kGravityScale, 0, 2.0};
  EXPECT_LE(toggle(1, none, twice, 0.055, 30.0), 6) << "from end to end a few times";
  wait(30.0);
  // A slider that is dragged there and back, ten times a second.
  int granted = 0;
  for (int i = 0; i <= 50; ++i) {
    granted += ask(1, {HostAction::kGravityScale, 0, 1.0 + 0.02 * (i < 25 ? i : 50 - i)}).empty();
    wait(0.1);
  }
  EXPECT_EQ(granted, 51) << "who drags a slider does not come to the end of it";
}

TEST_F(EffectBudgetTest, WhatTheWorldHasNotYetCarriedOutCountsAsItWill) {
  // All in one moment: the world is still as it was.
  const HostState before = state;
  int through = 0;
  for (int i = 0; i < 40; ++i) {
    const HostCommand command{HostAction::kGravityScale, 0, i % 2 ? 0.0 : 2.0};
    through += budget.spend(budget_key(1), command, before, now_ns).empty() ? 1 : 0;
  }
  EXPECT_LE(through, 3) << "1, then 2, then no more than 1";
}

TEST_F(EffectBudgetTest, StiffnessAndViscosityCountByRatio) {
  EXPECT_LE(toggle(1, {HostAction::kGripStiffness, 0, 0.05}, {HostAction::kGripStiffness, 0, 4.0}, 0.1, 10.0),
            5);
  EXPECT_EQ(ask(2, {HostAction::kGripStiffness, 1, 2.0}), "") << "another's budget is their own";
  EXPECT_LE(toggle(1, {HostAction::kViscosity, 0, 0.001}, {HostAction::kViscosity, 0, 10.0}, 0.05, 10.0), 8);
  EXPECT_LE(toggle(1, {HostAction::kPause}, {HostAction::kContinue}, 0.05, 10.0), 11);
}

TEST_F(EffectBudgetTest, ManyKeysAreForgottenWhenTheirBudgetsAreFullAgain) {
  for (int i = 0; i < 200; ++i) ask(static_cast<std::uint8_t>(i), kReset);
  wait(120.0);
  ask(250, kReset);
  EXPECT_LE(budget.remembered(), 2u);
}

TEST(DeedLog, AFloodIsCountedAndPushesOutNothing) {
  DeedLog log;
  EXPECT_EQ(log.text(), "nothing yet");
  log.note("Ana took grip 'left'", 1);
  for (int i = 0; i < 1000; ++i) {
    log.note("Ben may not pause the world", 2);
    log.note("Ben may not set the world back to its start", 3);
  }
  const std::string text = log.text();
  EXPECT_NE(text.find("Ana took grip 'left'"), std::string::npos);
  EXPECT_NE(text.find("Ben may not pause the world (1000 times)"), std::string::npos) << text;
  for (std::size_t i = 0; i < 2 * kMaxDeeds; ++i) log.note("deed " + std::to_string(i), 4);
  EXPECT_EQ(log.text().find("Ana"), std::string::npos) << "old ones go";
  EXPECT_LT(log.text().size(), 40 * kMaxDeeds);
}

}  // namespace
}  // namespace slosh
