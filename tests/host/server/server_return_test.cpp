// Hands that are lost and come back, people who leave, a host that ends and begins again.
#include <algorithm>
#include <set>

#include "net/clock.h"
#include "tests/host/server/server_kit.h"

namespace slosh {
namespace {

TEST_F(ServerTest, ALostHandIsKeptAndComesBack) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  ana.take(0);
  std::uint64_t number = 0;
  const auto hold_on = [&] { ana.pose(0, ++number, 0.15); };
  go(1.0, 0.005, hold_on);
  const std::uint32_t seat = ana.welcomes[0].peer;
  ana.close("gone");
  go(0.1);
  EXPECT_TRUE(pose(0).engaged) << "nobody else carries it: it stays where it was";
  EXPECT_EQ(pose(0).twist.linear, glm::dvec3(0.0));
  EXPECT_FALSE(pose(0).lost);
  EXPECT_TRUE(ben.noticed("contact with Ana is lost"));
  ASSERT_NE(ben.entry("Ana"), nullptr);
  EXPECT_FALSE(ben.entry("Ana")->connected);
  EXPECT_FALSE(ben.hands.back().engaged);
  ben.take(0);
  go(0.1);
  EXPECT_NE(ben.answers.back().text.find("is kept for Ana"), std::string::npos);

  go(50.0, 0.1);
  ScriptedPeer& back = join(1, "whatever");
  ASSERT_TRUE(back.in());
  EXPECT_TRUE(back.welcomes[0].restored);
  EXPECT_EQ(back.welcomes[0].peer, seat);
  EXPECT_EQ(back.welcomes[0].name, "Ana");
  EXPECT_EQ(back.entry("Ana")->grips, (std::vector<std::uint32_t>{0}));
  EXPECT_TRUE(ben.noticed("Ana is back"));
  back.pose(0, 1, 0.2);  // its numbers begin anew
  go(0.05);
  EXPECT_TRUE(pose(0).engaged);
}

TEST_F(ServerTest, AfterAMinuteTheSeatIsFree) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  ana.take(0);
  go(0.1);
  ana.close();
  go(61.0, 0.1);
  EXPECT_EQ(ben.entry("Ana"), nullptr);
  EXPECT_TRUE(ben.noticed("did not come back"));
  ben.take(0);
  go(0.1);
  EXPECT_TRUE(ben.answers.back().granted);
  const ScriptedPeer& again = join(1, "Ana");
  EXPECT_FALSE(again.welcomes[0].restored);
  EXPECT_TRUE(again.entry("Ana")->grips.empty());
}

TEST_F(ServerTest, ACrashOrAPulledCableIsNoticed) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  ana.take(0);
  std::uint64_t number = 0;
  go(1.0, 0.005, [&] { ana.pose(0, ++number, 0.15); });
  network.set_dark(*ana.end, true);
  go(0.7);
  EXPECT_TRUE(ben.noticed("Ana is not heard any more; what they hold waits for them"));
  EXPECT_TRUE(pose(0).engaged) << "half a second without a word, and nobody to catch what falls";
  EXPECT_TRUE(ben.entry("Ana")->connected);
  network.set_dark(*ana.end, false);
  go(0.3, 0.005, [&] { ana.pose(0, ++number, 0.15); });
  EXPECT_TRUE(ben.noticed("Ana is heard again"));
  EXPECT_TRUE(pose(0).engaged);
  ana.vanish();
  go(6.0, 0.05);
  EXPECT_TRUE(ben.noticed("contact with Ana is lost"));
}

TEST_F(ServerTest, ByeFreesTheGripAtOnce) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  ana.take(0);
  go(0.1);
  ana.say(wire::Bye{"done"});
  go(0.1);
  EXPECT_TRUE(ana.closed);
  EXPECT_TRUE(ben.noticed("Ana has left"));
  ben.take(0);
  go(0.1);
  EXPECT_TRUE(ben.answers.back().granted);
}

TEST_F(ServerTest, TheSamePersonFromElsewhereTakesOver) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  ana.take(0);
  go(0.1);
  const std::size_t notices = ben.notices.size();
  ScriptedPeer& again = join(1, hold, "Ana", "198.51.100.7:1");
  ASSERT_TRUE(again.in());
  EXPECT_EQ(again.welcomes[0].peer, ana.welcomes[0].peer);
  EXPECT_EQ(again.entry("Ana")->grips, (std::vector<std::uint32_t>{0}));
  ASSERT_EQ(ana.refusals.size(), 1u);
  EXPECT_EQ(ana.refusals[0].code, wire::RefusalCode::kReplaced);
  EXPECT_TRUE(ana.closed);
  for (std::size_t i = notices; i < ben.notices.size(); ++i)
    EXPECT_EQ(ben.notices[i].find("lost"), std::string::npos) << ben.notices[i];
}

TEST_F(ServerTest, EndingTellsEverybody) {
  const ScriptedPeer& ana = join(1, "Ana");
  const ScriptedPeer& eve = join(2, watch, "Eve");
  server->end("the host has ended the run");
  go(0.1);
  for (const ScriptedPeer* peer : {&ana, &eve}) {
    EXPECT_TRUE(peer->closed);
    ASSERT_EQ(peer->refusals.size(), 1u);
    EXPECT_EQ(peer->refusals[0].code, wire::RefusalCode::kEnding);
    EXPECT_EQ(peer->refusals[0].text, "the host has ended the run");
  }
  EXPECT_TRUE(server->empty());
}

TEST_F(ServerTest, ARunGoesOnAfterARestart) {
  ScriptedPeer& ana = join(1, "Ana");
  ana.take(0);
  go(0.2);
  ServerState state;
  ASSERT_FALSE(wire::decode(server->state_blob(), state));
  ASSERT_EQ(state.seats.size(), 1u);

  const std::uint64_t number = server->world_number();
  peers.clear();
  endpoint.reset();
  MemoryNetwork other;
  ServedWorld world;
  world.scene = &scene;
  world.channel = &channel;
  world.desk = &desk;
  world.spacing = 0.01;
  world.time_step = 0.002;
  world.command = [](const HostCommand&, const HostAnswer&) {};
  ServerOptions options = running();
  options.clock = [&] { return other.now_ns(); };
  Server next(std::move(world), options);
  next.restore(state);
  const auto end = other.listen(next);
  next.use(*end);
  ScriptedPeer back(other, 1);
  back.hello(hold, "Ana");
  for (int i = 0; i < 20; ++i) {
    other.advance(0.01);
    back.end->run_once(0);
    end->run_once(0);
    next.turn();
    back.end->run_once(0);
  }
  ASSERT_TRUE(back.in());
  EXPECT_TRUE(back.welcomes[0].restored);
  EXPECT_EQ(back.welcomes[0].world, number);
  EXPECT_EQ(back.entry("Ana")->grips, (std::vector<std::uint32_t>{0}));
  back.vanish();
}

TEST_F(ServerTest, EverybodyIsToldOfCutsAndWhoComesLaterToo) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& old = arrive(2, "Old", wire::kOurCapabilities & ~wire::kBodyCuts);
  publish_bodies(1);
  go(0.1);
  EXPECT_TRUE(ana.cuts.empty()) << "all is whole";
  const auto cuts = std::make_shared<BodyCuts>();
  cuts->since = 7;
  cuts->bodies.resize(scene.bodies.size());
  cuts->bodies[0] = {{{{0.0, 1.0, 0.0}, 0.02}}, {0.25, glm::dvec3(0.0), glm::dmat3(1e-3)}};
  for (std::uint64_t tick = 7; tick < 12; ++tick) {
    publish_bodies(tick, {}, cuts);
    go(0.02);
  }
  ASSERT_EQ(ana.cuts.size(), 1u) << "once";
  EXPECT_EQ(ana.cuts[0].since, 7u);
  ASSERT_EQ(ana.cuts[0].bodies.size(), 1u) << "of what is whole nothing is said";
  EXPECT_EQ(ana.cuts[0].bodies[0].cut.planes, cuts->bodies[0].planes);
  EXPECT_EQ(ana.cuts[0].bodies[0].cut.mass, cuts->bodies[0].mass);
  EXPECT_TRUE(old.cuts.empty()) << "an earlier peer is not told what it does not know";
  const ScriptedPeer& eve = join(3, watch, "Eve");
  ASSERT_EQ(eve.cuts.size(), 1u);
  EXPECT_EQ(eve.cuts[0].bodies[0].cut.mass.mass, 0.25);
  EXPECT_TRUE(ana.fault.empty() && eve.fault.empty());
}

}  // namespace
}  // namespace slosh
