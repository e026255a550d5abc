// A peer's link to a host that behaves: joining, holding, losing contact and coming back.
#include "peer/remote/remote_link.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "scripted_host.h"

namespace slosh {
namespace {

using test::kHostStep;
using test::Together;

TEST(RemoteLink, JoinsTakesTheSceneAndTheFirstFreeGrip) {
  RemoteOptions options;
  options.name = "Ana";
  options.token[0] = 7;
  Together both({0.010, 0.0, 0.0, 0.0}, options);
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  ASSERT_EQ(both.host.hellos.size(), 1u);
  EXPECT_EQ(both.host.hellos[0].name, "Ana");
  EXPECT_EQ(both.host.hellos[0].token[0], 7);
  EXPECT_EQ(both.link->world().scene.name, "shared");
  EXPECT_DOUBLE_EQ(both.link->world().spacing, 0.01);
  ASSERT_TRUE(both.run(1.0, [&] { return both.status().held == std::vector<bool>{true, false}; }));
  ASSERT_EQ(both.host.grip_requests.size(), 1u);
  EXPECT_EQ(both.host.grip_requests[0].grip, 0u);
  EXPECT_NE(both.notices().find("you hold grip 'left'"), std::string::npos);
}

TEST(RemoteLink, ASpectatorAsksForNothing) {
  RemoteOptions options;
  options.wants_grip = false;
  Together both({}, options);
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  both.run(0.5);
  EXPECT_TRUE(both.host.grip_requests.empty());
  EXPECT_TRUE(both.host.poses.empty());
}

TEST(RemoteLink, NamedGripsAreAskedForByNameAndNumber) {
  RemoteOptions options;
  options.grips = {"right", "0"};
  Together both({}, options);
  ASSERT_TRUE(both.run(2.0, [&] { return both.status().held == std::vector<bool>{true, true}; }));
}

TEST(RemoteLink, AGripThatTheSceneHasNotEndsInWords) {
  RemoteOptions options;
  options.grips = {"middle"};
  Together both({}, options);
  ASSERT_TRUE(both.run_until(LinkState::kEnded));
  EXPECT_EQ(both.status().error->text(), "--grip: there is no grip 'middle'. There are: left, right");

  Together back({}, options);
  back.host.roster.peers.front().grips = {0};  // a seat that was kept
  ASSERT_TRUE(back.run_until(LinkState::kEnded));
  EXPECT_EQ(back.status().error->text(), "--grip: there is no grip 'middle'. There are: left, right");
}

TEST(RemoteLink, WhoComesBackToAKeptSeatGetsWhatIsAskedForBesides) {
  RemoteOptions options;
  options.grips = {"right"};
  Together both({}, options);
  both.host.roster.peers.front().grips = {0};
  ASSERT_TRUE(both.run(2.0, [&] { return both.status().held == std::vector<bool>{true, true}; }));
}

TEST(RemoteLink, ARefusedGripIsToldAndTheNextFreeOneTaken) {
  Together both;
  both.host.refuse_grip = [](const wire::GripRequest& r) -> std::optional<std::string> {
    if (r.grip == 0) return "grip 'left' is reserved for Ben for 40 s";
    return std::nullopt;
  };
  ASSERT_TRUE(both.run(2.0, [&] { return both.status().held == std::vector<bool>{false, true}; }));

  RemoteOptions options;
  options.grips = {"left"};
  Together named({}, options);
  named.host.refuse_grip = both.host.refuse_grip;
  ASSERT_TRUE(named.run_until(LinkState::kLive));
  named.run(0.5);
  EXPECT_NE(named.notices().find("reserved for Ben"), std::string::npos);
  EXPECT_EQ(named.host.grip_requests.size(), 1u) << "who asked for one wants that one";
}

TEST(RemoteLink, BodiesReachTheChannelOnThePeersClock) {
  Together both({0.050, 0.010, 0.0, 0.0});
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  both.run(3.0);
  double worst = 0.0;
  double last = 0.0;
  both.run(1.0, [&] {
    const BodyMessage& m = both.bodies();
    worst = std::max(worst, std::abs(to_seconds(both.network.now_ns() - m.stamp_ns)));
    EXPECT_GE(m.bodies.time, last);
    EXPECT_NEAR(m.bodies.bodies[0].pose.position.x, m.bodies.time, 1e-5);
    last = m.bodies.time;
    return false;
  });
  EXPECT_LT(worst, 0.008) << "100 ms of round trip and 10 ms of jitter away";
  EXPECT_NEAR(both.status().numbers.body_delay, 0.0595, 0.008);
  EXPECT_NEAR(both.status().world_time, both.host.time, 0.06) << "where the host's world stands now";
}

TEST(RemoteLink, PosesOfHeldGripsGoUpAtTheirRate) {
  Together both;
  ASSERT_TRUE(both.run(2.0, [&] { return both.status().held == std::vector<bool>{true, false}; }));
  const std::size_t before = both.host.poses.size();
  both.run(1.0, [&] {
    both.post(0);
    both.post(1);  // not ours: must not go out
    return false;
  });
  std::set<std::uint64_t> numbers;
  for (std::size_t i = before; i < both.host.poses.size(); ++i) {
    EXPECT_EQ(both.host.poses[i].grip, 0u);
    numbers.insert(both.host.poses[i].number);
  }
  EXPECT_GE(numbers.size(), 400u);
  EXPECT_LE(numbers.size(), 510u);
  EXPECT_EQ(*numbers.rbegin() - *numbers.begin() + 1, numbers.size()) << "none left out";
}

TEST(RemoteLink, ComesBackToACrashedHostAndAsksForItsGripsAgain) {
  Together both;
  ASSERT_TRUE(both.run(2.0, [&] { return both.status().held == std::vector<bool>{true, false}; }));
  both.host.crash();
  ASSERT_TRUE(both.run_until(LinkState::kReconnecting));
  both.run(3.0);
  EXPECT_GE(both.connects, 4);
  EXPECT_LE(both.connects, 7);
  const Scene* const scene = &both.link->world().scene;
  const Channel* const channel = both.link->world().channel.get();
  both.host.roster.peers.front().grips.clear();
  both.host.clock_ahead = -300.0;  // started anew, elsewhere
  both.host.run = 5;
  both.host.come_back();
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  EXPECT_EQ(&both.link->world().scene, scene);
  EXPECT_EQ(both.link->world().channel.get(), channel) << "devices and viewers keep what they hold";
  EXPECT_EQ(both.status().numbers.reconnects, 1u);
  ASSERT_TRUE(both.run(2.0, [&] { return both.status().held == std::vector<bool>{true, false}; }));
  both.run(1.0);
  EXPECT_EQ(both.bodies().run, 5u);
  EXPECT_LT(std::abs(to_seconds(both.network.now_ns() - both.bodies().stamp_ns)), 0.01);
  EXPECT_NE(both.notices().find("back with the host"), std::string::npos);
}

TEST(RemoteLink, AnotherWorldAtTheSameAddressEnds) {
  Together both;
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  both.host.crash();
  ASSERT_TRUE(both.run_until(LinkState::kReconnecting));
  both.host.world = 43;
  both.host.come_back();
  ASSERT_TRUE(both.run_until(LinkState::kEnded));
  EXPECT_NE(both.status().error->what.find("another world"), std::string::npos);
}

TEST(RemoteLink, GivesUpAfterItsPatience) {
  RemoteOptions options;
  options.patience = 20.0;
  Together both({}, options);
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  both.host.crash();
  ASSERT_TRUE(both.run_until(LinkState::kEnded, 40.0));
  EXPECT_NE(both.status().error->what.find("did not come back"), std::string::npos);
}

TEST(RemoteLink, NobodyThereIsSaidWithinFiveSeconds) {
  Together both;
  both.host.crash();
  ASSERT_TRUE(both.run_until(LinkState::kEnded, 6.0));
  EXPECT_FALSE(both.status().error->mend.empty());
}

TEST(RemoteLink, ABusyHostIsAskedAgain) {
  Together both;
  both.busy_answers = 4;
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  EXPECT_EQ(both.connects, 5);
  EXPECT_NE(both.notices().find("the host is busy (too many are knocking); trying again"), std::string::npos)
      << both.notices();
}

TEST(RemoteLink, AHostThatStaysBusyIsNoReasonForANewLink) {
  Together both;
  both.busy_answers = 1000;
  ASSERT_TRUE(both.run_until(LinkState::kEnded, 40.0));
  EXPECT_EQ(both.status().error->text(),
            "192.0.2.9:4433: too many are knocking. Join again in a while, with the same link");
}

TEST(RemoteLink, ARefusalEndsWithTheHostsWordsAndWhatToDo) {
  Together both;
  both.host.on_hello = [&](const wire::Hello&) {
    wire::Refused refused;
    refused.code = wire::RefusalCode::kExpired;
    refused.text = "this link ended at noon";
    both.host.say(refused);
    both.host.endpoint().close(both.host.connection, 3, refused.text);
  };
  ASSERT_TRUE(both.run_until(LinkState::kEnded));
  EXPECT_EQ(both.status().error->text(),
            "192.0.2.9:4433: the host says: this link ended at noon. Ask the host for a new link");
}

TEST(RemoteLink, ABusyRefusalIsTriedAgain) {
  Together both;
  int hellos = 0;
  both.host.on_hello = [&](const wire::Hello&) {
    if (++hellos > 2) {
      both.host.welcome();
      both.host.send_scene();
      return;
    }
    if (hellos == 1) both.host.send_scene();  // and the welcome is lost with the connection
    both.host.endpoint().close(both.host.connection, 1 + static_cast<int>(wire::RefusalCode::kBusy), "crowd");
  };
  ASSERT_TRUE(both.run_until(LinkState::kLive)) << "the third time";
  EXPECT_EQ(both.connects, 3);
  EXPECT_NE(both.notices().find("the host is busy (crowd); trying again"), std::string::npos);

  Together always;
  always.host.on_hello = [&](const wire::Hello&) {
    always.host.endpoint().close(always.host.connection, 1 + static_cast<int>(wire::RefusalCode::kBusy),
                                 "crowd");
  };
  ASSERT_TRUE(always.run_until(LinkState::kEnded, 40.0));
  EXPECT_EQ(always.status().error->mend, "Join again in a while, with the same link");
}

TEST(RemoteLink, RosterChangesAreApplied) {
  Together both;
  ASSERT_TRUE(both.run(2.0, [&] { return both.status().held == std::vector<bool>{true, false}; }));
  EXPECT_EQ(both.host.hellos[0].capabilities, wire::kOurCapabilities);
  wire::RosterChange change;
  change.changed.push_back({7, "Ben", wire::Role::kParticipant, true, {1}});
  change.changed.push_back({3, "Ana", wire::Role::kParticipant, true, {}});
  both.host.say(change);
  ASSERT_TRUE(both.run(1.0, [&] { return both.status().held == std::vector<bool>{false, false}; }));
  ASSERT_EQ(both.status().peers.size(), 2u);
  EXPECT_EQ(both.status().peers[1].name, "Ben");
  change = {};
  change.gone = {7, 9};
  both.host.say(change);
  ASSERT_TRUE(both.run(1.0, [&] { return both.status().peers.size() == 1; }));
  EXPECT_EQ(both.status().peers[0].name, "Ana");
}

TEST(LinkSteps, EveryStepEndsAndOnlyWhatMayComeLeadsOn) {
  int ways = 0;
  for (std::size_t s = 0; s < kLinkStepCount; ++s) {
    const auto step = static_cast<LinkStep>(s);
    const bool ended = step == LinkStep::kEnded;
    EXPECT_EQ(next_step(step, LinkEvent::kEnd).has_value(), !ended);
    if (!ended) {
      EXPECT_EQ(next_step(step, LinkEvent::kEnd), LinkStep::kEnded);
    }
    for (std::size_t e = 0; e < kLinkEventCount; ++e) {
      const std::optional<LinkStep> next = next_step(step, static_cast<LinkEvent>(e));
      if (!next) continue;
      ways += 1;
      EXPECT_FALSE(ended) << "nothing comes after the end";
      // Who was live once is never told again that nobody answered.
      if (!before_live(step)) {
        EXPECT_FALSE(before_live(*next));
      }
      // Only a handshake makes contact.
      if (in_contact(*next) && !in_contact(step)) {
        EXPECT_EQ(static_cast<LinkEvent>(e), LinkEvent::kAnswered);
      }
    }
  }
  EXPECT_EQ(ways, 22);
  EXPECT_EQ(next_step(LinkStep::kLive, LinkEvent::kLost), LinkStep::kWaiting);
  EXPECT_FALSE(next_step(LinkStep::kLive, LinkEvent::kReady));
  EXPECT_FALSE(next_step(LinkStep::kIdle, LinkEvent::kAnswered));
}

TEST(RemoteLink, ARefusalThatOnlyTheClosingTellsIsOneToo) {
  Together both;
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  both.host.endpoint().close(both.host.connection, 1 + static_cast<int>(wire::RefusalCode::kTooMuch),
                             "flood");
  ASSERT_TRUE(both.run_until(LinkState::kEnded));
  EXPECT_NE(both.status().error->what.find("flood"), std::string::npos);
}

TEST(RemoteLink, AHostThatEndsIsNoError) {
  Together both;
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  wire::Refused refused;
  refused.code = wire::RefusalCode::kEnding;
  refused.text = "the run is over";
  both.host.say(refused);
  ASSERT_TRUE(both.run_until(LinkState::kEnded));
  EXPECT_FALSE(both.status().error);
  EXPECT_EQ(both.status().farewell, "the run is over");
}

TEST(RemoteLink, LeavingSaysGoodBye) {
  Together both;
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  both.link->leave("left");
  EXPECT_EQ(both.status().state, LinkState::kEnded);
  both.run(0.1);
  EXPECT_TRUE(both.host.said_bye);
}

TEST(RemoteLink, CommandsReachTheHost) {
  Together both;
  ASSERT_TRUE(both.run(2.0, [&] { return both.status().held == std::vector<bool>{true, false}; }));
  RemoteCommand pause;
  pause.kind = RemoteCommand::Kind::kWorld;
  pause.action = wire::WorldAction::kPause;
  both.ask(pause);
  RemoteCommand next;
  next.kind = RemoteCommand::Kind::kNextGrip;
  both.ask(next);
  ASSERT_TRUE(both.run(1.0, [&] { return both.status().held == std::vector<bool>{false, false}; }));
  ASSERT_EQ(both.host.world_requests.size(), 1u);
  EXPECT_EQ(both.host.world_requests[0].action, wire::WorldAction::kPause);
  both.ask(next);
  ASSERT_TRUE(both.run(1.0, [&] { return both.status().held == std::vector<bool>{true, false}; }));
}

TEST(RemoteLink, ParametersAreAskedForAndTheAnswerIsTold) {
  Together both;
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  RemoteCommand set;
  set.kind = RemoteCommand::Kind::kParameter;
  set.parameter = wire::Parameter::kGravityScale;
  set.value = 0.5;
  both.ask(set);
  ASSERT_TRUE(both.run(1.0, [&] { return both.notices().find("gravity is 0.5") != std::string::npos; }));
  ASSERT_EQ(both.host.parameter_requests.size(), 1u);
  EXPECT_EQ(both.host.parameter_requests[0].parameter, wire::Parameter::kGravityScale);
  EXPECT_EQ(both.host.parameter_requests[0].value, 0.5);
  both.host.refuse_parameters = "here only the host sets viscosity and gravity";
  set.parameter = wire::Parameter::kFluidViscosity;
  set.index = 3;
  both.ask(set);
  ASSERT_TRUE(both.run(1.0, [&] { return both.notices().find("only the host sets") != std::string::npos; }));
  EXPECT_EQ(both.host.parameter_requests[1].index, 3u);
  EXPECT_EQ(both.notices().find("the viscosity of"), std::string::npos) << "it was not changed";
}

TEST(RemoteLink, WhoDrawsNothingAsksForNoSnapshots) {
  for (const auto& [wanted, film, wish] : {std::tuple{true, false, wire::SnapshotWish::kNewest},
                                           {true, true, wire::SnapshotWish::kFilm},
                                           {false, false, wire::SnapshotWish::kNone}}) {
    RemoteOptions options;
    options.snapshots.wanted = wanted;
    options.snapshots.film = film;
    Together both({}, options);
    ASSERT_TRUE(both.run_until(LinkState::kLive));
    EXPECT_EQ(both.host.hellos[0].snapshots, wish);
  }
}

TEST(RemoteLink, WhoCannotUseModelsOfTheFluidAsksForNone) {
  for (const bool wanted : {true, false}) {
    RemoteOptions options;
    options.fluid_models = wanted;
    Together both({}, options);
    ASSERT_TRUE(both.run_until(LinkState::kLive));
    const wire::Capabilities asked = both.host.hellos[0].capabilities;
    EXPECT_EQ((asked & wire::kFluidWrenches) != 0, wanted);
    EXPECT_EQ(asked | wire::kFluidWrenches, wire::kOurCapabilities) << "and for all else";
  }
}

TEST(RemoteLink, AStalledHostLetsTheForceGoAndIsToldOf) {
  Together both;
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  both.run(1.0);
  both.host.sends_bodies = false;
  both.run(0.5);
  EXPECT_GT(to_seconds(both.network.now_ns() - both.bodies().stamp_ns), 0.4)
      << "the stamp grows old, which is what a device loop fades by";
  EXPECT_EQ(both.status().state, LinkState::kLive) << "pings still come back";
}

TEST(RemoteLink, APulledCableIsReconnectedWhenItIsPluggedIn) {
  Together both;
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  both.network.set_dark(*both.peer_end, true);
  ASSERT_TRUE(both.run_until(LinkState::kReconnecting, 12.0));
  ASSERT_TRUE(both.run_until(LinkState::kLive, 12.0));
}

}  // namespace
}  // namespace slosh
