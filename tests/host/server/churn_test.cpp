// Thousands come and go, and nothing stays behind.
#include <malloc.h>

#include <cstring>

#include "net/clock.h"
#include "tests/host/server/server_kit.h"

namespace slosh {
namespace {

class Churn : public ServedTest {
 protected:
  Churn() : ServedTest(running()) {}

  /// Comes, looks, takes hold where it may, goes in one of four ways.
  void come_and_go(std::uint32_t i) {
    KeyFingerprint key{};
    std::memcpy(key.data(), &i, sizeof i);
    ScriptedPeer peer(network, 0);
    peer.end = network.connect(peer, key, "192.0.2.1:" + std::to_string(i % 60000));
    peer.hello(i % 2 ? watch : hold, std::to_string(i % 50));
    const auto turn = [&](double seconds) {
      network.advance(seconds);
      if (peer.end) peer.end->run_once(0);
      endpoint->run_once(0);
      server->turn();
      if (peer.end) peer.end->run_once(0);
    };
    for (int k = 0; k < 3; ++k) turn(0.05);
    ASSERT_TRUE(peer.in()) << i << ": " << peer.reason.text;
    peer.take(i % 3);
    peer.pose(i % 3, 1, 0.1);
    turn(0.05);
    desk.take_order();
    if (i % 4 == 0) peer.say(wire::Bye{"bye"});
    if (i % 4 == 1) peer.close();
    if (i % 4 == 2) peer.raw({0, 0, 0});
    if (i % 4 == 3) peer.vanish();
    turn(0.5);
    turn(6.0);
    told.clear();
  }
};

TEST_F(Churn, TwoThousandPeersLeaveNothingBehind) {
  const auto in_use = [] { return static_cast<std::int64_t>(mallinfo2().uordblks); };
  // The first fill what is kept on purpose: seats of a minute, the keys that a link remembers.
  for (std::uint32_t i = 0; i < 2200; ++i) come_and_go(i);
  const std::int64_t before = in_use();
  for (std::uint32_t i = 2200; i < 4200; ++i) come_and_go(i);
  const std::int64_t after = in_use();
  go(70.0, 0.5);
  EXPECT_TRUE(server->empty());
  EXPECT_TRUE(server->seats().seats().empty());
  EXPECT_EQ(endpoint->endpoint_stats().connections, 0u);
  EXPECT_EQ(server->figures().joins, 4200u);
  EXPECT_LT(after - before, 64 * 1024) << "bytes that 2 000 joins left";
}

TEST_F(Churn, ComingsAndGoingsAreToldAsDifferences) {
  ScriptedPeer& changes = arrive(201, "observer 201", wire::kOurCapabilities);
  ScriptedPeer& whole = arrive(202, "observer 202", 0);
  go(0.2);
  for (std::uint8_t key = 1; key <= 50; ++key) join(key, watch, "person number " + std::to_string(key));
  go(0.5);
  const std::size_t changes_before = changes.control_bytes;
  const std::size_t whole_before = whole.control_bytes;
  for (int round = 0; round < 4; ++round) {
    for (std::size_t i = 2; i < 52; ++i) {
      const auto key = static_cast<std::uint8_t>(i - 1);
      peers[i]->say(wire::Bye{});
      go(0.06);
      peers[i] = std::make_unique<ScriptedPeer>(network, key);
      peers[i]->hello(watch, "person number " + std::to_string(key));
      go(0.06);
      ASSERT_TRUE(peers[i]->in());
    }
  }
  go(0.2);
  const std::size_t by_changes = changes.control_bytes - changes_before;
  const std::size_t by_whole = whole.control_bytes - whole_before;
  std::printf("200 goings and comings among 50: %zu bytes as differences, %zu as whole rosters\n", by_changes,
              by_whole);
  EXPECT_LT(by_changes * 10, by_whole);
  EXPECT_LT(by_changes, 400u * 60u);
  // Whichever way, all know the same, and it is right.
  const std::vector<wire::RosterEntry> truth = server->seats().message().peers;
  for (const auto& peer : peers) EXPECT_EQ(peer->rosters.back().peers, truth);
}

TEST(RosterTold, WhoCameBetweenTwoChangesKnowsTheSame) {
  const auto entry = [](std::uint32_t number, const std::string& name) {
    return wire::RosterEntry{number, name, wire::Role::kSpectator, true, {}};
  };
  wire::RosterTold told;
  std::vector<wire::RosterEntry> early;
  wire::apply(told.change({{entry(0, "Ana"), entry(1, "Ben")}}), early);
  // Between two changes Cem comes; Dan is given the whole roster; Cem goes, and Eve takes his number or not.
  for (const bool reused : {false, true}) {
    const wire::Roster with_cem{{entry(0, "Ana"), entry(1, "Ben"), entry(2, "Cem")}};
    told.whole(with_cem);
    std::vector<wire::RosterEntry> late = with_cem.peers;
    wire::Roster now{{entry(0, "Ana"), entry(1, "Ben")}};
    if (reused) now.peers.push_back(entry(2, "Eve"));
    const wire::RosterChange change = told.change(now);
    wire::apply(change, early);
    wire::apply(change, late);
    EXPECT_EQ(early, now.peers);
    EXPECT_EQ(late, now.peers);
  }
  EXPECT_TRUE(told.change({early}).changed.empty());
}

}  // namespace
}  // namespace slosh
