#include "host/server/tiers.h"

#include <gtest/gtest.h>

#include <functional>

#include "net/clock.h"

namespace slosh {
namespace {

/// Ten looks a second at a link; `look` gives what is seen at a tier.
int run(TierControl& control, double seconds, std::int64_t& now_ns,
        const std::function<LinkEvidence(int)>& look, int* changes = nullptr) {
  const std::int64_t until = now_ns + to_nanoseconds(seconds);
  while (now_ns < until) {
    now_ns += 100'000'000;
    if (control.note(look(control.tier()), now_ns) && changes) *changes += 1;
  }
  return control.tier();
}

LinkEvidence clear(double loss = 0.0) {
  LinkEvidence seen;
  seen.frames = 6;
  seen.pieces_sent = 100;
  seen.pieces_came = static_cast<std::uint32_t>(100 * (1.0 - loss));
  seen.rtt = seen.min_rtt = 0.02;
  return seen;
}

LinkEvidence full() {
  LinkEvidence seen = clear();
  seen.frames_withheld = 2;
  return seen;
}

TEST(Tiers, AClearLinkClimbsToItsBestAndStays) {
  TierControl control(kAllParticles, 3);
  std::int64_t now = 1;
  EXPECT_EQ(run(control, 20.0, now, [](int) { return clear(); }), kAllParticles);
  int changes = 0;
  run(control, 60.0, now, [](int) { return clear(); }, &changes);
  EXPECT_EQ(changes, 0);
}

TEST(Tiers, AWatcherNeverClimbsAboveTheShell) {
  TierControl control(kShell, kShell);
  std::int64_t now = 1;
  EXPECT_EQ(run(control, 30.0, now, [](int) { return clear(); }), kShell);
}

TEST(Tiers, PlainLossIsNoReasonToGoDown) {
  TierControl control(kAllParticles, 1);
  std::int64_t now = 1;
  EXPECT_EQ(run(control, 30.0, now, [](int) { return clear(0.05); }), kAllParticles);
  int downs = 0;
  run(control, 30.0, now, [](int) { return clear(0.05); }, &downs);
  EXPECT_EQ(downs, 0);
}

TEST(Tiers, AFullLinkGoesDownWithinASecond) {
  TierControl control(kAllParticles, kAllParticles);
  std::int64_t now = 1;
  run(control, 1.0, now, [](int) { return clear(); });
  EXPECT_GT(run(control, 0.6, now, [](int) { return full(); }), kAllParticles);
  EXPECT_EQ(run(control, 10.0, now, [](int) { return full(); }), kTierCount - 1);
}

TEST(Tiers, EachSignOfFullnessCounts) {
  const auto falls = [](const std::function<void(LinkEvidence&)>& spoil) {
    TierControl control(kAllParticles, kAllParticles);
    std::int64_t now = 1;
    return run(control, 3.0, now, [&](int) {
             LinkEvidence seen = clear();
             spoil(seen);
             return seen;
           }) > kAllParticles;
  };
  EXPECT_FALSE(falls([](LinkEvidence&) {}));
  EXPECT_TRUE(falls([](LinkEvidence& seen) { seen.frames_withheld = 3; }));
  EXPECT_TRUE(falls([](LinkEvidence& seen) { seen.rtt = 0.2; }));
  EXPECT_TRUE(falls([](LinkEvidence& seen) { seen.datagrams_dropped = true; }));
  EXPECT_TRUE(falls([](LinkEvidence& seen) { seen.silent = true; }));
  EXPECT_TRUE(falls([](LinkEvidence& seen) { seen.pieces_came = 60; }));
}

TEST(Tiers, FailedClimbsGrowRarer) {
  // The link carries tier 2, and no better.
  const auto look = [](int tier) { return tier < 2 ? full() : clear(); };
  TierControl control(kAllParticles, 2);
  std::int64_t now = 1;
  int early = 0;
  int late = 0;
  run(control, 60.0, now, look, &early);
  run(control, 240.0, now, look);
  run(control, 60.0, now, look, &late);
  EXPECT_GE(early, 4);
  EXPECT_LE(late, 2);
  EXPECT_GE(control.tier(), 1);
}

}  // namespace
}  // namespace slosh
