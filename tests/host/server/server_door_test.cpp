// Who may come in, under which name, by which link and for how long.
#include <algorithm>
#include <set>

#include "net/clock.h"
#include "tests/host/server/server_kit.h"

namespace slosh {
namespace {

TEST_F(ServerTest, WhoIsKickedForATimeStaysOutByTheirKeyAlsoOverARestart) {
  ScriptedPeer& ana = join(1, "Ana");
  join(2, "Ben");
  EXPECT_FALSE(server->command("kick Nobody for 10m").granted);
  EXPECT_TRUE(server->command("kick Ana for 10m").granted);
  go(0.2);
  ASSERT_EQ(ana.refusals.size(), 1u);
  EXPECT_EQ(ana.refusals[0].code, wire::RefusalCode::kBanned);
  ASSERT_EQ(join(1, "Ana").refusals.size(), 1u);
  EXPECT_EQ(peers.back()->refusals[0].code, wire::RefusalCode::kBanned);
  EXPECT_NE(peers.back()->refusals[0].text.find("for another 9 min"), std::string::npos)
      << peers.back()->refusals[0].text;
  EXPECT_NE(server->command("who").text.find("Ana, kept out for another 9 min"), std::string::npos);
  EXPECT_NE(server->command("links").text.find("Ana, kept out for another 9 min"), std::string::npos);
  EXPECT_TRUE(join(3, "Cem").in()) << "the link still works for others";

  ServerState state;
  ASSERT_FALSE(wire::decode(server->state_blob(), state));
  ASSERT_EQ(state.bans.size(), 1u);
  EXPECT_EQ(state.bans[0].name, "Ana");
  BanList again;
  again.restore(state.bans);
  KeyFingerprint key{};
  key.fill(1);
  EXPECT_GT(again.until(key, server->unix_now()), 0);

  go(600.0, 1.0);
  EXPECT_TRUE(join(1, "Ana").in()) << "the time is over";
  server->command("kick Ana for 10m");
  go(0.1);
  EXPECT_FALSE(server->command("unban Nobody").granted);
  EXPECT_TRUE(server->command("unban Ana").granted);
  EXPECT_TRUE(join(1, "Ana").in());
  EXPECT_TRUE(server->command("kick Ana").granted);
  go(0.1);
  EXPECT_TRUE(join(1, "Ana").in()) << "without a time they may come again";
}

class CappedServerTest : public ServedTest {
 protected:
  static ServerOptions two() {
    ServerOptions options = running();
    options.limits = {2, 2};
    return options;
  }
  CappedServerTest() : ServedTest(two()) {}
};

TEST_F(CappedServerTest, TheLimitHoldsForKnownKeysAndAnotherRoleToo) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  ScriptedPeer& eve = join(3, watch, "Eve");
  EXPECT_FALSE(join(4, "Cem").in());
  ASSERT_EQ(join(3, hold, "Eve").refusals.size(), 1u) << "who watches may not become a third with hands";
  EXPECT_EQ(peers.back()->refusals[0].code, wire::RefusalCode::kFull);
  EXPECT_TRUE(eve.in()) << "and stays where they are";
  EXPECT_FALSE(eve.closed);

  ana.close();  // contact is lost: the place waits for her
  go(0.1);
  EXPECT_FALSE(join(4, "Cem").in());
  EXPECT_TRUE(join(1, "Ana").in());
  ben.say(wire::Bye{});
  go(0.1);
  EXPECT_TRUE(join(4, "Cem").in()) << "who leaves frees the place";
  EXPECT_FALSE(join(2, "Ben").in()) << "and has it no more";
  EXPECT_EQ(server->figures().participants, 2u);
}

class ClockServerTest : public ServedTest {
 protected:
  explicit ClockServerTest(std::shared_ptr<std::int64_t> system =
                               std::make_shared<std::int64_t>(1'800'000'000 * kNanosecondsPerSecond),
                           std::shared_ptr<std::int64_t> elapsed = std::make_shared<std::int64_t>(5))
      : ServedTest(with(system, elapsed)), system_ns(*system), elapsed_ns(*elapsed), held_(system, elapsed) {}
  static ServerOptions with(const std::shared_ptr<std::int64_t>& system,
                            const std::shared_ptr<std::int64_t>& elapsed) {
    ServerOptions options = running();
    options.unix_clock = [system] { return *system; };
    options.elapsed_clock = [elapsed] { return *elapsed; };
    return options;
  }
  std::int64_t& system_ns;
  std::int64_t& elapsed_ns;

 private:
  std::pair<std::shared_ptr<std::int64_t>, std::shared_ptr<std::int64_t>> held_;
};

TEST_F(ClockServerTest, AnExpiredLinkStaysExpiredWhateverTheClocksDo) {
  constexpr std::int64_t kMinute = 60 * kNanosecondsPerSecond;
  ASSERT_TRUE(join(1, "Ana").in());
  server->command("expire " + hold_id + " 10m");
  EXPECT_TRUE(join(2, "Ben").in());
  // The machine sleeps for an hour: the steady clock stands meanwhile.
  system_ns += 60 * kMinute;
  elapsed_ns += 60 * kMinute;
  EXPECT_FALSE(join(3, "Cem").in());
  // Somebody sets the clock back to before.
  system_ns -= 90 * kMinute;
  EXPECT_FALSE(join(4, "Dan").in());
  // And the host is started anew with that clock.
  server->command("link");
  go(0.1);
  ServerState state;
  ASSERT_FALSE(wire::decode(server->state_blob(), state));
  EXPECT_GE(state.seen_ns, system_ns + 90 * kMinute);
  LastingClock again([&] { return system_ns; }, [&] { return elapsed_ns; });
  again.not_before(state.seen_ns);
  EXPECT_GE(again.now(), state.seen_ns);
  // Set back while a link has time left, it does not get more of it.
  const LinkRecord* link = server->links().create(LinkRole::kHold, {}, server->unix_now(), 10 * kMinute);
  const wire::Token token = link->token;
  system_ns -= 600 * kMinute;
  elapsed_ns += 11 * kMinute;
  EXPECT_FALSE(join(5, token, "Eli").in());
}

TEST_F(ServerTest, NobodyBearsANameThatLooksLikeAnothersOrLikeANotice) {
  const auto name_of = [&](std::uint8_t key, const std::string& wish) {
    return join(key, wish).welcomes.at(0).name;
  };
  EXPECT_EQ(name_of(1, "Ana"), "Ana");
  EXPECT_EQ(name_of(2, "Ana"), "Ana 2");
  EXPECT_EQ(name_of(3, "\u0410na"), "\u0410na 3") << "a Cyrillic A";
  EXPECT_EQ(name_of(4, "A\u200bna"), "Ana 4") << "a space of no width";
  EXPECT_EQ(name_of(5, " "), "guest 1");
  EXPECT_EQ(name_of(6, "Ben has left"), "Ben");
  EXPECT_EQ(name_of(7, "ana"), "ana 5");
}

TEST_F(ServerTest, ANameThatALinkWasMadeForIsNobodyElses) {
  EXPECT_TRUE(server->command("link Zoe").granted);
  const wire::Token token = server->links().links().back().token;
  EXPECT_EQ(join(1, "Zoe").welcomes.at(0).name, "Zoe 2") << "by the link for anybody";
  EXPECT_EQ(join(2, "zo\u0435").welcomes.at(0).name, "zo\u0435 3");
  EXPECT_EQ(join(3, token, "whoever").welcomes.at(0).name, "Zoe");
  EXPECT_FALSE(server->command("link '\u00a0'").granted);
}

TEST_F(ServerTest, NamesThatCanBeShownCanBeTyped) {
  ScriptedPeer& bad = join(1, "Z\u00eb\u00e9");
  EXPECT_TRUE(server->command("kick Zee for 10m").granted);
  go(0.1);
  EXPECT_TRUE(bad.closed);
  EXPECT_TRUE(server->command("unban zee").granted);
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
  EXPECT_NE(server->command("expire " + hold_id + " 10s").text.find("nobody new"), std::string::npos);
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
  EXPECT_NE(server->command("link").text.find("for anybody"), std::string::npos) << "that made room";
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
