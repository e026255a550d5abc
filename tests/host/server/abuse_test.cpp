// What bad peers get, and that good ones feel nothing of it.
#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

#include "net/clock.h"
#include "net/site.h"
#include "tests/host/server/scripted_peer.h"

namespace slosh {
namespace {

ServerOptions abused() {
  ServerOptions options;
  options.hands_to_start = 0;
  options.admission.a_site = 40;
  options.admission.strangers = 48;
  return options;
}

class Abuse : public ServedTest {
 protected:
  Abuse() : ServedTest(abused()), good(join(1, hold, "Ana", "203.0.113.1:1")) {
    good.take(0);
    go(0.1);
  }
  void expect_refused(const ScriptedPeer& peer, wire::RefusalCode code, const std::string& words) {
    ASSERT_EQ(peer.refusals.size(), 1u) << peer.reason.text;
    EXPECT_EQ(peer.refusals[0].code, code);
    EXPECT_NE(peer.refusals[0].text.find(words), std::string::npos) << peer.refusals[0].text;
    EXPECT_TRUE(peer.closed);
    EXPECT_EQ(peer.reason.code, static_cast<std::uint64_t>(code) + 1);
  }
  /// The good peer's pose still gets through and it is told nothing bad.
  void expect_unharmed() {
    good.pose(0, ++number, 0.15);
    go(0.02);
    EXPECT_TRUE(good.in());
    EXPECT_TRUE(good.refusals.empty());
    EXPECT_EQ(hands_number(), number);
  }
  std::uint64_t hands_number() {
    publish_bodies(++tick, {pose(0).number});
    go(0.02);
    return good.bodies.empty() ? 0 : good.bodies.back().pose_number;
  }
  ScriptedPeer& good;
  std::uint64_t number = 0;
  std::uint64_t tick = 0;
};

TEST_F(Abuse, WrongTokensAreRefusedInWords) {
  wire::Token wrong = hold;
  wrong[3] ^= 0x10;
  expect_refused(join(9, wrong, "Eve"), wire::RefusalCode::kBadToken, "does not open");
  expect_refused(join(8, wire::Token{}, "Eve"), wire::RefusalCode::kBadToken, "does not open");
  expect_unharmed();
}

TEST_F(Abuse, AnExpiredLinkAdmitsNobodyNew) {
  server->command("expire " + hold_id + " 10s");
  go(11.0, 0.1, [&] { good.datagram(wire::ClockPing{1, 1}); });
  expect_refused(join(9, "Ben"), wire::RefusalCode::kBadToken, "does not open");
  EXPECT_TRUE(good.in()) << "who is in stays in";
  good.close();
  go(1.0);
  EXPECT_TRUE(join(1, "Ana").in()) << "and comes back within the minute";
}

TEST_F(Abuse, AnotherVersionIsToldSo) {
  peers.push_back(std::make_unique<ScriptedPeer>(network, 9));
  peers.back()->say(wire::Hello{9, hold, "Eve", {}, 0, {}});
  go(0.1);
  expect_refused(*peers.back(), wire::RefusalCode::kVersion, "version 9");
}

TEST_F(Abuse, WhoSaysNothingIsClosed) {
  peers.push_back(std::make_unique<ScriptedPeer>(network, 9));
  ScriptedPeer& silent = *peers.back();
  go(2.9, 0.05);
  EXPECT_FALSE(silent.closed);
  go(0.3, 0.05);
  EXPECT_TRUE(silent.closed);
  EXPECT_NE(silent.reason.text.find("nothing was said"), std::string::npos);
}

TEST_F(Abuse, AnythingBeforeHelloOrHelloTwiceIsRefused) {
  peers.push_back(std::make_unique<ScriptedPeer>(network, 9));
  peers.back()->take(1);
  go(0.1);
  expect_refused(*peers.back(), wire::RefusalCode::kBadMessage, "before Hello");
  ScriptedPeer& twice = join(8, "Ben");
  twice.hello(hold, "Ben");
  go(0.1);
  expect_refused(twice, wire::RefusalCode::kBadMessage, "second time");
  expect_unharmed();
}

TEST_F(Abuse, GarbageOnTheControlStreamNamesTheField) {
  ScriptedPeer& bad = join(9, "Eve");
  bad.raw({static_cast<std::uint8_t>(wire::ControlType::kGripRequest), 3, 0, 255, 1});
  go(0.1);
  expect_refused(bad, wire::RefusalCode::kBadMessage, "");
  ScriptedPeer& huge = join(8, "Eve");
  huge.raw({2, 0xff, 0xff, 0xff, 0x7f});
  go(0.1);
  expect_refused(huge, wire::RefusalCode::kBadMessage, "length");
  ScriptedPeer& host_type = join(7, "Eve");
  host_type.say(wire::Welcome{});
  go(0.1);
  expect_refused(host_type, wire::RefusalCode::kBadMessage, "type");
  ScriptedPeer& cut = join(6, "Eve");
  cut.raw({2, 10, 1}, true);
  go(0.1);
  expect_refused(cut, wire::RefusalCode::kBadMessage, "");
  expect_unharmed();
}

TEST_F(Abuse, RandomBytesOnBothWaysHarmNobody) {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    ScriptedPeer& bad = join(9, "Eve");
    for (int i = 0; i < 20; ++i) {
      wire::Bytes bytes(random() % 200);
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
      if (!bytes.empty() && random() % 2) bytes[0] = static_cast<std::uint8_t>(random() % 6);
      bad.raw_datagram(bytes);
      if (i == 19) bad.raw(bytes);
    }
    go(0.01);
    peers.pop_back();
    go(0.01);
  }
  EXPECT_GT(server->figures().datagram_faults, 1000u);
  expect_unharmed();
}

TEST_F(Abuse, ManyDamagedDatagramsEndAConnection) {
  ScriptedPeer& bad = join(9, "Eve");
  for (int i = 0; i < 40; ++i) bad.raw_datagram({1, 0xff, 0xff});
  go(0.1);
  expect_refused(bad, wire::RefusalCode::kBadMessage, "damaged");
  expect_unharmed();
}

TEST_F(Abuse, PosesThatAreNotFiniteOrHugeAreDropped) {
  good.pose(0, ++number, 0.15);
  go(0.02);
  const glm::dvec3 before = pose(0).pose.position;
  for (const double x : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                         -std::numeric_limits<double>::infinity(), 1e30}) {
    wire::PoseSample sample;
    sample.number = ++number;
    sample.engaged = wire::HoldsOn::kYes;
    wire::Bytes bytes = wire::datagram(wire::Poses{{sample}});
    const auto value = static_cast<float>(x);
    // The position follows type, count, grip, number, stamp and time.
    const std::size_t at = 2 + 1 + 1 + 8 + 8;
    std::memcpy(&bytes[at], &value, sizeof value);
    good.raw_datagram(bytes);
  }
  go(0.02);
  EXPECT_EQ(server->figures().datagram_faults, 4u);
  EXPECT_EQ(pose(0).pose.position, before);
  expect_unharmed();
}

TEST_F(Abuse, AnothersGripCannotBeMoved) {
  ScriptedPeer& bad = join(9, "Eve");
  good.pose(0, ++number, 0.15);
  go(0.6, 0.005, [&] { good.pose(0, ++number, 0.15); });
  const glm::dvec3 before = pose(0).pose.position;
  bad.pose(0, 1'000'000, 0.4);
  go(0.05);
  EXPECT_EQ(pose(0).pose.position, before);
  ASSERT_FALSE(bad.notices.empty());
  EXPECT_TRUE(bad.noticed("poses for grip 'left' are not used: it is held by Ana"));
  std::uint64_t n = 1'000'000;
  go(5.0, 0.002, [&] {
    if (!bad.closed) bad.pose(0, ++n, 0.4);
    good.pose(0, ++number, 0.15);
  });
  expect_refused(bad, wire::RefusalCode::kTooMuch, "not yours");
  EXPECT_EQ(pose(0).pose.position, before);
  EXPECT_EQ(std::count_if(bad.notices.begin(), bad.notices.end(),
                          [](const std::string& text) { return text.find("held by") != std::string::npos; }),
            1)
      << "said once";
  expect_unharmed();
}

TEST_F(Abuse, AFloodOfDatagramsIsCutOff) {
  ScriptedPeer& bad = join(9, "Eve");
  std::uint64_t n = 0;
  go(2.0, 0.001, [&] {
    for (int i = 0; i < 40 && !bad.closed; ++i) bad.pose(1, ++n, 0.4);
    good.pose(0, ++number, 0.15);
  });
  expect_refused(bad, wire::RefusalCode::kTooMuch, "");
  expect_unharmed();
}

TEST_F(Abuse, AFloodOfRequestsIsAnsweredThenCutOff) {
  ScriptedPeer& bad = join(9, "Eve");
  const std::size_t before = good.rosters.size();
  go(1.0, 0.01, [&] {
    for (int i = 0; i < 10 && !bad.closed; ++i) {
      bad.take(1);
      bad.release(1);
    }
  });
  expect_refused(bad, wire::RefusalCode::kTooMuch, "asked for more");
  EXPECT_NE(bad.answers.back().text.find("too many requests"), std::string::npos);
  EXPECT_LT(good.rosters.size() - before, 30u) << "rosters are bundled";
  expect_unharmed();
}

TEST_F(Abuse, OneAddressGetsOnlySoManyConnections) {
  std::size_t in = 0;
  for (std::uint8_t i = 10; i < 70; ++i) in += join(i, watch, {}, "198.51.100.1:9").in() ? 1 : 0;
  EXPECT_EQ(in, 40u);
  EXPECT_NE(peers.back()->reason.text.find("your address"), std::string::npos);
  EXPECT_TRUE(join(99, watch, {}, "198.51.100.2:9").in());
  expect_unharmed();
}

TEST_F(Abuse, OneIpv6NetworkCountsAsOneAddress) {
  std::size_t in = 0;
  for (std::uint8_t i = 10; i < 70; ++i) {
    const std::string address = "[2001:db8:0:7::" + std::to_string(i) + "]:9";
    in += join(i, watch, {}, address).in() ? 1 : 0;
  }
  EXPECT_EQ(in, 40u);
  EXPECT_TRUE(join(98, watch, {}, "[2001:db8:0:8::1]:9").in()) << "the /64 beside it";
  EXPECT_TRUE(join(99, watch, {}, "[::ffff:198.51.100.1]:9").in());
  expect_unharmed();
}

class DoorTest : public Abuse {
 protected:
  /// Handshakes that are never followed by a Hello.
  void idle(int count, const std::function<std::string(int)>& address_of) {
    for (int i = 0; i < count; ++i)
      peers.push_back(
          std::make_unique<ScriptedPeer>(network, static_cast<std::uint8_t>(100 + i % 100), address_of(i)));
    go(0.005);
  }
  std::size_t open() const {
    std::size_t open = 0;
    for (const auto& peer : peers) open += peer->connection != 0 && !peer->closed ? 1 : 0;
    return open;
  }
};

TEST_F(DoorTest, FiveHundredWhoSayNothingKeepNobodyOut) {
  for (const bool one_site : {true, false}) {
    idle(500, [&](int i) {
      return one_site ? std::string("198.51.100.1:9") : "10.0." + std::to_string(i) + ".1:9";
    });
    EXPECT_LE(open(), 48u + 3u);
    ScriptedPeer& ben = join(2, "Ben");
    EXPECT_TRUE(ben.in()) << "somebody new";
    idle(500, [&](int i) { return "10.1." + std::to_string(i) + ".1:9"; });
    // A hand loses contact in the middle of it and comes back.
    good.close("gone");
    idle(200, [&](int i) { return "10.2." + std::to_string(i) + ".1:9"; });
    peers.push_back(std::make_unique<ScriptedPeer>(network, 1, "203.0.113.9:1"));
    ScriptedPeer& back = *peers.back();
    go(0.005);
    idle(500, [&](int i) { return "10.3." + std::to_string(i) + ".1:9"; });
    EXPECT_FALSE(back.closed) << "a key that has a seat waits at the door whoever else comes";
    back.hello(hold, "Ana");
    go(0.1);
    ASSERT_TRUE(back.in());
    EXPECT_TRUE(back.welcomes[0].restored);
    EXPECT_EQ(back.entry("Ana")->grips, (std::vector<std::uint32_t>{0}));
    EXPECT_TRUE(ben.in());
    back.close();
    ben.say(wire::Bye{});
    go(3.2, 0.1);
    EXPECT_EQ(open(), 0u) << "nobody stays who says nothing";
  }
}

TEST_F(DoorTest, WhoComesFromElsewhereIsNotTurnedOutByACrowd) {
  idle(47, [](int) { return "198.51.100.1:9"; });
  peers.push_back(std::make_unique<ScriptedPeer>(network, 2, "203.0.113.2:1"));
  ScriptedPeer& ben = *peers.back();
  go(0.005);
  idle(300, [](int) { return "198.51.100.1:9"; });
  EXPECT_FALSE(ben.closed) << "the crowd's own oldest go";
  ben.hello(hold, "Ben");
  go(0.05);
  EXPECT_TRUE(ben.in());
}

TEST(Admission, TheSameKnownKeyWaitsOnce) {
  Admission door({});
  const KeyFingerprint key{7};
  EXPECT_FALSE(door.arrive(1, key, "192.0.2.1:1", true, 0).goes);
  EXPECT_EQ(door.arrive(2, key, "192.0.2.1:2", true, 0).goes, 1u);
  door.admit(2);
  EXPECT_FALSE(door.arrive(3, key, "192.0.2.1:3", true, 0).goes) << "who is in is not turned out here";
  EXPECT_EQ(door.strangers(), 0u);
  EXPECT_TRUE(door.late(to_nanoseconds(2.9)).empty());
  EXPECT_EQ(door.late(to_nanoseconds(3.1)), (std::vector<ConnectionId>{3}));
}

TEST(Admission, SitesAreIpv4AddressesAndIpv6Networks) {
  EXPECT_EQ(site_of("192.0.2.7:4433"), "192.0.2.7");
  EXPECT_EQ(site_of("[2001:db8:1:2:3:4:5:6]:1"), "2001:db8:1:2::/64");
  EXPECT_EQ(site_of("[2001:db8:1:2:ffff::9]:2"), "2001:db8:1:2::/64");
  EXPECT_EQ(site_of("[::ffff:192.0.2.7]:4433"), "192.0.2.7");
  EXPECT_EQ(site_of("[fe80::1%eth0]:4433"), "fe80::/64");
}

TEST_F(Abuse, AnotherStreamIsRefused) {
  ScriptedPeer& bad = join(9, "Eve");
  const std::int64_t stream = bad.end->open_stream(1, false);
  const wire::Bytes bytes(10, 1);
  bad.end->send_stream(1, stream, bytes, true);
  go(0.1);
  expect_refused(bad, wire::RefusalCode::kBadMessage, "only one stream");
}

TEST_F(Abuse, FeedbackOfNonsenseIsHarmless) {
  ScriptedPeer& bad = join(9, watch, "Eve");
  for (std::uint32_t i = 0; i < 200; ++i) {
    wire::SnapshotFeedback feedback;
    feedback.stream = i % 8;
    feedback.epoch = i;
    feedback.pieces = 0xffffffff;
    feedback.missing.push_back({0, 0xffffff});
    bad.datagram(feedback);
  }
  go(0.5);
  EXPECT_TRUE(bad.in());
  EXPECT_LE(desk.take_order().mends.size(), 64u);
  expect_unharmed();
}

}  // namespace
}  // namespace slosh
