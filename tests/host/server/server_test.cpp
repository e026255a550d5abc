// The server against peers that say what they like, over a network in memory.
#include "host/server/server.h"

#include "net/clock.h"
#include "tests/host/server/scripted_peer.h"

namespace slosh {
namespace {

ServerOptions running() {
  ServerOptions options;
  options.hands_to_start = 0;
  return options;
}

class ServerTest : public ServedTest {
 protected:
  ServerTest() : ServedTest(running()) {}
};

class WaitingServerTest : public ServedTest {};

TEST_F(ServerTest, ANewcomerGetsWelcomeSceneWorldAndRoster) {
  const ScriptedPeer& ana = join(1, "Ana");
  ASSERT_TRUE(ana.in());
  EXPECT_EQ(ana.welcomes[0].name, "Ana");
  EXPECT_EQ(ana.welcomes[0].role, wire::Role::kParticipant);
  EXPECT_EQ(ana.welcomes[0].scene_bytes, 5000u);
  EXPECT_EQ(ana.welcomes[0].session, server->session());
  EXPECT_FALSE(ana.welcomes[0].restored);
  EXPECT_EQ(ana.scene_bytes, 5000u);
  EXPECT_TRUE(ana.scene_ended);
  ASSERT_FALSE(ana.worlds.empty());
  EXPECT_EQ(ana.worlds[0].viscosities, (std::vector<double>{0.001}));
  ASSERT_NE(ana.entry("Ana"), nullptr);

  const ScriptedPeer& eve = join(2, watch, "Eve");
  EXPECT_EQ(eve.welcomes[0].role, wire::Role::kSpectator);
  EXPECT_NE(ana.entry("Eve"), nullptr);
  EXPECT_TRUE(ana.noticed("Eve is watching"));
  EXPECT_EQ(ana.fault + eve.fault, "");
}

TEST_F(ServerTest, GripsAreTakenReleasedAndRefusedInWords) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  ScriptedPeer& eve = join(3, watch, "Eve");
  ana.take(0);
  go(0.1);
  ASSERT_EQ(ana.answers.size(), 1u);
  EXPECT_TRUE(ana.answers[0].granted);
  EXPECT_EQ(ben.entry("Ana")->grips, (std::vector<std::uint32_t>{0}));
  ben.take(0);
  ben.take(1);  // the same body: several people may hold it
  ben.take(63);
  eve.take(2);
  ben.release(2);
  go(0.1);
  ASSERT_EQ(ben.answers.size(), 4u);
  EXPECT_EQ(ben.answers[0].text, "grip 'left' is held by Ana");
  EXPECT_TRUE(ben.answers[1].granted);
  EXPECT_NE(ben.answers[2].text.find("no grip 63"), std::string::npos);
  EXPECT_NE(ben.answers[3].text.find("do not hold"), std::string::npos);
  EXPECT_NE(eve.answers[0].text.find("for watching"), std::string::npos);
  ana.release(0);
  ben.take(0);
  go(0.1);
  EXPECT_TRUE(ben.answers[4].granted);
  EXPECT_EQ(ana.entry("Ben")->grips, (std::vector<std::uint32_t>{0, 1}));
}

TEST_F(ServerTest, PosesReachTheWorldAndTheOtherHands) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  ScriptedPeer& eve = join(3, watch, "Eve");
  ana.take(0);
  go(0.1);
  std::uint64_t number = 0;
  go(1.0, 0.002, [&] {
    number += 1;
    ana.pose(0, number, 0.7, 5000 + static_cast<std::int64_t>(number));
  });
  EXPECT_NEAR(pose(0).pose.position.x, 0.7, 1e-6);
  EXPECT_TRUE(pose(0).engaged);
  ASSERT_GT(ben.hands.size(), 400u);
  EXPECT_LE(ben.hands.size(), 530u);
  EXPECT_EQ(ben.hands.back().grip, 0u);
  EXPECT_FLOAT_EQ(static_cast<float>(ben.hands.back().pose.position.x), 0.7f);
  EXPECT_TRUE(ana.hands.empty());
  EXPECT_TRUE(eve.hands.empty());
  EXPECT_EQ(server->figures().samples_received, number);

  // The step used the last of them; only Ana is told, in her own numbers and on her own clock.
  publish_bodies(7, {pose(0).number});
  go(0.05);
  ASSERT_FALSE(ana.bodies.empty());
  EXPECT_EQ(ana.bodies.back().pose_number, number);
  EXPECT_EQ(ana.bodies.back().pose_stamp_ns, 5000 + static_cast<std::int64_t>(number));
  EXPECT_EQ(ben.bodies.back().pose_number, 0u);
  EXPECT_EQ(ana.bodies.back().tick, 7u);
  EXPECT_EQ(ana.bodies.back().bodies.size(), 2u) << "the fixed body is not sent";
}

TEST_F(ServerTest, BodiesAreThinnedForWatchers) {
  const ScriptedPeer& ana = join(1, "Ana");
  const ScriptedPeer& eve = join(2, watch, "Eve");
  const std::size_t ana_before = ana.bodies.size();
  const std::size_t eve_before = eve.bodies.size();
  std::uint64_t tick = 0;
  go(1.0, 0.001, [&] { publish_bodies(++tick); });
  EXPECT_NEAR(static_cast<double>(ana.bodies.size() - ana_before), 500.0, 20.0);
  EXPECT_NEAR(static_cast<double>(eve.bodies.size() - eve_before), 60.0, 5.0);
}

TEST_F(ServerTest, AStandingWorldIsShownToWhoComesLate) {
  publish_bodies(3);
  go(1.0);
  const ScriptedPeer& ana = join(1, "Ana");
  go(0.3);
  ASSERT_FALSE(ana.bodies.empty());
  EXPECT_EQ(ana.bodies.back().tick, 3u);
}

TEST_F(ServerTest, TheWorldObeysThoseWithHands) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& eve = join(2, watch, "Eve");
  ana.say(wire::WorldRequest{1, wire::WorldAction::kPause});
  ana.say(wire::ParameterRequest{2, wire::Parameter::kFluidViscosity, 0, 0.5});
  ana.say(wire::ParameterRequest{3, wire::Parameter::kFluidViscosity, 9, 0.5});
  ana.say(wire::ParameterRequest{4, wire::Parameter::kGravityScale, 0, 0.5});
  eve.say(wire::WorldRequest{1, wire::WorldAction::kReset});
  go(0.1);
  ASSERT_EQ(commands.size(), 3u);
  EXPECT_EQ(commands[0].action, HostAction::kPause);
  EXPECT_EQ(commands[1].action, HostAction::kViscosity);
  EXPECT_EQ(commands[1].value, 0.5);
  EXPECT_EQ(commands[2].action, HostAction::kGravityScale);
  ASSERT_EQ(ana.answers.size(), 4u);
  for (const wire::Answer& each : ana.answers) EXPECT_EQ(each.granted, each.request != 3) << each.text;
  ASSERT_EQ(eve.answers.size(), 1u);
  EXPECT_NE(eve.answers[0].text.find("for watching"), std::string::npos);
  EXPECT_TRUE(eve.noticed("Ana paused the world"));

  refuse_commands = "0.9 Pa·s is too much for the time step";
  ana.say(wire::ParameterRequest{5, wire::Parameter::kFluidViscosity, 0, 0.9});
  go(0.1);
  EXPECT_FALSE(ana.answers.back().granted);
  EXPECT_NE(ana.answers.back().text.find("too much"), std::string::npos);
}

TEST_F(WaitingServerTest, ParametersSetBeforehandDoNotKeepTheWorldFromStarting) {
  ScriptedPeer& ana = join(1, "Ana");
  ana.say(wire::ParameterRequest{1, wire::Parameter::kGravityScale, 0, 0.5});
  go(0.1);
  server->command("set gravity 1");
  ana.take(0);
  go(0.1);
  ASSERT_EQ(commands.size(), 3u);
  EXPECT_EQ(commands[2].action, HostAction::kContinue);
}

class LockedServerTest : public ServedTest {
 protected:
  static ServerOptions locked() {
    ServerOptions options = running();
    options.lock_parameters = true;
    return options;
  }
  LockedServerTest() : ServedTest(locked()) {}
};

TEST_F(LockedServerTest, OnlyTheHostSetsParameters) {
  ScriptedPeer& ana = join(1, "Ana");
  ana.say(wire::ParameterRequest{1, wire::Parameter::kFluidViscosity, 0, 0.5});
  ana.say(wire::ParameterRequest{2, wire::Parameter::kGravityScale, 0, 0.5});
  ana.say(wire::WorldRequest{3, wire::WorldAction::kPause});
  go(0.1);
  ASSERT_EQ(ana.answers.size(), 3u);
  EXPECT_EQ(ana.answers[0].text, "here only the host sets viscosity and gravity");
  EXPECT_FALSE(ana.answers[1].granted);
  EXPECT_TRUE(ana.answers[2].granted) << "a pause is no parameter";
  server->command("set gravity 0.5");
  ASSERT_EQ(commands.size(), 2u);
  EXPECT_EQ(commands[1].action, HostAction::kGravityScale);
}

TEST_F(WaitingServerTest, TheWorldWaitsForTheFirstHand) {
  ScriptedPeer& ana = join(1, "Ana");
  EXPECT_TRUE(ana.noticed("waits for the first hand"));
  EXPECT_TRUE(commands.empty());
  EXPECT_TRUE(pose(0).engaged) << "the host holds it meanwhile";
  ana.take(0);
  go(0.1);
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].action, HostAction::kContinue);
  join(2, "Ben").take(1);
  go(0.1);
  EXPECT_EQ(commands.size(), 1u);
}

TEST_F(ServerTest, ClockPingsAreAnsweredAtOnce) {
  ScriptedPeer& ana = join(1, "Ana");
  ana.datagram(wire::ClockPing{9, 77});
  go(0.02);
  ASSERT_EQ(ana.pongs.size(), 1u);
  EXPECT_EQ(ana.pongs[0].number, 9u);
  EXPECT_EQ(ana.pongs[0].ping_sent_ns, 77);
  EXPECT_NEAR(to_seconds(network.now_ns() - ana.pongs[0].received_ns), 0.0, 0.05);
}

TEST_F(ServerTest, ALostHandIsLetGoAndComesBack) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  ana.take(0);
  std::uint64_t number = 0;
  const auto hold_on = [&] { ana.pose(0, ++number, 0.15); };
  go(1.0, 0.005, hold_on);
  const std::uint32_t seat = ana.welcomes[0].peer;
  ana.close("gone");
  go(0.1);
  EXPECT_FALSE(pose(0).engaged);
  EXPECT_TRUE(pose(0).lost);
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
  EXPECT_FALSE(pose(0).engaged) << "half a second without a word";
  EXPECT_TRUE(ben.noticed("Ana is not heard any more"));
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
  server->end("the host has ended the session");
  go(0.1);
  for (const ScriptedPeer* peer : {&ana, &eve}) {
    EXPECT_TRUE(peer->closed);
    ASSERT_EQ(peer->refusals.size(), 1u);
    EXPECT_EQ(peer->refusals[0].code, wire::RefusalCode::kEnding);
    EXPECT_EQ(peer->refusals[0].text, "the host has ended the session");
  }
  EXPECT_TRUE(server->empty());
}

TEST_F(ServerTest, ASessionGoesOnAfterARestart) {
  ScriptedPeer& ana = join(1, "Ana");
  ana.take(0);
  go(0.2);
  SessionState state;
  ASSERT_FALSE(wire::decode(server->session_blob(), state));
  ASSERT_EQ(state.seats.size(), 1u);

  const std::uint64_t session = server->session();
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
  EXPECT_EQ(back.welcomes[0].session, session);
  EXPECT_EQ(back.entry("Ana")->grips, (std::vector<std::uint32_t>{0}));
  back.vanish();
}

TEST_F(ServerTest, TheConsoleRulesTheSession) {
  ScriptedPeer& ana = join(1, "Ana");
  ana.take(0);
  go(0.1);
  EXPECT_NE(server->command("who").find("Ana, participant, grip 'left'"), std::string::npos);
  EXPECT_NE(server->command("links").find(hold_id), std::string::npos);
  EXPECT_NE(server->command("links").find("used by Ana"), std::string::npos);
  EXPECT_NE(server->command("status").find("1 with hands"), std::string::npos);
  EXPECT_NE(server->command("nonsense").find("help"), std::string::npos);
  EXPECT_NE(server->command("link Ben for 10m").find("for Ben"), std::string::npos);
  EXPECT_EQ(server->links().links().back().name, "Ben");
  EXPECT_NE(server->links().links().back().expires_ns, 0);
  EXPECT_NE(server->command("release left").find("from Ana"), std::string::npos);
  go(0.1);
  EXPECT_TRUE(ana.noticed("the host took grip 'left' from Ana"));
  EXPECT_TRUE(ana.entry("Ana")->grips.empty());
  EXPECT_NE(server->command("release 9").find("no grip"), std::string::npos);
  server->command("set viscosity water 0.2");
  server->command("set gravity 0.5");
  server->command("reset");
  ASSERT_EQ(commands.size(), 3u);
  EXPECT_EQ(commands[0].value, 0.2);
  EXPECT_NE(server->command("set viscosity honey 1").find("water"), std::string::npos);
  EXPECT_NE(server->command("kick Nobody").find("nobody"), std::string::npos);
  server->command("kick Ana");
  go(0.1);
  EXPECT_TRUE(ana.closed);
  EXPECT_EQ(server->command("who"), "nobody is here");
  server->command("quit");
  EXPECT_TRUE(server->quit_asked());
}

TEST_F(ServerTest, AnExpiredLinkLetsItsPeopleBackForAMinuteAndRevokingEndsThatToo) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  ana.take(0);
  std::uint64_t number = 0;
  const auto alive = [&] {
    ana.pose(0, ++number, 0.15);
    if (!ben.closed) ben.datagram(wire::ClockPing{1, 1});
  };
  EXPECT_NE(server->command("expire " + hold_id + " 10s").find("nobody new"), std::string::npos);
  go(11.0, 0.05, alive);
  EXPECT_TRUE(ana.in() && ben.in()) << "who is in stays";
  EXPECT_EQ(join(3, "Cem").refusals.at(0).code, wire::RefusalCode::kBadToken) << "nobody new";
  ben.close();
  go(50.0, 0.05, alive);
  ScriptedPeer& again = join(2, "Ben");
  ASSERT_TRUE(again.in()) << "within the seat's minute";
  EXPECT_TRUE(again.welcomes[0].restored);
  again.close();
  go(61.0, 0.05, alive);
  EXPECT_EQ(join(2, "Ben").refusals.at(0).code, wire::RefusalCode::kExpired) << "and not later";
  EXPECT_TRUE(ana.in());
  server->command("revoke " + hold_id);
  go(0.1);
  EXPECT_TRUE(ana.closed);
  EXPECT_EQ(join(1, "Ana").refusals.at(0).code, wire::RefusalCode::kRevoked) << "no minute after that";
}

TEST_F(ServerTest, AnExpiredLinkIsKeptWhileItsPeopleAreHere) {
  join(1, "Ana");
  server->command("expire " + hold_id + " 1s");
  go(2.0, 0.1);
  for (std::size_t i = 0; i < kMaxLinks; ++i) server->command("link");
  ASSERT_NE(server->links().find(hold_id), nullptr) << "who came by it may have to be put out";
  server->command("revoke " + hold_id);
  go(0.1);
  EXPECT_TRUE(peers[0]->closed);
  EXPECT_NE(server->command("link").find("for anybody"), std::string::npos) << "that made room";
}

TEST_F(ServerTest, RevokingALinkPutsItsPeopleOut) {
  const ScriptedPeer& ana = join(1, "Ana");
  const ScriptedPeer& eve = join(2, watch, "Eve");
  server->command("revoke " + hold_id);
  go(0.1);
  ASSERT_EQ(ana.refusals.size(), 1u);
  EXPECT_EQ(ana.refusals[0].code, wire::RefusalCode::kRevoked);
  EXPECT_TRUE(ana.closed);
  EXPECT_TRUE(eve.in());
  const ScriptedPeer& again = join(1, "Ana");
  EXPECT_EQ(again.refusals[0].code, wire::RefusalCode::kRevoked);
  const ScriptedPeer& stranger = join(3, "Cem");
  EXPECT_EQ(stranger.refusals[0].code, wire::RefusalCode::kBadToken);
}

}  // namespace
}  // namespace slosh
