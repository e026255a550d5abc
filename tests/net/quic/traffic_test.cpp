// Streams and datagrams between two connected ends, and how a connection ends.
#include <gtest/gtest.h>

#include <random>

#include "net/wire/messages.h"
#include "tests/net/quic/ends.h"

namespace slosh::testing {
namespace {

Bytes noise(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  Bytes bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

TEST(Streams, CarryMegabytesBothWaysAndEndSeparately) {
  Pair pair;
  ASSERT_TRUE(pair.establish());
  const Bytes up = noise(5 << 20, 1), down = noise(3 << 20, 2);
  const std::int64_t stream = pair.peer->open_stream(pair.at_peer(), true);
  ASSERT_GE(stream, 0);
  ASSERT_TRUE(pair.peer->send_stream(pair.at_peer(), stream, up, true));
  EXPECT_FALSE(pair.peer->send_stream(pair.at_peer(), stream, up, true)) << "sent after its end";
  ASSERT_TRUE(pair.run([&] { return pair.host_events.ended[stream]; }));
  EXPECT_EQ(pair.host_events.streams[stream], up);
  EXPECT_FALSE(pair.peer_events.ended[stream]);
  // The peer's half has ended; the host's goes on.
  ASSERT_TRUE(pair.host->send_stream(pair.at_host(), stream, std::span(down).first(1000), false));
  ASSERT_TRUE(pair.run([&] { return pair.peer_events.streams[stream].size() == 1000; }));
  ASSERT_TRUE(pair.host->send_stream(pair.at_host(), stream, std::span(down).subspan(1000), true));
  ASSERT_TRUE(pair.run([&] { return pair.peer_events.ended[stream]; }));
  EXPECT_EQ(pair.peer_events.streams[stream], down);
}

TEST(Streams, CarryASceneOnAStreamOfTheHosts) {
  Pair pair;
  ASSERT_TRUE(pair.establish());
  const Bytes scene = noise(24 << 20, 3);
  const std::int64_t stream = pair.host->open_stream(pair.at_host(), false);
  ASSERT_GE(stream, 0);
  ASSERT_TRUE(pair.host->send_stream(pair.at_host(), stream, scene, true));
  ASSERT_TRUE(pair.run([&] { return pair.peer_events.ended[stream]; }));
  EXPECT_EQ(pair.peer_events.streams[stream], scene);
}

TEST(Streams, RunOutAndComeBack) {
  Pair pair;
  ASSERT_TRUE(pair.establish());
  // More streams in a row than may be open at once: each that ended makes room.
  int opened = 0;
  ASSERT_TRUE(pair.run([&] {
    const std::int64_t stream = opened < 50 ? pair.host->open_stream(pair.at_host(), false) : -1;
    const std::uint8_t byte = 7;
    if (stream >= 0 && pair.host->send_stream(pair.at_host(), stream, {&byte, 1}, true)) ++opened;
    return opened == 50 && pair.peer_events.ended.size() == 50;
  }));
}

TEST(Streams, TakeNoMoreThanTheirBuffer) {
  EndpointOptions options;
  options.stream_buffer = 100'000;
  Pair pair(options);
  ASSERT_TRUE(pair.establish());
  const std::int64_t stream = pair.peer->open_stream(pair.at_peer(), true);
  EXPECT_FALSE(pair.peer->send_stream(pair.at_peer(), stream, Bytes(100'001), false));
  EXPECT_TRUE(pair.peer->send_stream(pair.at_peer(), stream, Bytes(60'000), false));
  EXPECT_FALSE(pair.peer->send_stream(pair.at_peer(), stream, Bytes(60'000), false));
  ASSERT_TRUE(pair.run([&] { return pair.host_events.streams[stream].size() == 60'000; }));
  ASSERT_TRUE(pair.run([&] { return pair.peer->send_stream(pair.at_peer(), stream, Bytes(90'000), true); }));
  ASSERT_TRUE(pair.run([&] { return pair.host_events.ended[stream]; }));
  EXPECT_EQ(pair.host_events.streams[stream].size(), 150'000u);
}

TEST(Datagrams, ArriveOfEveryPriorityAndLength) {
  Pair pair;
  ASSERT_TRUE(pair.establish());
  std::size_t sent = 0;
  for (std::size_t size : {std::size_t{1}, std::size_t{2}, std::size_t{300}, wire::kMaxDatagram}) {
    for (Priority priority : {Priority::kPose, Priority::kState, Priority::kSnapshot}) {
      ASSERT_TRUE(pair.peer->send_datagram(pair.at_peer(), priority, shared(Bytes(size, 5))));
      ASSERT_TRUE(pair.host->send_datagram(pair.at_host(), priority, shared(Bytes(size, 6))));
      ++sent;
    }
  }
  EXPECT_FALSE(
      pair.peer->send_datagram(pair.at_peer(), Priority::kPose, shared(Bytes(wire::kMaxDatagram + 1))));
  EXPECT_FALSE(pair.peer->send_datagram(pair.at_peer(), Priority::kPose, nullptr));
  EXPECT_FALSE(pair.peer->send_datagram(99, Priority::kPose, shared({1})));
  ASSERT_TRUE(pair.run([&] {
    return pair.host_events.datagrams.size() == sent && pair.peer_events.datagrams.size() == sent;
  }));
  const ConnectionStats stats = pair.peer->stats(pair.at_peer());
  EXPECT_EQ(stats.datagrams_sent[0], 4u);
  EXPECT_EQ(stats.datagrams_sent[2], 4u);
  EXPECT_GT(stats.smoothed_rtt, 0.0);
  EXPECT_GT(stats.window, 0u);
}

TEST(Datagrams, DropTheOldestAndPutPosesFirst) {
  EndpointOptions options;
  options.queue_datagrams[0] = 4;
  options.queue_datagrams[1] = 8;
  options.queue_datagrams[2] = 16;
  Pair pair(options);
  ASSERT_TRUE(pair.establish());
  // Queued in the wrong order and too many of each, before the link is looked at.
  for (int priority = 2; priority >= 0; --priority)
    for (std::uint8_t i = 0; i < 30; ++i)
      ASSERT_TRUE(pair.host->send_datagram(pair.at_host(), static_cast<Priority>(priority),
                                           shared(Bytes(600, static_cast<std::uint8_t>(priority * 50 + i)))));
  ASSERT_TRUE(pair.run([&] { return pair.peer_events.datagrams.size() == 28; }));
  const ConnectionStats stats = pair.host->stats(pair.at_host());
  EXPECT_EQ(stats.datagrams_dropped[0], 26u);
  EXPECT_EQ(stats.datagrams_dropped[1], 22u);
  EXPECT_EQ(stats.datagrams_dropped[2], 14u);
  std::vector<int> expected, got;
  for (int i = 26; i < 30; ++i) expected.push_back(i);
  for (int i = 22; i < 30; ++i) expected.push_back(50 + i);
  for (int i = 14; i < 30; ++i) expected.push_back(100 + i);
  for (const Bytes& bytes : pair.peer_events.datagrams) got.push_back(bytes[0]);
  EXPECT_EQ(got, expected);
}

TEST(Closing, DeliversWhatStreamsHoldAndThenTheWords) {
  Pair pair;
  ASSERT_TRUE(pair.establish());
  const std::int64_t stream = pair.peer->open_stream(pair.at_peer(), true);
  ASSERT_TRUE(pair.peer->send_stream(pair.at_peer(), stream, Bytes(100), false));
  ASSERT_TRUE(pair.run([&] { return pair.host_events.streams[stream].size() == 100; }));
  const Bytes last = noise(200'000, 4);
  ASSERT_TRUE(pair.host->send_stream(pair.at_host(), stream, last, false));
  pair.host->close(pair.at_host(), 3, "the host is full");
  EXPECT_FALSE(pair.host->send_stream(pair.at_host(), stream, last, false));
  EXPECT_FALSE(pair.host->send_datagram(pair.at_host(), Priority::kPose, shared({1})));
  ASSERT_TRUE(pair.run([&] { return !pair.peer_events.closed.empty() && !pair.host_events.closed.empty(); }));
  EXPECT_EQ(pair.peer_events.streams[stream], last);
  EXPECT_TRUE(pair.peer_events.reasons[0].by_peer);
  EXPECT_EQ(pair.peer_events.reasons[0].code, 3u);
  EXPECT_EQ(pair.peer_events.reasons[0].text, "the host is full");
  EXPECT_FALSE(pair.host_events.reasons[0].by_peer);
  EXPECT_EQ(pair.host->endpoint_stats().connections, 0u);
  EXPECT_EQ(pair.host->open_stream(pair.at_host(), true), -1);
}

TEST(Closing, OfTheProgramReachesTheOther) {
  Pair pair;
  ASSERT_TRUE(pair.establish());
  pair.peer.reset();
  ASSERT_TRUE(pair.run([&] { return !pair.host_events.closed.empty(); }, 3.0))
      << "only a timeout told the host";
  EXPECT_EQ(pair.host_events.reasons[0].text, "the peer ended");
}

TEST(Closing, MayBeAskedForInsideAnEvent) {
  struct Closer : Recorder {
    void on_datagram(ConnectionId connection, std::span<const std::uint8_t> bytes) override {
      Recorder::on_datagram(connection, bytes);
      endpoint->close(connection, 5, "enough");
    }
    Endpoint* endpoint = nullptr;
  } events;
  const Identity key = Identity::generate();
  auto host = listen_quic("127.0.0.1:0", key, events);
  ASSERT_TRUE(host);
  events.endpoint = host.value().get();
  Recorder peer_events;
  auto peer = connect_quic({host.value()->local_address()}, key.fingerprint(), key, peer_events);
  ASSERT_TRUE(peer);
  ASSERT_TRUE(
      run_until({host.value().get(), peer.value().get()}, [&] { return !peer_events.connected.empty(); }));
  for (int i = 0; i < 20; ++i) peer.value()->send_datagram(1, Priority::kState, shared({1, 2, 3}));
  ASSERT_TRUE(
      run_until({host.value().get(), peer.value().get()}, [&] { return !peer_events.closed.empty(); }));
  EXPECT_EQ(events.datagrams.size(), 1u) << "something followed after close()";
  EXPECT_EQ(peer_events.reasons[0].code, 5u);
}

TEST(Waking, EndsAWait) {
  Pair pair;
  pair.host->wake();
  const std::int64_t start = steady_now_ns();
  pair.host->run_once(start + 10 * kNanosecondsPerSecond);
  EXPECT_LT(to_seconds(steady_now_ns() - start), 5.0);
}

TEST(Churn, LeavesNothingBehind) {
  EndpointOptions options;
  options.handshakes_per_second = options.handshakes_in_all = 1e6;
  Pair pair(options);
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(pair.establish()) << i << ": " << pair.problem;
    ASSERT_TRUE(pair.peer->send_datagram(pair.at_peer(), Priority::kPose, shared({1})));
    if (i % 2 == 0) pair.peer->close(pair.at_peer(), 0, "bye");
    if (i % 4 == 1) pair.host->close(pair.at_host(), 0, "bye");
    const std::size_t count = static_cast<std::size_t>(i) + 1;
    if (i % 4 == 3) pair.peer.reset();
    ASSERT_TRUE(pair.run([&] { return pair.host_events.closed.size() == count; })) << i;
    pair.peer_events = {};
    pair.peer.reset();
  }
  EXPECT_EQ(pair.host->endpoint_stats().connections, 0u);
  EXPECT_EQ(pair.host->endpoint_stats().handshakes_failed, 0u);
  for (std::size_t i = 0; i < pair.host_events.connected.size(); ++i)
    EXPECT_EQ(pair.host_events.connected[i], i + 1) << "a connection's id came back";
}

}  // namespace
}  // namespace slosh::testing
