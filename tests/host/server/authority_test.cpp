// Who may change the world: by role in the link, and a grip's stiffness by the hand that holds it.
#include <gtest/gtest.h>

#include "net/clock.h"
#include "tests/host/server/server_kit.h"

namespace slosh {
namespace {

using wire::Parameter;
using wire::ParameterRequest;
using wire::WorldAction;
using wire::WorldRequest;

class AuthorityTest : public ServedTest {
 protected:
  explicit AuthorityTest(const ServerOptions& options = running()) : ServedTest(options) {}

  template <class M>
  const wire::Answer& ask(ScriptedPeer& peer, const M& message) {
    const std::size_t before = peer.answers.size();
    peer.say(message);
    go(0.1);
    EXPECT_EQ(peer.answers.size(), before + 1);
    static const wire::Answer kNone;
    return peer.answers.empty() ? kNone : peer.answers.back();
  }
  void grab(ScriptedPeer& peer, std::uint32_t grip) {
    peer.take(grip);
    go(0.1);
    ASSERT_TRUE(peer.answers.back().granted) << peer.answers.back().text;
  }
};

TEST_F(AuthorityTest, WhoMayHoldMovesNobodyElse) {
  ScriptedPeer& ana = join(1, "Ana");
  grab(ana, 0);
  for (const WorldAction action : {WorldAction::kPause, WorldAction::kContinue, WorldAction::kReset}) {
    const wire::Answer& answer = ask(ana, WorldRequest{9, action});
    EXPECT_FALSE(answer.granted);
    EXPECT_NE(answer.text.find("role " + hold_id + " run"), std::string::npos)
        << "how to get the right: " << answer.text;
    EXPECT_NE(answer.text.find("link 'Ana' run"), std::string::npos) << answer.text;
  }
  EXPECT_FALSE(ask(ana, ParameterRequest{9, Parameter::kGravityScale, 0, 0.5}).granted);
  EXPECT_FALSE(ask(ana, ParameterRequest{9, Parameter::kFluidViscosity, 0, 0.5}).granted);
  EXPECT_TRUE(commands.empty());
  EXPECT_NE(server->command("log").text.find("Ana may not set the world back to its start"),
            std::string::npos);
}

TEST_F(AuthorityTest, AGripsStiffnessIsItsHoldersAndTheHosts) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, rule, "Ben");
  grab(ana, 0);
  EXPECT_TRUE(ask(ana, ParameterRequest{9, Parameter::kGripStiffness, 0, 2.0}).granted);
  const wire::Answer& free = ask(ana, ParameterRequest{9, Parameter::kGripStiffness, 1, 2.0});
  EXPECT_FALSE(free.granted);
  EXPECT_NE(free.text.find("take hold of grip 'right' first"), std::string::npos) << free.text;
  const wire::Answer& hers = ask(ben, ParameterRequest{9, Parameter::kGripStiffness, 0, 4.0});
  EXPECT_FALSE(hers.granted) << "not even who runs the world";
  EXPECT_NE(hers.text.find("grip 'left' is held by Ana"), std::string::npos) << hers.text;
  EXPECT_TRUE(ask(ben, ParameterRequest{9, Parameter::kGripStiffness, 1, 2.0}).granted) << "nobody holds it";
  ASSERT_EQ(commands.size(), 2u);
  EXPECT_EQ(commands[0].value, 2.0);
  server->command("set stiffness left 0.5");
  ASSERT_EQ(commands.size(), 3u);
  EXPECT_EQ(commands[2].index, 0u);
  go(0.1);
  EXPECT_TRUE(ana.noticed("the host set the hold on 'left' to 0.5 times the scene's stiffness"))
      << "told to everybody";
  // What is let go of is hers no longer.
  ana.release(0);
  go(0.1);
  EXPECT_FALSE(ask(ana, ParameterRequest{9, Parameter::kGripStiffness, 0, 2.0}).granted);
}

TEST_F(AuthorityTest, WhoRunsTheWorldDoesSoWithinABudget) {
  ScriptedPeer& ana = join(1, rule, "Ana");
  ScriptedPeer& eve = join(2, watch, "Eve");
  int granted = 0;
  std::string why;
  for (int i = 0; i < 50; ++i) {
    const wire::Answer& answer = ask(ana, WorldRequest{9, WorldAction::kReset});
    granted += answer.granted ? 1 : 0;
    if (!answer.granted) why = answer.text;
  }
  EXPECT_EQ(granted, 2);
  EXPECT_EQ(commands.size(), 2u);
  EXPECT_NE(why.find("again in"), std::string::npos) << why;
  EXPECT_TRUE(eve.noticed("Ana set the world back to its start"));
  // Whoever comes again by the same key has the same budget.
  ana.close();
  go(0.1);
  ScriptedPeer& again = join(1, rule, "Ana");
  EXPECT_FALSE(ask(again, WorldRequest{9, WorldAction::kReset}).granted);
  go(11.0, 0.1);
  EXPECT_TRUE(ask(again, WorldRequest{9, WorldAction::kReset}).granted);
  // The host has none.
  const std::size_t before = commands.size();
  for (int i = 0; i < 20; ++i) server->command("reset");
  EXPECT_EQ(commands.size(), before + 20);
}

TEST_F(AuthorityTest, TheHostGivesTheRoleAndTakesItBack) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& old = arrive(2, "Old", wire::kOurCapabilities & ~wire::kLinkRights);
  go(0.1);
  ASSERT_TRUE(old.in());
  EXPECT_EQ(ana.welcomes[0].role, wire::Role::kParticipant);
  ASSERT_EQ(ana.rights.size(), 1u);
  EXPECT_EQ(ana.rights[0], (wire::Rights{false, false, true}));

  EXPECT_FALSE(server->command("role nobo run").granted);
  EXPECT_TRUE(server->command("role " + hold_id + " run").granted);
  go(0.1);
  ASSERT_EQ(ana.rights.size(), 2u);
  EXPECT_EQ(ana.rights[1], (wire::Rights{true, true, true}));
  EXPECT_TRUE(ana.noticed("Ana may run the world now"));
  EXPECT_TRUE(old.rights.empty()) << "an earlier peer is not told what it does not know";
  EXPECT_TRUE(ask(ana, WorldRequest{9, WorldAction::kPause}).granted);
  EXPECT_TRUE(ask(old, WorldRequest{9, WorldAction::kContinue}).granted) << "but may";

  EXPECT_TRUE(server->command("role " + hold_id + " hold").granted);
  EXPECT_FALSE(ask(ana, WorldRequest{9, WorldAction::kPause}).granted);
  const ScriptedPeer& eve = join(3, watch, "Eve");
  EXPECT_EQ(eve.rights.at(0), wire::Rights{});
  EXPECT_FALSE(server->command("role " + server->links().links()[1].id + " run").granted)
      << "a link to watch is given to many";
}

TEST_F(AuthorityTest, TheLogSaysWhoDidWhat) {
  ScriptedPeer& ana = join(1, rule, "Ana");
  grab(ana, 0);
  ask(ana, ParameterRequest{9, Parameter::kGravityScale, 0, 0.5});
  server->command("pause");
  go(0.1);
  const std::string log = server->command("log").text;
  for (const char* deed : {"Ana is here", "Ana took grip 'left'", "Ana set gravity to 0.5 times the scene's",
                           "the host paused the world"})
    EXPECT_NE(log.find(deed), std::string::npos) << deed << " in\n" << log;
}

/// What a host of before `run` was there has kept: its numbers for roles are 0 and 1.
TEST_F(AuthorityTest, OldLinksToHoldComeBackWithTheLesserRight) {
  ServerState state;
  state.world = 7;
  wire::Token token{};
  token.fill(5);
  state.links.push_back(
      {"bako", token, static_cast<LinkRole>(wire::Role::kParticipant), {}, 1, 0, false, {}});
  const wire::Bytes bytes = wire::encoded(state);
  ServerState back;
  ASSERT_FALSE(wire::decode(bytes, back));
  server->restore(back);
  ScriptedPeer& ana = join(1, token, "Ana");
  ASSERT_TRUE(ana.in());
  grab(ana, 0);
  EXPECT_FALSE(ask(ana, WorldRequest{9, WorldAction::kReset}).granted);
}

class LockedAuthorityTest : public AuthorityTest {
 protected:
  static ServerOptions locked() {
    ServerOptions options = running();
    options.lock_parameters = true;
    return options;
  }
  LockedAuthorityTest() : AuthorityTest(locked()) {}
};

TEST_F(LockedAuthorityTest, ALockHoldsForEverybody) {
  ScriptedPeer& ana = join(1, rule, "Ana");
  grab(ana, 0);
  EXPECT_EQ(ana.rights.at(0), (wire::Rights{true, false, false}));
  EXPECT_FALSE(ask(ana, ParameterRequest{9, Parameter::kGripStiffness, 0, 2.0}).granted);
  EXPECT_FALSE(ask(ana, ParameterRequest{9, Parameter::kGravityScale, 0, 2.0}).granted);
  EXPECT_TRUE(ask(ana, WorldRequest{9, WorldAction::kPause}).granted);
}

}  // namespace
}  // namespace slosh
