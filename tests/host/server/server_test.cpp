// The server against peers that say what they like, over a network in memory.
#include <algorithm>
#include <set>

#include "net/clock.h"
#include "tests/host/server/server_kit.h"
#include "tests/support/stirred_tank.h"

namespace slosh {
namespace {

TEST_F(ServerTest, ANewcomerGetsWelcomeSceneWorldAndRoster) {
  const ScriptedPeer& ana = join(1, "Ana");
  ASSERT_TRUE(ana.in());
  EXPECT_EQ(ana.welcomes[0].name, "Ana");
  EXPECT_EQ(ana.welcomes[0].role, wire::Role::kParticipant);
  EXPECT_EQ(ana.welcomes[0].scene_bytes, 5000u);
  EXPECT_EQ(ana.welcomes[0].world, server->world_number());
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

TEST_F(ServerTest, TheFirstMessagesComeInTheOrderOfThePage) {
  const ScriptedPeer& ana = join(1, "Ana");
  ASSERT_GE(ana.order.size(), 3u);
  EXPECT_EQ(ana.order[0], wire::ControlType::kWelcome);
  EXPECT_EQ(ana.order[1], wire::ControlType::kRoster);
  EXPECT_EQ(ana.order[2], wire::ControlType::kWorldInfo);
}

TEST_F(ServerTest, OldAndNewPeersAgreeOnWhatBothKnow) {
  ScriptedPeer& newest = join(1, "Ana");
  const auto with = [&](std::uint8_t key, wire::Capabilities capabilities,
                        const wire::Bytes& later) -> ScriptedPeer& {
    peers.push_back(std::make_unique<ScriptedPeer>(network, key));
    peers.back()->capabilities = capabilities;
    peers.back()->later = later;
    peers.back()->hello(hold, "P" + std::to_string(key));
    ScriptedPeer& peer = *peers.back();
    go(0.1);
    return peer;
  };
  ScriptedPeer& plain = with(2, 0, {});
  // One from the future: bits that nobody knows, and fields for them.
  ScriptedPeer& future =
      with(3, wire::kOurCapabilities | wire::Capabilities{1} << 40, wire::Bytes(300, 0xee));
  ASSERT_TRUE(newest.in() && plain.in() && future.in());
  EXPECT_EQ(newest.welcomes[0].capabilities, wire::kOurCapabilities);
  EXPECT_EQ(plain.welcomes[0].capabilities, 0u);
  EXPECT_EQ(future.welcomes[0].capabilities, wire::kOurCapabilities) << "no bit that the host does not know";
  newest.take(0);
  go(0.2);
  for (const ScriptedPeer* peer : {&newest, &plain, &future}) {
    ASSERT_NE(peer->entry("Ana"), nullptr);
    EXPECT_EQ(peer->entry("Ana")->grips, (std::vector<std::uint32_t>{0}));
    EXPECT_EQ(peer->rosters.back().peers.size(), 3u);
    EXPECT_EQ(peer->fault, "");
  }
  EXPECT_TRUE(plain.roster_changes.empty());
  EXPECT_FALSE(future.roster_changes.empty());
}

TEST_F(ServerTest, OneCopyOfTheSceneServesEverybody) {
  std::set<const std::uint8_t*> seen;
  for (std::uint8_t key = 1; key <= 40; ++key) {
    ScriptedPeer& peer = join(key, watch);
    ASSERT_TRUE(peer.scene_ended);
    seen.insert(peer.scene_data);
  }
  EXPECT_EQ(seen.size(), 1u);
}

TEST_F(ServerTest, ARefusedPoseIsToldToItsHolderOnceAKind) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  ana.take(0);
  go(0.1);
  for (int i = 0; i < 500; ++i) server->on_refused_pose(0, PoseFault::kTooFast);
  server->on_refused_pose(0, PoseFault::kOutOfRange);
  server->on_refused_pose(1, PoseFault::kTooFast);  // nobody's
  go(0.1);
  const auto refusals = [](const ScriptedPeer& peer) {
    return std::count_if(peer.notices.begin(), peer.notices.end(), [](const std::string& text) {
      return text.find("your poses for grip 'left' are not used: ") != std::string::npos;
    });
  };
  EXPECT_EQ(refusals(ana), 2);
  EXPECT_TRUE(ana.noticed("moves or jumps faster than 20 m/s"));
  EXPECT_TRUE(ana.noticed("more than 5 m outside the scene"));
  EXPECT_EQ(refusals(ben), 0);
  ana.release(0);
  ana.take(0);
  go(0.1);
  server->on_refused_pose(0, PoseFault::kTooFast);
  go(0.1);
  EXPECT_EQ(refusals(ana), 3) << "a new hold is told anew";
}

TEST_F(ServerTest, WhatLeftTheWorldIsToldToAllAndCannotBeHeldUntilItIsSetBack) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  ana.take(0);
  go(0.1);
  ASSERT_TRUE(ana.answers.at(0).granted);
  const auto body = static_cast<std::size_t>(scene.grips[0].body);
  server->on_gone_body(body, "'bucket' left the world at 1.00 s, at (0.00 -3.00 0.00) m");
  go(0.1);
  EXPECT_TRUE(ana.noticed("'bucket' left the world at 1.00 s"));
  EXPECT_TRUE(ben.noticed("'bucket' left the world at 1.00 s"));
  ASSERT_NE(ben.entry("Ana"), nullptr);
  EXPECT_TRUE(ben.entry("Ana")->grips.empty()) << "nobody holds it any more";
  ben.take(0);
  go(0.1);
  ASSERT_EQ(ben.answers.size(), 1u);
  EXPECT_FALSE(ben.answers[0].granted);
  EXPECT_EQ(ben.answers[0].text, "grip 'left' is on a body that left the world, until the world is set back");

  const World other = testing::world_of(testing::stirred_tank());
  server->after_change(other, {HostAction::kReset}, {});
  go(0.1);
  ben.take(0);
  go(0.1);
  ASSERT_EQ(ben.answers.size(), 2u);
  EXPECT_TRUE(ben.answers[1].granted) << ben.answers[1].text;
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
  EXPECT_NE(ben.answers[2].text.find("no grip '63'"), std::string::npos);
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

TEST_F(ServerTest, TheWorldObeysThoseWhoMayRunIt) {
  ScriptedPeer& ana = join(1, rule, "Ana");
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

  ana.say(wire::ParameterRequest{6, wire::Parameter::kGripStiffness, 1, 0.5});
  ana.say(wire::ParameterRequest{7, wire::Parameter::kGripStiffness, 60, 0.5});
  go(0.1);
  EXPECT_EQ(commands.back().action, HostAction::kGripStiffness);
  EXPECT_EQ(commands.back().index, 1u);
  // What the server refuses by itself is answered before what the world was asked.
  const auto refused = std::find_if(ana.answers.begin(), ana.answers.end(),
                                    [](const wire::Answer& each) { return each.request == 7; });
  ASSERT_NE(refused, ana.answers.end());
  EXPECT_FALSE(refused->granted);
  EXPECT_NE(refused->text.find("60"), std::string::npos) << refused->text;

  refuse_commands = "0.9 Pa·s is too much for the time step";
  ana.say(wire::ParameterRequest{5, wire::Parameter::kFluidViscosity, 0, 0.9});
  go(0.1);
  EXPECT_FALSE(ana.answers.back().granted);
  EXPECT_NE(ana.answers.back().text.find("too much"), std::string::npos);
}

TEST_F(WaitingServerTest, ParametersSetBeforehandDoNotKeepTheWorldFromStarting) {
  ScriptedPeer& ana = join(1, rule, "Ana");
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
  ScriptedPeer& ana = join(1, rule, "Ana");
  ana.say(wire::ParameterRequest{1, wire::Parameter::kFluidViscosity, 0, 0.5});
  ana.say(wire::ParameterRequest{2, wire::Parameter::kGravityScale, 0, 0.5});
  ana.say(wire::WorldRequest{3, wire::WorldAction::kPause});
  go(0.1);
  ASSERT_EQ(ana.answers.size(), 3u);
  EXPECT_EQ(ana.answers[0].text, "here only the host sets viscosity, gravity and stiffness");
  EXPECT_FALSE(ana.answers[1].granted);
  EXPECT_TRUE(ana.answers[2].granted) << "a pause is no parameter";
  server->command("set gravity 0.5");
  ASSERT_EQ(commands.size(), 2u);
  EXPECT_EQ(commands[1].action, HostAction::kGravityScale);
}

TEST_F(WaitingServerTest, TheWorldWaitsForTheFirstHand) {
  ScriptedPeer& ana = join(1, "Ana");
  EXPECT_TRUE(ana.noticed("waits for the first hand to take hold, or until somebody who may types continue"));
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

TEST_F(ServerTest, TheConsoleRulesTheRun) {
  ScriptedPeer& ana = join(1, "Ana");
  ana.take(0);
  go(0.1);
  EXPECT_NE(server->command("who").text.find("Ana, participant, grip 'left'"), std::string::npos);
  EXPECT_NE(server->command("links").text.find(hold_id), std::string::npos);
  EXPECT_NE(server->command("links").text.find("used by Ana"), std::string::npos);
  EXPECT_NE(server->command("status").text.find("1 with hands"), std::string::npos);
  EXPECT_NE(server->command("nonsense").text.find("help"), std::string::npos);
  EXPECT_NE(server->command("link Ben for 10m").text.find("for Ben"), std::string::npos);
  EXPECT_EQ(server->links().links().back().name, "Ben");
  EXPECT_NE(server->links().links().back().expires_ns, 0);
  EXPECT_NE(server->command("release left").text.find("from Ana"), std::string::npos);
  go(0.1);
  EXPECT_TRUE(ana.noticed("the host took grip 'left' from Ana"));
  EXPECT_TRUE(ana.entry("Ana")->grips.empty());
  EXPECT_NE(server->command("release 9").text.find("no grip"), std::string::npos);
  server->command("set viscosity water 0.2");
  server->command("set gravity 0.5");
  server->command("reset");
  ASSERT_EQ(commands.size(), 3u);
  EXPECT_EQ(commands[0].value, 0.2);
  EXPECT_NE(server->command("set viscosity honey 1").text.find("water"), std::string::npos);
  EXPECT_NE(server->command("kick Nobody").text.find("nobody"), std::string::npos);
  server->command("kick Ana");
  go(0.1);
  EXPECT_TRUE(ana.closed);
  EXPECT_EQ(server->command("who").text, "nobody is here");
  server->command("quit");
  EXPECT_TRUE(server->quit_asked());
}

TEST_F(ServerTest, EverybodySeesWhereTheTaskIs) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& old = arrive(2, "Old", wire::kOurCapabilities & ~wire::kTasks);
  go(1.0);
  EXPECT_TRUE(ana.tasks.empty()) << "the scene has none";
  task = {"step 1 of 2", "Pour.", "0 kg", "", {}};
  go(0.5);
  ASSERT_EQ(ana.tasks.size(), 1u);
  EXPECT_EQ(ana.tasks[0].title, "step 1 of 2");
  EXPECT_EQ(ana.tasks[0].say, "Pour.");
  EXPECT_EQ(ana.tasks[0].now, "0 kg");
  go(2.0);
  EXPECT_EQ(ana.tasks.size(), 1u) << "nothing new";
  int step = 0;
  go(2.0, 0.005, [&] { task.now = std::to_string(++step) + " kg"; });
  EXPECT_GE(ana.tasks.size(), 7u);
  EXPECT_LE(ana.tasks.size(), 10u) << "four a second";
  task = {"step 2 of 2", "Stop.", "", "Now.", {{0, 1}}};
  go(0.5);
  // Who comes later, or back, finds it where it is.
  const ScriptedPeer& eve = join(3, watch, "Eve");
  ASSERT_EQ(eve.tasks.size(), 1u);
  EXPECT_EQ(eve.tasks[0].say, "Stop.");
  EXPECT_EQ(eve.tasks[0].hint, "Now.");
  EXPECT_EQ(eve.tasks[0].hands, (std::vector<HandMove>{{0, 1}}));
  EXPECT_TRUE(old.tasks.empty()) << "an earlier peer is not told what it does not know";
}

}  // namespace
}  // namespace slosh
