// Freshness in a device loop when states come late and poses are not followed, and when it sends.
#include "peer/haptics/link_freshness.h"

#include <gtest/gtest.h>

#include "net/clock.h"
#include "peer/haptics/freshness.h"

namespace slosh {
namespace {

constexpr double kPeriod = 0.001;
constexpr double kLag = 0.02;  // s from a pose to a state that follows it

/// A world at its pace over a link, ticked each millisecond.
struct Link {
  LinkFreshness rule{kPeriod};
  BodyMessage message;
  StateFreshness found;
  double lag = kLag;
  int up_ends_ms = 1 << 30;  // poses read after this are lost
  int ms = 1000;
  bool down = true;
  bool up = true;
  std::int64_t arrived_ns = 0;  // stamp of the newest pose that the host has
  std::int64_t said_ns = 0;

  Link() {
    message.time_step = 0.002;
    message.rate = 1.0;
    message.heard_pose_ns = 0;
  }
  std::int64_t now() const { return std::int64_t{ms} * 1'000'000; }
  void run(int count) {
    for (int i = 0; i < count; ++i) {
      ms += 1;
      const int read_ms = ms - static_cast<int>(1e3 * lag + 0.5);
      if (up && rule.speaks() && read_ms <= up_ends_ms) said_ns = std::int64_t{read_ms} * 1'000'000;
      if (up) arrived_ns = std::max(arrived_ns, said_ns);
      if (down) {
        message.stamp_ns = now();
        message.heard_pose_ns = arrived_ns;
        message.bodies.tick += 1;
      }
      found = rule.update(message, down, now());
    }
  }
};

TEST(LinkFreshness, BelievesAWorldAtItsPace) {
  Link link;
  link.run(500);
  EXPECT_EQ(link.found.share, 1.0);
  EXPECT_TRUE(link.found.current);
  EXPECT_TRUE(link.rule.speaks());
}

/// Over a long link the first state that can follow us is a round trip away: until then there is nothing to
/// feel, and so nothing to fade where none ever comes. From then on it is fresh at once.
TEST(LinkFreshness, BelievesNothingBeforeTheFirstAnswer) {
  Link link;
  link.up = false;
  for (int ms = 0; ms < 2000; ++ms) {
    link.run(1);
    ASSERT_EQ(link.found.share, 0.0) << ms;
    ASSERT_TRUE(link.rule.speaks());
  }
  link.up = true;
  link.run(1);
  EXPECT_EQ(link.found.share, 1.0);
  EXPECT_TRUE(link.found.current);
}

/// A world far away that waits for its first step follows nobody: it may receive us or not.
TEST(LinkFreshness, AWorldFarAwayThatWaitsIsNotBelieved) {
  Link link;
  link.message.rate = 0.0;
  link.run(500);
  EXPECT_EQ(link.found.share, 0.0);
  EXPECT_TRUE(link.rule.speaks());
  link.message.rate = 1.0;
  link.run(1);
  EXPECT_EQ(link.found.share, 1.0);
}

/// Where poses stop, nobody can know before an answer is due: the force is over 400 ms after the last pose
/// that was heard, or where the link takes longer than 200 ms both ways, 200 ms after the answer to it.
/// A pause takes the force away no faster than an arm can follow, a short one only a part of it.
TEST(LinkFreshness, APauseTakesTheForceAwayAsASilenceDoes) {
  Link link;
  link.run(500);
  link.message.rate = 0.0;
  link.run(91);
  EXPECT_NEAR(link.found.share, 1.0 - 0.09 / kFadeStale, 1e-9);
  EXPECT_FALSE(link.found.current);
  link.message.rate = 1.0;
  link.run(1);
  EXPECT_EQ(link.found.share, 1.0);
  link.message.rate = 0.0;
  link.run(static_cast<int>(1e3 * kFadeStale) + 2);
  EXPECT_EQ(link.found.share, 0.0);
  EXPECT_TRUE(link.rule.speaks());
}

TEST(LinkFreshness, PosesThatStopEndTheForceWithin400MillisecondsOfTheFault) {
  for (const auto& [lag, after] : {std::pair{0.02, 400}, {0.1, 400}, {0.2, 400}, {0.3, 500}, {0.5, 700}}) {
    Link link;
    link.lag = lag;
    link.run(3000);
    EXPECT_EQ(link.found.share, 1.0);
    // What is on its way still comes: the last pose that is heard was read now.
    const int fault = link.ms;
    link.up_ends_ms = fault;
    double before = 1.0;
    while (link.found.share > 0.0 && link.ms < fault + 2000) {
      link.run(1);
      EXPECT_GT(link.found.share, before - 0.0101) << "no quicker than a tenth of a second";
      before = link.found.share;
    }
    EXPECT_NEAR(link.ms - fault, after, 12) << lag;
  }
}

/// The same where states stop: what was on its way is half of that.
TEST(LinkFreshness, StatesThatStopEndTheForceWithin400MillisecondsOfTheFault) {
  for (const auto& [lag, after] : {std::pair{0.02, 390}, {0.2, 300}, {0.4, 200}, {0.5, 200}}) {
    Link link;
    link.lag = lag;
    link.run(3000);
    link.down = false;
    const int last = link.ms;
    while (link.found.share > 0.0 && link.ms < last + 2000) link.run(1);
    EXPECT_NEAR(link.ms - last, after, 5)
        << lag << ": by what was heard last, half of it earlier by the host's clock";
  }
}

TEST(LinkFreshness, AStateThatDoesNotFollowOurPosesFadesAsALateOneDoes) {
  Link link;
  link.run(500);
  link.up = false;
  link.run(50);
  EXPECT_FALSE(link.found.current) << "the body no longer follows: what stretches now is the link's";
  EXPECT_EQ(link.found.share, 1.0);
  EXPECT_TRUE(link.rule.speaks()) << "how else would the host hear it again";
  link.run(400);
  EXPECT_EQ(link.found.share, 0.0);
  link.up = true;
  link.run(3);
  EXPECT_EQ(link.found.share, 1.0);
  EXPECT_TRUE(link.found.current);
}

TEST(LinkFreshness, WhoHearsNothingSaysNothingAndIsBelievedWhenTheHostHasAnswered) {
  Link link;
  link.run(500);
  link.down = false;
  link.run(90);
  EXPECT_TRUE(link.rule.speaks());
  link.run(30);
  EXPECT_FALSE(link.rule.speaks());
  link.down = true;
  link.run(100);
  EXPECT_FALSE(link.rule.speaks()) << "a host may have missed so short a silence";
  link.run(40);
  EXPECT_TRUE(link.rule.speaks());
  link.run(100);
  EXPECT_EQ(link.found.share, 1.0);
  // The other way round: back, but not answered yet.
  link.down = false;
  link.run(500);
  link.down = true;
  link.up = false;
  link.run(300);
  EXPECT_TRUE(link.rule.speaks());
  EXPECT_EQ(link.found.share, 0.0) << "the host has not taken hold, so nobody feels anything";
  link.up = true;
  link.run(50);
  EXPECT_EQ(link.found.share, 1.0);
}

TEST(LinkFreshness, TellsOfTheStateThatEndsAGap) {
  Link link;
  link.run(500);
  EXPECT_FALSE(link.found.resumed);
  link.down = false;
  link.run(50);
  EXPECT_FALSE(link.found.resumed);
  link.down = true;
  link.run(1);
  EXPECT_TRUE(link.found.resumed) << "the body is elsewhere by now, whether our poses are followed or not";
  link.run(1);
  EXPECT_FALSE(link.found.resumed);
}

TEST(LinkFreshness, InOneProcessNoPoseIsLost) {
  Link link;
  link.up = false;
  link.message.heard_pose_ns = kPoseNotTold;
  for (int i = 0; i < 1000; ++i) {
    link.ms += 1;
    link.message.stamp_ns = link.now();
    link.found = link.rule.update(link.message, true, link.now());
  }
  EXPECT_EQ(link.found.share, 1.0);
}

TEST(LinkFreshness, AStampFromTheFutureKeepsNoForceAlive) {
  Link link;
  link.message.heard_pose_ns = kPoseNotTold;
  link.message.stamp_ns = link.now() + to_nanoseconds(3600.0);
  link.found = link.rule.update(link.message, true, link.now());
  EXPECT_EQ(link.found.share, 1.0);
  link.ms += 400;
  EXPECT_EQ(link.rule.update(link.message, false, link.now()).share, 0.0);
}

}  // namespace
}  // namespace slosh
