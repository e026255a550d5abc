// Snapshots from the queue through the codec to peers, each at the quality of its link.
#include "host/server/snapshot_coder.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "net/clock.h"
#include "tests/host/server/server_kit.h"

namespace slosh {
namespace {

/// A block of fluid that sways.
Snapshot snapshot_at(std::uint64_t tick) {
  Snapshot snapshot;
  snapshot.rigid.tick = tick;
  snapshot.rigid.time = static_cast<double>(tick) / kTierSnapshotRate;
  for (int i = 0; i < 4000; ++i) {
    const auto cell = [&](int n) { return 0.01f * static_cast<float>(n); };
    const auto sway = static_cast<float>(0.02 * std::sin(snapshot.rigid.time * 3.0 + 0.1 * (i % 20)));
    snapshot.positions.emplace_back(cell(i % 20) + sway, cell(i / 20 % 20), cell(i / 400));
    snapshot.fluid_index.push_back(0);
    snapshot.shell.push_back(i / 20 % 20 == 19 || i % 20 == 0 ? 1 : 0);
  }
  return snapshot;
}

class Snapshots : public ServedTest {
 protected:
  Snapshots() : ServedTest(running()) {}

  /// The world runs for so long, 60 snapshots a second.
  void show(double seconds, const std::function<void()>& each = {}) {
    go(seconds, 1.0 / kTierSnapshotRate, [&] {
      std::vector<CodedSnapshot> coded;
      const Snapshot snapshot = snapshot_at(++tick);
      coder.see(snapshot, 0);
      coder.code(snapshot, desk.take_order(), coded);
      desk.deliver(std::move(coded));
      if (each) each();
    });
  }
  SnapshotCoder coder{0.01};
  std::uint64_t tick = 0;
};

/// What a real peer's decoder makes of what came.
class Watcher final : public EndpointEvents {
 public:
  Watcher(MemoryNetwork& network, std::uint8_t key, const wire::Token& token) {
    KeyFingerprint fingerprint{};
    fingerprint.fill(key);
    end = network.connect(*this, fingerprint, "192.0.2.9:" + std::to_string(key));
    const std::int64_t control = end->open_stream(1, true);
    end->send_stream(1, control, wire::control(wire::Hello{wire::kProtocolVersion, token, "w", {}, 0, {}}),
                     false);
  }
  void turn(std::int64_t now_ns) {
    end->run_once(0);
    while (std::optional<DecodedFrame> frame = decoders[stream].next()) {
      frames += 1;
      complete = frame->complete;
      particles = frame->positions.size();
    }
    if (now_ns < next_feedback_ns) return;
    next_feedback_ns = now_ns + 100'000'000;
    end->send_datagram(1, Priority::kState,
                       std::make_shared<const wire::Bytes>(wire::datagram(decoders[stream].feedback())));
  }
  void on_connected(ConnectionId, const KeyFingerprint&, const std::string&) override {}
  void on_stream(ConnectionId, std::int64_t, std::span<const std::uint8_t>, bool) override {}
  void on_closed(ConnectionId, const CloseReason&) override {}
  void on_datagram(ConnectionId, std::span<const std::uint8_t> bytes) override {
    if (bytes[0] != static_cast<std::uint8_t>(wire::DatagramType::kSnapshotPiece)) return;
    received += bytes.size();
    stream = bytes[1];  // a piece's first field; each stream has epochs of its own
    if (const wire::Fault found = decoders[stream].take(bytes)) fault = found.text();
  }
  std::unique_ptr<Endpoint> end;
  std::map<std::uint8_t, SnapshotDecoder> decoders;
  std::uint8_t stream = kShell;
  std::uint64_t frames = 0;
  std::string fault;  // of a piece that the decoder refused
  std::size_t received = 0;
  std::size_t particles = 0;
  double complete = 0.0;
  std::int64_t next_feedback_ns = 0;
};

TEST_F(Snapshots, NobodyWatchesAndNothingIsCoded) {
  std::vector<CodedSnapshot> coded;
  coder.code(snapshot_at(1), desk.take_order(), coded);
  EXPECT_TRUE(coded.empty());
}

TEST_F(Snapshots, AreOfTheRunThatTheirBodiesAreOf) {
  SnapshotDecoder decoder;
  // As a peer reads it.
  const auto seen = [&](std::uint64_t at, std::uint32_t newest_run) -> std::optional<std::uint32_t> {
    const Snapshot snapshot = snapshot_at(at);
    coder.see(snapshot, newest_run);
    SnapshotOrder order;
    order.watched[kAllParticles] = true;
    std::vector<CodedSnapshot> coded;
    coder.code(snapshot, order, coded, true);
    for (const CodedSnapshot& one : coded) {
      for (const Piece& piece : one.frame.pieces) EXPECT_FALSE(decoder.take(*piece.bytes));
    }
    std::optional<std::uint32_t> run;
    while (const std::optional<DecodedFrame> frame = decoder.next(0)) run = frame->run;
    return run;
  };
  EXPECT_EQ(seen(1, 0), 0u);
  EXPECT_EQ(seen(1, 0), 0u) << "a world that stands shows its snapshot again to who begins to look";
  EXPECT_EQ(seen(5, 0), 0u);
  EXPECT_EQ(seen(6, 1), 0u) << "it waited while the world was reset";
  EXPECT_EQ(seen(1, 1), 1u);
  EXPECT_EQ(seen(1, 2), 2u) << "reset where it stood";
  EXPECT_EQ(seen(2, 2), 2u);
}

TEST_F(Snapshots, ALateWatcherHasTheWholeSnapshotSoon) {
  Watcher first(network, 1, watch);
  const auto both = [&] { first.turn(network.now_ns()); };
  show(1.0, both);
  EXPECT_EQ(first.complete, 1.0);
  EXPECT_NEAR(static_cast<double>(first.frames), 30.0, 4.0);
  Watcher late(network, 2, watch);
  show(0.25, [&] {
    both();
    late.turn(network.now_ns());
  });
  EXPECT_GT(late.frames, 2u);
  EXPECT_EQ(late.complete, 1.0) << "without waiting for the next epoch";
  EXPECT_EQ(late.particles, first.particles);
  EXPECT_EQ(first.fault + late.fault, "");
}

TEST_F(Snapshots, LossIsMended) {
  Watcher watcher(network, 1, watch);
  MemoryLink lossy;
  lossy.delay = 0.02;
  lossy.loss = 0.05;
  network.set_link(lossy);
  show(0.5, [&] { watcher.turn(network.now_ns()); });
  double complete = 0.0;
  int looks = 0;
  show(4.0, [&] {
    watcher.turn(network.now_ns());
    complete += watcher.complete;
    looks += 1;
  });
  EXPECT_GT(complete / looks, 0.85);
  EXPECT_EQ(watcher.fault, "");
  EXPECT_EQ(watcher.decoders.size(), 1u) << "plain loss is no reason for another tier";
}

TEST_F(Snapshots, ASlowLinkLowersOnlyItsOwnQuality) {
  Watcher fast(network, 1, watch);
  Watcher slow(network, 2, watch);
  const auto both = [&] {
    fast.turn(network.now_ns());
    slow.turn(network.now_ns());
  };
  show(2.0, both);
  ASSERT_EQ(server->tier_of(0), kShell);
  ASSERT_EQ(server->tier_of(1), kShell);
  const std::size_t before = fast.received;
  show(1.0, both);
  MemoryLink thin;
  thin.bytes_per_second = 0.4 * static_cast<double>(fast.received - before);
  network.set_link(*slow.end, thin);
  const std::uint64_t frames = fast.frames;
  int worst = 0;
  int looks = 0;
  int low = 0;
  show(8.0, [&] {
    both();
    worst = std::max(worst, server->tier_of(1));
    low += server->tier_of(1) > kShell ? 1 : 0;
    looks += 1;
  });
  EXPECT_GT(worst, kShell) << "the slow one";
  EXPECT_GT(low * 10, looks * 6);
  EXPECT_EQ(server->tier_of(0), kShell) << "the fast one";
  EXPECT_NEAR(static_cast<double>(fast.frames - frames), 250.0, 16.0) << "30 Hz, keys twice";
  EXPECT_GT(slow.frames, 60u) << "it still sees something";
}

TEST_F(Snapshots, AResetStartsAnotherRun) {
  Watcher watcher(network, 1, watch);
  show(0.5, [&] { watcher.turn(network.now_ns()); });
  tick = 0;
  const std::uint64_t before = watcher.frames;
  show(0.5, [&] { watcher.turn(network.now_ns()); });
  EXPECT_GT(watcher.frames, before + 5);
  EXPECT_EQ(watcher.complete, 1.0);
}

TEST_F(Snapshots, WhoDrawsNothingIsSentNone) {
  peers.push_back(std::make_unique<ScriptedPeer>(network, 1));
  peers.push_back(std::make_unique<ScriptedPeer>(network, 2));
  ScriptedPeer& draws = *peers[0];
  ScriptedPeer& blind = *peers[1];
  draws.hello(hold, "Ana");
  blind.hello(hold, "Ben", wire::SnapshotWish::kNone);
  show(2.0, [&] {
    publish_bodies(tick);
    // What a link of its own would ask for, which must not make the host send it anything.
    blind.datagram(wire::SnapshotFeedback{0, 0, 0, 0, 0, {{0, 10}}});
  });
  ASSERT_TRUE(draws.in() && blind.in());
  EXPECT_EQ(blind.snapshot_pieces, 0u);
  EXPECT_GT(draws.snapshot_pieces, 50u);
  EXPECT_EQ(blind.bodies.size(), draws.bodies.size()) << "bodies come as to everybody";
  EXPECT_EQ(server->tier_of(blind.welcomes[0].peer), -1);
  EXPECT_NE(server->command("who").text.find("gets no particles"), std::string::npos);
  std::printf("2 s of 4000 particles: %zu bytes of snapshots to who draws, %zu to who does not\n",
              draws.snapshot_bytes, blind.snapshot_bytes);
  EXPECT_GT(draws.snapshot_bytes, 20000u);

  // With nobody who draws nothing is coded either.
  draws.close();
  show(0.3);
  const SnapshotOrder order = desk.take_order();
  EXPECT_EQ(std::count(order.watched.begin(), order.watched.end(), true), 0);
}

}  // namespace
}  // namespace slosh
