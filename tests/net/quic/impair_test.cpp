// The bad network does what it is told, and QUIC lives with it.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>

#include "net/impair/fate.h"
#include "net/impair/relay.h"
#include "net/quic/address.h"
#include "tests/net/quic/ends.h"
#include "tests/support/network_here.h"

namespace slosh::testing {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

TEST(Fate, LosesAndRepeatsAsManyAsItIsTold) {
  Impairment impairment;
  impairment.loss = 0.05;
  impairment.duplicate = 0.02;
  for (const double burst : {1.0, 5.0}) {
    impairment.burst = burst;
    Fate fate(impairment, 7);
    int lost = 0, twice = 0, runs = 0;
    bool before = false;
    constexpr int kCount = 200'000;
    for (int i = 0; i < kCount; ++i) {
      const Fate::Verdict verdict = fate.judge(1000, i * kMillisecond);
      lost += verdict.copies == 0;
      twice += verdict.copies == 2;
      runs += verdict.copies == 0 && !before;
      before = verdict.copies == 0;
    }
    EXPECT_NEAR(lost / double(kCount), 0.05, 0.005) << burst;
    EXPECT_NEAR(twice / double(kCount), 0.02 * 0.95, 0.002) << burst;
    EXPECT_NEAR(lost / double(runs), burst == 1.0 ? 1.0 / 0.95 : burst, 0.3);
  }
}

TEST(Fate, KeepsTheOrderUnderJitterAndBreaksItOnlyWhenTold) {
  Impairment impairment;
  impairment.delay = 0.02;
  impairment.jitter = 0.01;
  Fate fate(impairment, 1);
  std::int64_t last = 0;
  for (int i = 0; i < 1000; ++i) {
    const Fate::Verdict verdict = fate.judge(100, i * kMillisecond);
    EXPECT_GE(verdict.due_ns, last);
    EXPECT_GE(verdict.due_ns, (i + 20) * kMillisecond);
    last = verdict.due_ns;
  }
  impairment.jitter = 0.0;
  impairment.reorder = 0.1;
  fate = Fate(impairment, 1);
  int late = 0;
  for (int i = 0; i < 1000; ++i) late += fate.judge(100, i * kMillisecond).due_ns > (i + 20) * kMillisecond;
  EXPECT_NEAR(late, 100, 40);
}

TEST(Fate, SendsAtItsRateAndLosesWhatDoesNotFitTheQueue) {
  Impairment impairment;
  impairment.rate = 1e6;
  impairment.queue = 50e3;
  Fate fate(impairment, 1);
  int passed = 0;
  std::int64_t last = 0;
  for (int i = 0; i < 1000; ++i) {
    const Fate::Verdict verdict = fate.judge(1000, 0);
    passed += verdict.copies;
    if (verdict.copies) last = verdict.due_ns;
  }
  EXPECT_NEAR(passed, 51, 1);  // 50 kB wait and one is being sent
  EXPECT_NEAR(to_seconds(last), 0.051, 0.001);
}

TEST(Fate, IsTheSameForTheSameSeed) {
  Impairment impairment;
  impairment.loss = 0.3;
  impairment.jitter = 0.01;
  Fate first(impairment, 42), second(impairment, 42), third(impairment, 43);
  int same = 0;
  for (int i = 0; i < 500; ++i) {
    const auto a = first.judge(100, i * kMillisecond), b = second.judge(100, i * kMillisecond);
    EXPECT_EQ(a.copies, b.copies);
    EXPECT_EQ(a.due_ns, b.due_ns);
    same += third.judge(100, i * kMillisecond).due_ns == a.due_ns;
  }
  EXPECT_LT(same, 400);
}

/// A pair whose packets pass a relay.
struct Relayed : Pair {
  explicit Relayed(const Impairment& impairment, const EndpointOptions& options = {},
                   const std::string& at = "127.0.0.1:0")
      : Pair(options, at) {
    auto made = Relay::start({at, host->local_address(), impairment, impairment, 1});
    if (made) relay = std::move(made.value());
  }
  bool establish() {
    connect({relay->address()});
    return run([&] { return connected(); });
  }
  std::unique_ptr<Relay> relay;
};

TEST(BadLink, IsSurvivedByStreamsAndDatagrams) {
  Impairment impairment;
  impairment.delay = 0.01;
  impairment.jitter = 0.005;
  impairment.loss = 0.05;
  impairment.burst = 2.0;
  impairment.duplicate = 0.05;
  impairment.reorder = 0.05;
  Relayed pair(impairment);
  ASSERT_TRUE(pair.relay);
  ASSERT_TRUE(pair.establish());
  Bytes data(1 << 20);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::uint8_t>(i * 31 + (i >> 8));
  const std::int64_t stream = pair.peer->open_stream(pair.at_peer(), true);
  ASSERT_TRUE(pair.peer->send_stream(pair.at_peer(), stream, data, true));
  int sent = 0;
  ASSERT_TRUE(pair.run([&] {
    if (sent < 400 && pair.peer->send_datagram(pair.at_peer(), Priority::kPose, shared(Bytes(100, 1))))
      ++sent;
    return pair.host_events.ended[stream] && sent == 400;
  }));
  EXPECT_EQ(pair.host_events.streams[stream], data);
  pair.run([&] { return pair.host_events.datagrams.size() >= 395; }, 1.0);
  EXPECT_GT(pair.host_events.datagrams.size(), 300u);
  EXPECT_LE(pair.host_events.datagrams.size(), 400u) << "a repeated packet was taken twice";
  EXPECT_GT(pair.relay->stats().dropped[0], 0u);
  EXPECT_NEAR(pair.peer->stats(pair.at_peer()).min_rtt, 0.02, 0.015);
}

TEST(BadLink, ThatGoesDarkEndsInATimeoutOnBothSides) {
  EndpointOptions options;
  options.idle_timeout = 1.0;
  options.keep_alive = 0.2;
  Relayed pair({}, options);
  ASSERT_TRUE(pair.establish());
  run_for({pair.host.get(), pair.peer.get()}, 1.5);
  EXPECT_TRUE(pair.host_events.closed.empty()) << "keep-alive did not keep it alive";
  pair.relay->dark(true);
  ASSERT_TRUE(pair.run([&] { return !pair.host_events.closed.empty() && !pair.peer_events.closed.empty(); }));
  EXPECT_EQ(pair.host_events.reasons[0].text, "timed out: nothing heard for 1 s");
  EXPECT_EQ(pair.peer_events.reasons[0].text, "timed out: nothing heard for 1 s");
  EXPECT_FALSE(pair.host_events.reasons[0].by_peer);
}

void expect_to_survive_a_nat_that_forgets(const std::string& at) {
  Relayed pair({}, {}, at);
  ASSERT_TRUE(pair.establish()) << pair.problem;
  pair.relay->rebind();
  ASSERT_TRUE(pair.run([&] {
    pair.peer->send_datagram(pair.at_peer(), Priority::kPose, shared({1, 2}));
    return !pair.host_events.migrated.empty();
  }));
  EXPECT_NE(pair.host_events.migrated[0], pair.host_events.addresses[0]);
  EXPECT_EQ(pair.host->stats(pair.at_host()).migrations, 1u);
  const std::size_t before = pair.peer_events.datagrams.size();
  ASSERT_TRUE(pair.host->send_datagram(pair.at_host(), Priority::kState, shared({3})));
  ASSERT_TRUE(pair.run([&] { return pair.peer_events.datagrams.size() > before; }));
  EXPECT_TRUE(pair.host_events.closed.empty());
}

TEST(Migration, SurvivesANatThatForgets) {
  expect_to_survive_a_nat_that_forgets("127.0.0.1:0");
}

TEST(Migration, SurvivesANatThatForgetsOverIPv6) {
  if (const std::string why = test::no_ipv6(); !why.empty()) GTEST_SKIP() << why;
  expect_to_survive_a_nat_that_forgets("[::1]:0");
}

TEST(Migration, FollowsAPeerToANewSocket) {
  Pair pair;
  ASSERT_TRUE(pair.establish());
  const std::string before = pair.peer->local_address();
  for (int round = 1; round <= 10; ++round) {
    ASSERT_TRUE(pair.peer->rebind());
    const auto moved = static_cast<std::size_t>(round);
    ASSERT_TRUE(pair.run([&] { return pair.host_events.migrated.size() >= moved; })) << round;
    const std::size_t had = pair.peer_events.datagrams.size();
    ASSERT_TRUE(pair.host->send_datagram(pair.at_host(), Priority::kState, shared({3})));
    ASSERT_TRUE(pair.run([&] { return pair.peer_events.datagrams.size() > had; })) << round;
  }
  EXPECT_NE(pair.peer->local_address(), before);
  EXPECT_EQ(pair.host_events.migrated.back(), pair.peer->local_address());
  EXPECT_TRUE(pair.peer_events.closed.empty());
}

TEST(Migration, HappensByItselfWhenTheOldAddressFallsSilent) {
  EndpointOptions options;
  options.keep_alive = 0.2;
  std::atomic<bool> cut = true;  // before the relay, whose thread looks at it to its end
  std::atomic<int> held = 0;
  Relayed pair({}, options);
  ASSERT_TRUE(pair.establish());
  // A NAT that loses what it knew of the peer: nothing passes from the old port any more, either way.
  const std::string old = pair.peer->local_address();
  pair.relay->tamper([&](Relay::Way, Relay::Packet& packet) {
    if (cut) {
      packet.clear();
      ++held;
    }
  });
  ASSERT_TRUE(pair.run([&] { return pair.peer->local_address() != old; }));
  EXPECT_GT(held, 0);
  cut = false;
  ASSERT_TRUE(pair.run([&] { return !pair.host_events.migrated.empty(); }));
  EXPECT_TRUE(pair.peer_events.closed.empty());
}

/// One packet of a socket of its own at `from`, which must be free.
bool send_once(const std::string& from, const std::string& to, const Bytes& packet) {
  const auto here = quic::resolve(from), there = quic::resolve(to);
  if (!here || !there) return false;
  const quic::Address &local = here.value().front(), &remote = there.value().front();
  const int descriptor = socket(local.any.sa_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool sent = bind(descriptor, &local.any, local.length) == 0 &&
                    sendto(descriptor, packet.data(), packet.size(), 0, &remote.any, remote.length) ==
                        static_cast<ssize_t>(packet.size());
  close(descriptor);
  return sent;
}

TEST(Restart, OfAHostWithTheSameKeyIsNoticedAndJoinedAgain) {
  const Bytes after{'a', 'f', 't', 'e', 'r'};
  std::atomic<bool> came_by = false;  // before the relay, whose thread looks at it to its end
  Relayed pair({});
  ASSERT_TRUE(pair.establish());
  const std::string address = pair.host->local_address();
  // Killed: the words of its end do not arrive. The relay may read them late, so the cable stays pulled until
  // a packet that was sent after them has come by.
  pair.relay->tamper([&](Relay::Way way, const Relay::Packet& packet) {
    if (way == Relay::Way::kDown && packet == after) came_by = true;
  });
  pair.relay->dark(true);
  pair.host.reset();
  ASSERT_TRUE(send_once(address, pair.host_events.addresses[0], after));
  ASSERT_TRUE(run_until({pair.peer.get()}, [&] { return came_by.load(); }));
  auto again = listen_quic(address, pair.host_identity, pair.host_events);
  ASSERT_TRUE(again) << again.error().text();
  pair.host = std::move(again.value());
  pair.relay->dark(false);
  const std::int64_t start = steady_now_ns();
  ASSERT_TRUE(pair.run([&] {
    pair.peer->send_datagram(pair.at_peer(), Priority::kPose, shared(Bytes(100, 1)));
    return !pair.peer_events.closed.empty();
  }));
  EXPECT_EQ(pair.peer_events.reasons[0].text, "the other side has lost this connection: it started anew");
  EXPECT_LT(to_seconds(steady_now_ns() - start), 4.0) << "only the idle timeout told it";
  const std::size_t before = pair.host_events.connected.size();
  pair.connect({pair.relay->address()});
  ASSERT_TRUE(pair.run([&] { return pair.host_events.connected.size() > before; }));
  EXPECT_EQ(pair.host_events.keys.back(), pair.peer_identity.fingerprint());
}

}  // namespace
}  // namespace slosh::testing
