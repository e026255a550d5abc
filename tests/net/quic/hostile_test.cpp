// What strangers on the network can do: nothing that others feel.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <random>

#include "net/impair/relay.h"
#include "net/quic/address.h"
#include "tests/net/quic/ends.h"

namespace slosh::testing {
namespace {

/// A socket without any manners.
class Stranger {
 public:
  explicit Stranger(const std::string& to) : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    const quic::Address address = quic::resolve(to).value().front();
    EXPECT_EQ(connect(descriptor_, &address.any, address.length), 0);
  }
  ~Stranger() { close(descriptor_); }
  void send(std::span<const std::uint8_t> bytes) { ::send(descriptor_, bytes.data(), bytes.size(), 0); }
  std::vector<Bytes> answers() {
    std::vector<Bytes> all;
    Bytes buffer(2048);
    for (ssize_t size; (size = recv(descriptor_, buffer.data(), buffer.size(), 0)) >= 0;)
      all.emplace_back(buffer.begin(), buffer.begin() + size);
    return all;
  }

 private:
  int descriptor_;
};

std::size_t total(const std::vector<Bytes>& packets) {
  std::size_t sum = 0;
  for (const Bytes& packet : packets) sum += packet.size();
  return sum;
}

/// A connected pair whose first packets were kept, and a bystander who must not notice anything.
struct Scene : Pair {
  explicit Scene(const EndpointOptions& options = {}) : Pair(options) {
    auto made = Relay::start({"127.0.0.1:0", host->local_address(), {}, {}, 1});
    if (!made) return;
    relay = std::move(made.value());
    relay->capture(8);
    connect({relay->address()});
    // Libraries differ in how many packets a handshake takes; four there are soon.
    run([&] { return connected() && relay->captured(Relay::Way::kUp).size() >= 4; });
    first = relay->captured(Relay::Way::kUp);
    auto other = connect_quic({host->local_address()}, host_identity.fingerprint(), Identity::generate(),
                              bystander_events);
    bystander = std::move(other.value());
    run_until({host.get(), bystander.get()}, [&] { return !bystander_events.connected.empty(); });
    at_bystander = host_events.connected.back();
  }
  bool bystander_is_well() {
    if (!bystander_events.closed.empty()) return false;
    const std::size_t had = bystander_events.datagrams.size();
    host->send_datagram(at_bystander, Priority::kState, shared({1}));
    return run_until({host.get(), bystander.get()}, [&] { return bystander_events.datagrams.size() > had; });
  }
  std::unique_ptr<Relay> relay;
  std::vector<Bytes> first;  // the peer's first packets
  Recorder bystander_events;
  std::unique_ptr<Endpoint> bystander;
  ConnectionId at_bystander = 0;
};

TEST(Hostile, AFirstPacketIsAnsweredByARetryAndNothingIsKept) {
  Scene scene;
  ASSERT_GE(scene.first.size(), 3u);
  const EndpointStats before = scene.host->endpoint_stats();
  Stranger stranger(scene.host->local_address());
  std::size_t sent = 0;
  for (int i = 0; i < 100; ++i) {
    stranger.send(scene.first[0]);
    sent += scene.first[0].size();
    scene.host->run_once(0);
  }
  run_for({scene.host.get()}, 0.05);
  const auto answers = stranger.answers();
  ASSERT_FALSE(answers.empty());
  for (const Bytes& answer : answers) EXPECT_EQ(answer[0] & 0xf0, 0xf0) << "not a Retry packet";
  EXPECT_LE(total(answers), sent) << "a spoofed address would get more than was sent";
  EXPECT_EQ(scene.host->endpoint_stats().connections, before.connections);
  EXPECT_EQ(scene.host->endpoint_stats().retries_sent, before.retries_sent + 100);
  EXPECT_TRUE(scene.bystander_is_well());
}

TEST(Hostile, AReplayedTokenOpensNothing) {
  Scene scene;
  ASSERT_GE(scene.first.size(), 3u);
  // The second packet is the first one again, with the token. From elsewhere it is worth nothing …
  Stranger stranger(scene.host->local_address());
  for (int i = 0; i < 20; ++i) stranger.send(scene.first[1]);
  run_for({scene.host.get()}, 0.05);
  EXPECT_EQ(stranger.answers().size(), 0u);
  EXPECT_EQ(scene.host->endpoint_stats().connections, 2u);
  // … and from where it was made for neither, while the connection lives or after it.
  for (int i = 0; i < 20; ++i) scene.relay->inject(Relay::Way::kUp, scene.first[1]);
  run_for({scene.host.get(), scene.peer.get()}, 0.05);
  EXPECT_EQ(scene.host->endpoint_stats().connections, 2u);
  EXPECT_TRUE(scene.host_events.closed.empty());
  scene.peer->close(scene.at_peer(), 0, "bye");
  ASSERT_TRUE(scene.run([&] { return !scene.host_events.closed.empty(); }));
  const std::uint64_t failed = scene.host->endpoint_stats().handshakes_failed;
  run_for({scene.host.get()}, 1.5);  // the dead connection's ids are forgotten, the token is still young
  for (int i = 0; i < 20; ++i) scene.relay->inject(Relay::Way::kUp, scene.first[1]);
  run_for({scene.host.get()}, 0.1);
  EXPECT_EQ(scene.host->endpoint_stats().connections, 1u);
  EXPECT_EQ(scene.host->endpoint_stats().handshakes_failed, failed);
  EXPECT_TRUE(scene.bystander_is_well());
}

TEST(Hostile, DamagedPacketsHurtNobody) {
  Scene scene;
  ASSERT_GE(scene.first.size(), 4u);
  Stranger stranger(scene.host->local_address());
  std::size_t sent = 0;
  const auto feed = [&](const Bytes& packet) {
    stranger.send(packet);
    sent += packet.size();
    scene.relay->inject(Relay::Way::kUp, packet);
    if (++sent % 8 == 0)
      run_until({scene.host.get(), scene.peer.get()}, [n = 0]() mutable { return ++n > 2; });
  };
  for (const Bytes& packet : scene.first) {
    const std::size_t step = packet.size() > 600 ? 3 : 1;
    for (std::size_t at = 0; at < packet.size(); at += at < 64 ? 1 : step) {
      Bytes damaged = packet;
      damaged[at] ^= static_cast<std::uint8_t>(1u << (at % 8));
      feed(damaged);
    }
    for (std::size_t size = 0; size < packet.size(); size += size < 64 ? 1 : 37)
      feed(Bytes(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size)));
  }
  run_for({scene.host.get(), scene.peer.get()}, 0.3);
  EXPECT_TRUE(scene.host_events.closed.empty()) << scene.host_events.reasons[0].text;
  EXPECT_TRUE(scene.peer_events.closed.empty());
  EXPECT_EQ(scene.host->endpoint_stats().connections, 2u);
  EXPECT_GT(scene.host->endpoint_stats().packets_ignored, 100u);
  EXPECT_LE(total(stranger.answers()), sent);
  EXPECT_TRUE(scene.bystander_is_well());
}

TEST(Hostile, DamageOnTheWayOnlyDelaysAHandshake) {
  // Every third packet of each way is damaged, from the first on: what is left makes the connection.
  Pair pair;
  auto relay = Relay::start({"127.0.0.1:0", pair.host->local_address(), {}, {}, 1});
  ASSERT_TRUE(relay);
  relay.value()->tamper([n = 0u](Relay::Way, Relay::Packet& packet) mutable {
    if (++n % 3 == 0) packet[(n * 37) % packet.size()] ^= 0x55;
  });
  pair.connect({relay.value()->address()});
  ASSERT_TRUE(pair.run([&] { return pair.connected(); }));
}

TEST(Hostile, NoiseIsIgnored) {
  Scene scene;
  Stranger stranger(scene.host->local_address());
  std::mt19937 random(5);
  std::size_t sent = 0;
  for (int i = 0; i < 4000; ++i) {
    Bytes packet(random() % 1400);
    for (auto& byte : packet) byte = static_cast<std::uint8_t>(random());
    // A fair share looks like QUIC: long header, version 1, every packet type.
    if (packet.size() > 8 && i % 2) {
      packet[0] = static_cast<std::uint8_t>(0xc0 | (random() & 0x3f));
      packet[1] = packet[2] = packet[3] = 0;
      packet[4] = 1;
      packet[5] = static_cast<std::uint8_t>(random() % 22);
    }
    stranger.send(packet);
    sent += packet.size();
    if (i % 16 == 0) scene.host->run_once(0);
  }
  run_for({scene.host.get()}, 0.1);
  EXPECT_EQ(scene.host->endpoint_stats().connections, 2u);
  EXPECT_LE(total(stranger.answers()), sent);
  EXPECT_TRUE(scene.bystander_is_well());
}

TEST(Hostile, APeerSurvivesNoiseFromTheHostsAddress) {
  Scene scene;
  const auto down = scene.relay->captured(Relay::Way::kDown);
  ASSERT_FALSE(down.empty());
  std::mt19937 random(6);
  for (const Bytes& packet : down)
    for (int i = 0; i < 200; ++i) {
      Bytes damaged = packet;
      damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
      if (i % 4 == 0) damaged.resize(random() % damaged.size());
      scene.relay->inject(Relay::Way::kDown, damaged);
      if (i % 8 == 0) scene.peer->run_once(0);
    }
  run_for({scene.host.get(), scene.peer.get()}, 0.1);
  EXPECT_TRUE(scene.peer_events.closed.empty()) << scene.peer_events.reasons[0].text;
  ASSERT_TRUE(scene.peer->send_datagram(scene.at_peer(), Priority::kPose, shared({9})));
  ASSERT_TRUE(scene.run([&] { return !scene.host_events.datagrams.empty(); }));
}

TEST(Hostile, AnotherVersionIsToldOurs) {
  Scene scene;
  Bytes packet = scene.first[0];
  packet[1] = packet[2] = packet[3] = packet[4] = 0x1a;
  Stranger stranger(scene.host->local_address());
  stranger.send(packet);
  run_for({scene.host.get()}, 0.05);
  const auto answers = stranger.answers();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0][1] | answers[0][2] | answers[0][3] | answers[0][4], 0) << "not version negotiation";
  EXPECT_LT(answers[0].size(), 100u);
}

TEST(Limits, HoldForConnectionsAndForOneSite) {
  EndpointOptions options;
  options.max_connections = 3;
  options.handshakes_per_second = 2.0;  // four at once
  Pair pair(options);
  std::vector<std::unique_ptr<Endpoint>> peers;
  std::vector<std::unique_ptr<Recorder>> events;
  std::vector<Endpoint*> ends{pair.host.get()};
  for (int i = 0; i < 4; ++i) {
    events.push_back(std::make_unique<Recorder>());
    peers.push_back(std::move(connect_quic({pair.host->local_address()}, pair.host_identity.fingerprint(),
                                           Identity::generate(), *events.back())
                                  .value()));
    ends.push_back(peers.back().get());
    ASSERT_TRUE(
        run_until(ends, [&] { return !events.back()->connected.empty() || !events.back()->closed.empty(); }));
    if (i == 3) break;
    const auto count = static_cast<std::size_t>(i) + 1;
    ASSERT_TRUE(run_until(ends, [&] { return pair.host_events.connected.size() == count; }));
    pair.host->admit(pair.host_events.connected.back());
  }
  EXPECT_EQ(pair.host->endpoint_stats().connections, 3u);
  ASSERT_FALSE(events[3]->closed.empty());
  EXPECT_EQ(events[3]->reasons[0].text, "the host has as many connections as it may");
  EXPECT_EQ(events[3]->reasons[0].cause, CloseCause::kBusy);
  // The next waits, is not refused, and gets in as time allows.
  peers[0].reset();
  ends = {pair.host.get(), peers[1].get(), peers[2].get()};
  ASSERT_TRUE(run_until(ends, [&] { return pair.host->endpoint_stats().connections == 2; }));
  Recorder late;
  auto next = connect_quic({pair.host->local_address()}, pair.host_identity.fingerprint(),
                           Identity::generate(), late);
  ends.push_back(next.value().get());
  ASSERT_TRUE(run_until(ends, [&] { return !late.connected.empty(); }));
}

TEST(ProbeStream, IsNoWayToKeepAHostBusy) {
  Pair pair;
  ASSERT_TRUE(pair.establish());
  ASSERT_TRUE(pair.peer->send_stream(pair.at_peer(), quic::kProbeStream, Bytes(200 << 10, 0), false));
  ASSERT_TRUE(pair.run([&] { return !pair.host_events.closed.empty(); }));
  EXPECT_EQ(pair.host_events.reasons[0].text, "the other side sends more probes than packets");
  EXPECT_TRUE(pair.host_events.streams.empty()) << "nobody reads them";
}

}  // namespace
}  // namespace slosh::testing
