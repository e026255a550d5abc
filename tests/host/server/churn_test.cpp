// Thousands come and go, and nothing stays behind.
#include <malloc.h>

#include <cstring>

#include "net/clock.h"
#include "tests/host/server/scripted_peer.h"

namespace slosh {
namespace {

ServerOptions running() {
  ServerOptions options;
  options.hands_to_start = 0;
  return options;
}

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

}  // namespace
}  // namespace slosh
