// How datagrams keep flowing: over lost acknowledgements, on full links, at a pace that follows the link.
#include <gtest/gtest.h>

#include "net/impair/relay.h"
#include "net/quic/delivered_rate.h"
#include "net/quic/loss_ledger.h"
#include "net/quic/pace.h"
#include "net/quic/pose_room.h"
#include "net/quic/snapshot_room.h"
#include "tests/net/quic/ends.h"

namespace slosh::testing {
namespace {

using quic::LossLedger;
using quic::PaceGain;
using quic::PathFigures;
using quic::PoseRoom;
using quic::SnapshotRoom;

/// Sends `priority` from one end until its window is full while nothing comes back, and then lets everything
/// through again. The acknowledgements that were lost are not repeated by themselves: the sender must ask.
void blackout(bool from_host) {
  Pair pair;
  auto relay = Relay::start({"127.0.0.1:0", pair.host->local_address(), {}, {}, 1});
  ASSERT_TRUE(relay);
  pair.connect({relay.value()->address()});
  ASSERT_TRUE(pair.run([&] { return pair.connected(); }));
  run_for({pair.host.get(), pair.peer.get()}, 0.1);
  Endpoint& sender = from_host ? *pair.host : *pair.peer;
  const ConnectionId connection = from_host ? pair.at_host() : pair.at_peer();
  const auto& received = from_host ? pair.peer_events.datagrams : pair.host_events.datagrams;
  Impairment silent;
  silent.loss = 1.0;
  if (from_host)
    relay.value()->set(silent, {});
  else
    relay.value()->set({}, silent);
  const auto full = [&] {
    const ConnectionStats stats = sender.stats(connection);
    return stats.in_flight + 1200 > stats.window;
  };
  // On a machine that takes longer for it the sender sees first that it is not heard, and holds back.
  const std::int64_t long_enough = steady_now_ns() + to_nanoseconds(0.5);
  ASSERT_TRUE(pair.run([&] {
    for (int i = 0; i < 8; ++i) sender.send_datagram(connection, Priority::kState, shared(Bytes(1100, 2)));
    return full() || steady_now_ns() > long_enough;
  }));
  run_for({pair.host.get(), pair.peer.get()}, 0.3);
  relay.value()->set({}, {});
  const std::size_t before = received.size();
  EXPECT_TRUE(pair.run(
      [&] {
        sender.send_datagram(connection, Priority::kState, shared(Bytes(1100, 2)));
        return received.size() > before + 300;
      },
      8.0))
      << "stood still: " << received.size() - before << " came";
}

TEST(Blackout, OfAcknowledgementsDoesNotStopAHostForGood) {
  blackout(true);
}

TEST(Blackout, OfAcknowledgementsDoesNotStopAPeerForGood) {
  blackout(false);
}

TEST(PosesPastAStream, DoNotWaitForItsFlowControl) {
  Pair pair;
  ASSERT_TRUE(pair.establish());
  // The host takes 256 kB at a time; more than that waits on the stream, whatever the window says.
  const std::int64_t stream = pair.peer->open_stream(pair.at_peer(), true);
  ASSERT_TRUE(pair.peer->send_stream(pair.at_peer(), stream, Bytes(900 << 10, 7), false));
  pair.peer->run_once(0);
  for (int i = 0; i < 200; ++i) {
    pair.peer->send_datagram(pair.at_peer(), Priority::kPose, shared(Bytes(100, 1)));
    pair.peer->run_once(steady_now_ns() + 200'000);
    pair.host->run_once(0);
  }
  EXPECT_TRUE(pair.run([&] { return pair.host_events.datagrams.size() >= 200; }));
  EXPECT_EQ(pair.peer->stats(pair.at_peer()).datagrams_dropped[0], 0u);
}

PathFigures path(double rtt, double shortest, double rate = 1e6) {
  PathFigures figures;
  figures.smoothed_rtt = figures.latest_rtt = rtt;
  figures.min_rtt = shortest;
  figures.delivery_rate = rate;
  return figures;
}

TEST(PaceGain, RisesWhileSomethingWaitsAndTheLinkHasRoom) {
  PaceGain gain;
  std::int64_t now = 1;
  for (int round = 0; round < 3; ++round) gain.note(path(0.04, 0.04), true, 0, 0, now += 41'000'000);
  EXPECT_NEAR(gain.factor(), 1.25 * 1.25 * 1.25, 1e-9);
  for (int round = 0; round < 50; ++round) gain.note(path(0.041, 0.04), true, 0, 0, now += 41'000'000);
  EXPECT_EQ(gain.factor(), PaceGain::kMax);
  gain.note(path(0.041, 0.04), false, 0, 0, now += 41'000'000);
  EXPECT_EQ(gain.factor(), PaceGain::kMax) << "nothing waited: nothing was learnt";
}

TEST(PaceGain, FallsBackWhenQueuesGrowOrMuchIsLost) {
  for (const bool lossy : {false, true}) {
    PaceGain gain;
    std::int64_t now = 1;
    std::uint64_t sent = 0, lost = 0;
    for (int round = 0; round < 9; ++round)
      gain.note(path(0.04, 0.04), true, sent += 50, lost, now += 41'000'000);
    ASSERT_EQ(gain.factor(), PaceGain::kMax);
    for (int round = 0; round < 9; ++round)
      gain.note(path(lossy ? 0.04 : 0.08, 0.04), true, sent += 50, lost += lossy ? 10 : 0, now += 81'000'000);
    EXPECT_EQ(gain.factor(), 1.0);
  }
}

TEST(PaceGain, TakesLittleLossForNoise) {
  PaceGain gain;
  std::int64_t now = 1;
  std::uint64_t sent = 0, lost = 0;
  for (int round = 0; round < 9; ++round)
    gain.note(path(0.04, 0.04), true, sent += 50, lost += 5, now += 41'000'000);
  EXPECT_EQ(gain.factor(), PaceGain::kMax);
}

TEST(PaceGain, ActsOnceARoundTrip) {
  PaceGain gain;
  for (std::int64_t now = 1; now < 39'000'000; now += 100'000) gain.note(path(0.04, 0.04), true, 0, 0, now);
  EXPECT_LE(gain.factor(), 1.25);
}

TEST(SnapshotRoom, IsALittleMoreThanWhatFillsTheWay) {
  SnapshotRoom room;
  EXPECT_LT(room.limit(PathFigures{}, 1), 20'000u) << "nothing is known yet";
  const std::size_t limit = room.limit(path(0.04, 0.04), 2);
  EXPECT_GT(limit, 40'000u);  // 1 MB/s × 40 ms
  EXPECT_LT(limit, 2 * 40'000u);
  EXPECT_EQ(room.limit(path(0.2, 0.04), 3), limit) << "a queue is no longer way";
}

TEST(SnapshotRoom, LeavesLittleBeyondTheWayWhereAQueueStands) {
  SnapshotRoom room;
  std::int64_t now = 1;
  const auto pass = [&](double rtt, double seconds) {
    std::size_t limit = 0;
    for (double t = 0.0; t < seconds; t += 1e-3) limit = room.limit(path(rtt, 0.04), now += 1'000'000);
    return limit;
  };
  EXPECT_GT(pass(0.04, 1.0), 60'000u);
  EXPECT_LT(pass(0.07, 1.0), 48'000u) << "1 MB/s × 40 ms and four packets";
  EXPECT_EQ(pass(0.07, 2.2), 0u) << "after three seconds it is let run empty";
  // A radio's round trips dither, and are short now and then: that is no queue.
  for (int i = 0; i < 3000; ++i) room.limit(path(i % 10 == 0 ? 0.04 : 0.07, 0.04), now += 1'000'000);
  EXPECT_GT(room.limit(path(0.07, 0.04), now += 1'000'000), 60'000u);
}

TEST(DeliveredRate, IsAMeanOverARoundTripAndForgets) {
  quic::DeliveredRate rate;
  std::int64_t now = 1;
  std::uint64_t delivered = 0;
  EXPECT_EQ(rate.note(delivered, now, 0.04), 0.0);
  const auto clumps = [&](double bytes_a_second, double seconds) {
    double told = 0.0;
    for (int ms = 1; ms <= static_cast<int>(1e3 * seconds); ++ms) {
      if (ms % 30 == 0) delivered += static_cast<std::uint64_t>(0.03 * bytes_a_second);
      told = rate.note(delivered, now += 1'000'000, 0.04);
    }
    return told;
  };
  EXPECT_NEAR(clumps(1e6, 3.0), 1.1e6, 0.15e6) << "30 ms of bytes at a time";
  EXPECT_LT(clumps(0.2e6, 5.0), 0.3e6) << "the link has got slower";
}

TEST(SnapshotRoom, FindsOutThatTheWayGotLonger) {
  SnapshotRoom room;
  const std::size_t before = room.limit(path(0.02, 0.02), 1);
  std::int64_t now = 1;
  for (int i = 0; i < 140; ++i) room.limit(path(0.1, 0.02), now += 100'000'000);
  EXPECT_GT(room.limit(path(0.1, 0.02), now), 3 * before);
}

TEST(QueueDrain, LetsAQueueRunEmptyThatHasShownForAWhile) {
  quic::QueueDrain drain;
  PathFigures figures = path(0.2, 0.04);
  figures.latest_rtt = 0.2;
  EXPECT_FALSE(drain.due(false, figures, 0.04, 1));
  EXPECT_FALSE(drain.due(true, figures, 0.04, 2'900'000'000)) << "what stood for a moment is gone by itself";
  EXPECT_TRUE(drain.due(true, figures, 0.04, 3'100'000'000));
  EXPECT_TRUE(drain.due(true, figures, 0.04, 3'500'000'000));
  EXPECT_FALSE(drain.due(true, figures, 0.04, 3'700'000'000)) << "the way itself may have grown longer";
  EXPECT_TRUE(drain.due(true, figures, 0.04, 6'200'000'000));
  figures.latest_rtt = 0.042;
  EXPECT_FALSE(drain.due(true, figures, 0.04, 6'250'000'000)) << "it is empty";
  figures.latest_rtt = 0.2;
  EXPECT_FALSE(drain.due(true, figures, 0.04, 6'300'000'000));
}

TEST(PoseRoom, IsEverythingUntilRoundTripsGrow) {
  PoseRoom room(quic::PoseRoom::kOfPeer);
  EXPECT_EQ(room.limit(PathFigures{}, 1), SIZE_MAX);
  EXPECT_EQ(room.limit(path(0.04, 0.04, 250e3), 2), SIZE_MAX);
  EXPECT_EQ(room.limit(path(0.09, 0.04, 250e3), 3), SIZE_MAX) << "a radio that dithers is no queue";
  const std::size_t limit = room.limit(path(0.2, 0.04, 100e3), 4);
  EXPECT_GT(limit, 4'000u) << "what fills the way";
  EXPECT_LT(limit, 20'000u);
}

TEST(LossLedger, TakesWhatComesLateForArrived) {
  LossLedger ledger;
  std::int64_t now = 0;
  for (std::int64_t number = 0; number < 100; ++number) ledger.sent(number, 2, 500, now += 2'000'000);
  ledger.acknowledged(41, 99);  // 40 were overtaken
  ledger.settle(now, 300'000'000);
  EXPECT_EQ(ledger.lost(), 0u);
  ledger.acknowledged(0, 29);
  ledger.acknowledged(31, 40);
  ledger.settle(now + 400'000'000, 300'000'000);
  EXPECT_EQ(ledger.lost(), 2u) << "the two datagrams of packet 30";
  EXPECT_EQ(ledger.under_way(), 0u);
  EXPECT_EQ(ledger.size(), 0u);
}

TEST(LossLedger, WaitsForAnAcknowledgementOfSomethingLater) {
  LossLedger ledger;
  for (std::int64_t number = 0; number < 10; ++number) ledger.sent(number, 1, 500, 1);
  ledger.settle(10'000'000'000, 300'000'000);
  EXPECT_EQ(ledger.lost(), 0u) << "a link that is dark says nothing of its losses";
  EXPECT_EQ(ledger.under_way(), 5000u);
  ledger.acknowledged(3, 3);
  EXPECT_EQ(ledger.under_way(), 3000u) << "what came before is not under way any more";
  ledger.acknowledged(9, 9);
  ledger.settle(10'000'000'000, 300'000'000);
  EXPECT_EQ(ledger.lost(), 8u);
}

TEST(LossLedger, IsNotMovedByAcknowledgementsOfNothing) {
  LossLedger ledger;
  ledger.acknowledged(0, 1'000'000'000);
  ledger.sent(5, 1, 500, 1);
  ledger.acknowledged(-10, std::int64_t{1} << 60);
  ledger.settle(2, 1);
  EXPECT_EQ(ledger.lost(), 0u);
  EXPECT_EQ(ledger.size(), 0u);
  for (std::int64_t number = 6; number < 100'000; ++number) ledger.sent(number, 1, 1, number);
  EXPECT_LE(ledger.size(), 16384u);
}

}  // namespace
}  // namespace slosh::testing
