// Strangers in crowds: whom they keep out (each other), and whom they do not (everybody else).
#include <gtest/gtest.h>

#include <algorithm>

#include "net/quic/handshake_budget.h"
#include "net/site.h"
#include "tests/net/quic/crafted_end.h"
#include "tests/net/quic/ends.h"

namespace slosh::testing {
namespace {

using quic::HandshakeBudget;

constexpr std::int64_t kSecond = kNanosecondsPerSecond;

std::string site(int number) {
  return "site " + std::to_string(number);
}

TEST(HandshakeBudget, HoldsForOneSite) {
  HandshakeBudget budget(2.0, 1e6);
  int taken = 0;
  for (int i = 0; i < 10; ++i) taken += budget.take("a", kSecond) ? 1 : 0;
  EXPECT_EQ(taken, 4);
  EXPECT_TRUE(budget.take("b", kSecond));
  EXPECT_FALSE(budget.take("a", kSecond + kSecond / 4));
  EXPECT_TRUE(budget.take("a", kSecond + kSecond / 2));
}

TEST(HandshakeBudget, HoldsForAllTogether) {
  HandshakeBudget budget(25.0, 100.0);
  int at_once = 0;
  for (int i = 0; i < 2000; ++i) at_once += budget.take(site(i), kSecond) ? 1 : 0;
  EXPECT_EQ(at_once, 12) << "the thread that passes poses on stands still for so long";
  int taken = 0;
  for (int ms = 0; ms < 10'000; ++ms)
    taken += budget.take(site(2000 + ms), kSecond + ms * kSecond / 1000) ? 1 : 0;
  EXPECT_NEAR(taken, 500, 15);
  EXPECT_LE(budget.sites(), 4096u);
}

TEST(HandshakeBudget, LeavesWhatAFloodTakesNotToOthers) {
  HandshakeBudget budget(25.0, 100.0);
  int flood = 0, asked = 0, granted = 0;
  for (int ms = 0; ms < 20'000; ++ms) {
    const std::int64_t now = kSecond + ms * kSecond / 1000;
    for (int i = 0; i < 4; ++i) flood += ms % 4 == 0 && budget.take(site(i), now) ? 1 : 0;  // 1000 a s in all
    if (ms % 100 != 99) continue;
    ++asked;
    granted += budget.take("honest " + std::to_string(ms), now) ? 1 : 0;
  }
  EXPECT_EQ(granted, asked);
  EXPECT_LT(flood, 20 * 50 + 30) << "half of the budget is theirs";
}

TEST(HandshakeBudget, HoldsNobodyBackWhoWasLetIn) {
  HandshakeBudget budget(25.0, 100.0);
  ASSERT_TRUE(budget.take("home", kSecond));
  budget.admitted("home", kSecond);
  for (int i = 0; i < 2000; ++i) budget.take(site(i), 2 * kSecond);
  ASSERT_FALSE(budget.take("elsewhere", 2 * kSecond));
  EXPECT_TRUE(budget.take("home", 2 * kSecond));
  for (int i = 0; i < 1000; ++i) budget.take("home", 2 * kSecond);
  EXPECT_FALSE(budget.take("home", 2 * kSecond)) << "a site of ours floods as little as any";
}

TEST(HandshakeBudget, GivesBackWhatWasAdmitted) {
  HandshakeBudget budget(2.0, 1e6);
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(budget.take("classroom", kSecond)) << i;
    budget.admitted("classroom", kSecond);
  }
}

TEST(SiteOf, IsTheAddressOrTheNetworkOfAHome) {
  EXPECT_EQ(site_of("192.0.2.7:4433"), "192.0.2.7");
  EXPECT_EQ(site_of("[2001:db8:1:2:3:4:5:6]:4433"), "2001:db8:1:2::/64");
  EXPECT_EQ(site_of("[2001:db8:1:2:ffff::1]:1"), site_of("[2001:db8:1:2::9]:2"));
  EXPECT_NE(site_of("[2001:db8:1:3::1]:1"), site_of("[2001:db8:1:2::1]:1"));
  EXPECT_EQ(site_of("somewhere:5"), "somewhere");
}

/// A host, and whoever comes. Those whose key is in `members` are let in as soon as they are connected.
struct Door : Recorder {
  explicit Door(const EndpointOptions& options) : identity(Identity::generate()) {
    host = std::move(listen_quic("127.0.0.1:0", identity, *this, options).value());
  }
  void on_connected(ConnectionId connection, const KeyFingerprint& key, const std::string& address) override {
    Recorder::on_connected(connection, key, address);
    if (std::find(members.begin(), members.end(), key) != members.end()) host->admit(connection);
  }
  struct Guest {
    Recorder events;
    std::unique_ptr<Endpoint> end;
    bool in() const { return !events.connected.empty() && events.closed.empty(); }
  };
  std::unique_ptr<Guest> visit(const Identity& key) {
    auto guest = std::make_unique<Guest>();
    guest->end =
        std::move(connect_quic({host->local_address()}, identity.fingerprint(), key, guest->events).value());
    return guest;
  }
  Identity identity;
  std::vector<KeyFingerprint> members;
  std::unique_ptr<Endpoint> host;
  std::vector<std::unique_ptr<CraftedEnd>> strangers;
  std::vector<Endpoint*> ends;

  void turn() {
    host->run_once(steady_now_ns() + 200'000);
    for (Endpoint* end : ends) end->run_once(0);
    for (const auto& stranger : strangers) stranger->turn();
  }
  bool until(const std::function<bool()>& done, double seconds = 30.0) {
    const std::int64_t give_up = steady_now_ns() + to_nanoseconds(seconds);
    while (!done()) {
      if (steady_now_ns() > give_up) return false;
      turn();
    }
    return true;
  }
};

TEST(Crowd, AnswersAStrangerWithBusyAndTakesTheNext) {
  EndpointOptions options;
  options.max_strangers = 3;
  options.handshakes_per_second = options.handshakes_in_all = 1e6;
  Door door(options);
  std::vector<std::unique_ptr<Door::Guest>> guests;
  for (int i = 0; i < 5; ++i) {
    guests.push_back(door.visit(Identity::generate()));
    door.ends.push_back(guests.back()->end.get());
    ASSERT_TRUE(door.until([&] { return guests.back()->in(); })) << i;
  }
  ASSERT_TRUE(
      door.until([&] { return !guests[0]->events.closed.empty() && !guests[1]->events.closed.empty(); }));
  EXPECT_EQ(guests[0]->events.reasons[0].cause, CloseCause::kBusy);
  EXPECT_EQ(guests[0]->events.reasons[0].text, "the host is busy: too many are knocking");
  EXPECT_TRUE(guests[0]->events.reasons[0].by_peer);
  EXPECT_EQ(door.host->endpoint_stats().strangers, 3u);
  EXPECT_EQ(door.host->endpoint_stats().strangers_put_out, 2u);
  EXPECT_EQ(door.closed.size(), 2u) << "the host is told of those whom it knew";
}

TEST(Crowd, NeverTakesThePlaceOfWhoIsIn) {
  EndpointOptions options;
  options.max_connections = 5;
  options.max_strangers = 3;
  options.handshakes_per_second = options.handshakes_in_all = 1e6;
  Door door(options);
  std::vector<std::unique_ptr<Door::Guest>> guests;
  const auto enter = [&](const Identity& key) {
    guests.push_back(door.visit(key));
    door.ends.push_back(guests.back()->end.get());
    return door.until([&] { return guests.back()->in() || !guests.back()->events.closed.empty(); }) &&
           guests.back()->in();
  };
  std::vector<Identity> members;
  for (int i = 0; i < 5; ++i) {
    members.push_back(Identity::generate());
    door.members.push_back(members.back().fingerprint());
  }
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(enter(members[static_cast<std::size_t>(i)]));
  for (int i = 0; i < 6; ++i) ASSERT_TRUE(enter(Identity::generate())) << i;
  EXPECT_EQ(door.host->endpoint_stats().strangers, 2u) << "five in all";
  // The rest of those who may come in take the places of strangers.
  for (int i = 3; i < 5; ++i) ASSERT_TRUE(enter(members[static_cast<std::size_t>(i)])) << i;
  for (const std::size_t i : {0u, 1u, 2u, 9u, 10u}) EXPECT_TRUE(guests[i]->in()) << i;
  EXPECT_EQ(door.host->endpoint_stats().strangers, 0u);
  EXPECT_FALSE(enter(Identity::generate())) << "everybody who is in stays";
  EXPECT_EQ(guests.back()->events.reasons[0].cause, CloseCause::kBusy);
}

TEST(Crowd, OfOneSiteDisplacesItself) {
  EndpointOptions options;
  options.max_strangers = 8;
  options.handshakes_per_second = options.handshakes_in_all = 1e6;
  Door door(options);
  const auto lone = door.visit(Identity::generate());  // at 127.0.0.1, alone
  door.ends.push_back(lone->end.get());
  ASSERT_TRUE(door.until([&] { return lone->in(); }));
  for (int i = 0; i < 40; ++i) {
    door.strangers.push_back(
        CraftedEnd::client(door.host->local_address(), "127.0.5." + std::to_string(1 + i % 2) + ":0"));
    ASSERT_TRUE(door.until([&] { return door.strangers.back()->open(); })) << i;
  }
  EXPECT_EQ(door.host->endpoint_stats().strangers, 8u);
  EXPECT_TRUE(lone->in()) << "the longest of all, and of the smallest site";
}

TEST(Crowd, AHundredAndFiftySilentHandshakesASecondKeepNobodyOut) {
  EndpointOptions options;
  options.max_strangers = 128;
  options.max_connections = 160;
  Door door(options);
  const std::int64_t start = steady_now_ns();
  std::vector<std::unique_ptr<Door::Guest>> guests;
  std::size_t begun = 0, came = 0;
  const auto flood = [&] {
    const double elapsed = to_seconds(steady_now_ns() - start);
    while (static_cast<double>(begun) < 150.0 * elapsed && begun < 900) {
      door.strangers.push_back(
          CraftedEnd::client(door.host->local_address(), "127.0.6." + std::to_string(1 + begun % 4) + ":0"));
      ++begun;
    }
    // Each answers the Retry and then says nothing more.
    for (auto& stranger : door.strangers)
      if (stranger->largest_received() > 0) stranger->go_silent();
  };
  while (begun < 900) {
    flood();
    if (static_cast<double>(guests.size()) < to_seconds(steady_now_ns() - start) * 4.0 &&
        guests.size() < 22) {
      guests.push_back(door.visit(Identity::generate()));
      door.ends.push_back(guests.back()->end.get());
    }
    door.turn();
    if (door.strangers.size() > 400) door.strangers.erase(door.strangers.begin());
  }
  door.until([&] {
    return std::all_of(guests.begin(), guests.end(), [](const auto& guest) {
      return !guest->events.connected.empty() || !guest->events.closed.empty();
    });
  });
  for (const auto& guest : guests) came += guest->events.connected.empty() ? 0 : 1;
  EXPECT_EQ(guests.size(), 22u);
  EXPECT_EQ(came, guests.size());
  EXPECT_GT(door.host->endpoint_stats().handshakes_put_off, 0u);
}

}  // namespace
}  // namespace slosh::testing
