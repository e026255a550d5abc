// A server over real QUIC among strangers: who holds something feels nothing of them, and comes back through
// them.
#include <gtest/gtest.h>

#include <functional>

#include "net/clock.h"
#include "tests/host/server/scripted_peer.h"
#include "tests/net/quic/crafted_end.h"

namespace slosh {
namespace {

using testing::CraftedEnd;

/// As `slosh host` sets it up for a bucket: 188 connections, of which strangers get 128.
class RealServer {
 public:
  RealServer() : scene(served_scene()), channel(scene.grips.size(), first_state(scene), 1 << 20) {
    ServedWorld world;
    world.scene = &scene;
    world.package = wire::Bytes(5000, 7);
    world.channel = &channel;
    world.desk = &desk;
    world.spacing = 0.01;
    world.time_step = 0.002;
    world.state.viscosities = {0.001};
    world.command = [](const HostCommand&, const HostAnswer& answer) {
      if (answer) answer(Result<bool>(true));
    };
    ServerOptions options;
    options.hands_to_start = 0;
    options.admission.hello_patience = 60.0;  // whoever is put out is put out for want of room
    options.silence = 5.0;                    // of a loaded machine
    options.tell = [this](const std::string& line) { told.push_back(line); };
    options.limits.participants = 6;
    options.limits.spectators = 54;
    server = std::make_unique<Server>(std::move(world), options);
    EndpointOptions link;
    link.max_strangers = 128;
    link.max_connections = 188;
    link.idle_timeout = 30.0;
    link.handshake_timeout = 30.0;
    endpoint = std::move(listen_quic("127.0.0.1:0", identity, *server, link).value());
    server->use(*endpoint);
    hold = server->links().create(LinkRole::kHold, {}, 1)->token;
  }
  ~RealServer() { server->end("the test ends"); }

  std::unique_ptr<ScriptedPeer> visit(const Identity& key) {
    return std::make_unique<ScriptedPeer>([&](EndpointEvents& events) {
      EndpointOptions options;
      options.idle_timeout = 30.0;
      return std::move(
          connect_quic({endpoint->local_address()}, identity.fingerprint(), key, events, options).value());
    });
  }
  void turn() {
    endpoint->run_once(steady_now_ns() + 200'000);
    server->turn();
    for (ScriptedPeer* peer : peers)
      if (peer->end) peer->end->run_once(0);
    for (const auto& stranger : strangers) stranger->turn();
  }
  bool until(const std::function<bool()>& done, double seconds = 60.0) {
    const std::int64_t give_up = steady_now_ns() + to_nanoseconds(seconds);
    while (!done()) {
      if (steady_now_ns() > give_up) return false;
      turn();
    }
    return true;
  }
  bool join(ScriptedPeer& peer, const std::string& name) {
    peers.push_back(&peer);
    if (!until([&] { return peer.connection != 0 || peer.closed; }) || peer.closed) return false;
    peer.hello(hold, name);
    return until([&] { return peer.in() || peer.closed; }) && peer.in();
  }

  Identity identity = Identity::generate();
  Scene scene;
  Channel channel;
  SnapshotDesk desk;
  std::unique_ptr<Server> server;
  std::unique_ptr<Endpoint> endpoint;
  wire::Token hold{};
  std::vector<std::string> told;
  std::vector<ScriptedPeer*> peers;
  std::vector<std::unique_ptr<CraftedEnd>> strangers;
};

TEST(ServerCrowd, AThousandStrangersKeepNobodyOutWhoHoldsTheBucket) {
  RealServer host;
  const Identity ana_key = Identity::generate(), ben_key = Identity::generate();
  auto ana = host.visit(ana_key), ben = host.visit(ben_key);
  ASSERT_TRUE(host.join(*ana, "Ana"));
  ASSERT_TRUE(host.join(*ben, "Ben"));
  ana->take(0);
  ben->take(1);
  ASSERT_TRUE(host.until([&] { return ana->answers.size() == 1 && ben->answers.size() == 1; }));
  ASSERT_TRUE(ana->answers[0].granted && ben->answers[0].granted);

  // 500 who stop in the middle of a handshake and 500 who finish it and say nothing, from 250 addresses, four
  // at a time of each, so that no budget of a site keeps them away.
  std::uint64_t number = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::string from =
        "127.0." + std::to_string(20 + i % 250 / 50) + "." + std::to_string(1 + i % 50) + ":0";
    host.strangers.push_back(CraftedEnd::client(host.endpoint->local_address(), from));
    CraftedEnd& stranger = *host.strangers.back();
    const bool half = i % 2 == 0;
    host.until([&] { return (half ? stranger.largest_received() > 0 : stranger.open()) || stranger.over(); },
               0.5);
    if (half) stranger.go_silent();
    if (i % 20 == 0) ana->pose(0, ++number, 0.15);
  }
  const EndpointStats full = host.endpoint->endpoint_stats();
  EXPECT_EQ(full.strangers, 128u);
  EXPECT_EQ(full.connections, 130u);
  EXPECT_TRUE(ana->in());
  EXPECT_TRUE(ben->in());

  // Ben's program dies. The seat is kept for a minute, and the strangers stay.
  ben->end.reset();
  std::erase(host.peers, ben.get());
  auto again = host.visit(ben_key);
  ASSERT_TRUE(host.join(*again, "Ben"));
  EXPECT_TRUE(again->welcomes[0].restored);
  EXPECT_TRUE(host.until([&] {
    const auto* entry = again->entry("Ben");
    return entry && entry->grips == std::vector<std::uint32_t>{1};
  }));
  // And a newcomer finds a way in as well.
  auto zoe = host.visit(Identity::generate());
  EXPECT_TRUE(host.join(*zoe, "Zoe"));
  ana->pose(0, ++number, 0.2);
  EXPECT_TRUE(host.until([&] { return host.server->figures().samples_received > 0; }));
  EXPECT_TRUE(ana->in());
  EXPECT_LT(host.told.size(), 40u) << "a line for every stranger";
}

}  // namespace
}  // namespace slosh
