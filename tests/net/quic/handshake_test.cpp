// Who may talk to whom, and what those hear who may not.
#include <gtest/gtest.h>

#include "tests/net/quic/ends.h"
#include "tests/support/network_here.h"

namespace slosh::testing {
namespace {

TEST(Identity, IsTheSameFromItsPrivateKey) {
  const Identity made = Identity::generate();
  const auto again = Identity::from_private_key(made.private_key());
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(again.value().fingerprint(), made.fingerprint());
  EXPECT_NE(Identity::generate().fingerprint(), made.fingerprint());
}

TEST(Identity, RefusesWhatIsNoKey) {
  EXPECT_FALSE(Identity::from_private_key({}));
  Bytes key = Identity::generate().private_key();
  EXPECT_FALSE(Identity::from_private_key(std::span(key).first(key.size() / 2)));
  key[10] ^= 0xff;
  EXPECT_FALSE(Identity::from_private_key(key));
}

TEST(Handshake, TellsEachTheOthersKey) {
  Pair pair;
  ASSERT_TRUE(pair.host) << pair.problem;
  ASSERT_TRUE(pair.establish());
  EXPECT_EQ(pair.peer_events.keys.at(0), pair.host_identity.fingerprint());
  EXPECT_EQ(pair.host_events.keys.at(0), pair.peer_identity.fingerprint());
  EXPECT_EQ(pair.host_events.addresses.at(0), pair.peer->local_address());
  EXPECT_EQ(pair.host->endpoint_stats().connections, 1u);
  EXPECT_EQ(pair.host->endpoint_stats().retries_sent, 1u);
}

TEST(Handshake, RefusesAHostOfAnotherKey) {
  Pair pair;
  auto peer = connect_quic({pair.host->local_address()}, Identity::generate().fingerprint(),
                           pair.peer_identity, pair.peer_events);
  ASSERT_TRUE(peer);
  pair.peer = std::move(peer.value());
  ASSERT_TRUE(pair.run([&] { return !pair.peer_events.closed.empty(); }));
  EXPECT_EQ(pair.peer_events.reasons.at(0).text, "the host's key is not the one in the link");
  EXPECT_FALSE(pair.peer_events.reasons.at(0).by_peer);
  EXPECT_TRUE(pair.peer_events.connected.empty());
  ASSERT_TRUE(pair.run([&] { return pair.host->endpoint_stats().connections == 0; }));
  EXPECT_TRUE(pair.host_events.connected.empty());
}

TEST(Handshake, AsksEveryPeerForACertificate) {
  Pair pair;
  auto peer = connect_quic_oddly({pair.host->local_address()}, pair.host_identity.fingerprint(),
                                 pair.peer_identity, {.no_certificate = true, .alpn = ""}, pair.peer_events);
  ASSERT_TRUE(peer);
  pair.peer = std::move(peer.value());
  ASSERT_TRUE(pair.run([&] { return !pair.peer_events.closed.empty(); }));
  EXPECT_TRUE(pair.peer_events.connected.empty()) << "the host took a peer without a key";
  EXPECT_NE(pair.peer_events.reasons.at(0).text.find("certificate"), std::string::npos)
      << pair.peer_events.reasons.at(0).text;
  EXPECT_TRUE(pair.host_events.connected.empty());
}

TEST(Handshake, RefusesAnotherProtocol) {
  Pair pair;
  auto peer =
      connect_quic_oddly({pair.host->local_address()}, pair.host_identity.fingerprint(), pair.peer_identity,
                         {.no_certificate = false, .alpn = "slosh/999"}, pair.peer_events);
  ASSERT_TRUE(peer);
  pair.peer = std::move(peer.value());
  ASSERT_TRUE(pair.run([&] { return !pair.peer_events.closed.empty(); }));
  EXPECT_NE(pair.peer_events.reasons.at(0).text.find("another version of slosh"), std::string::npos)
      << pair.peer_events.reasons.at(0).text;
  EXPECT_TRUE(pair.host_events.connected.empty());
}

TEST(Handshake, SaysWhenNobodyAnswers) {
  EndpointOptions options;
  options.handshake_timeout = 0.5;
  Recorder events;
  const Identity identity = Identity::generate();
  std::string address;
  {
    auto gone = listen_quic("127.0.0.1:0", identity, events);
    ASSERT_TRUE(gone);
    address = gone.value()->local_address();
  }
  auto peer = connect_quic({address}, identity.fingerprint(), identity, events, options);
  ASSERT_TRUE(peer);
  ASSERT_TRUE(run_until({peer.value().get()}, [&] { return !events.closed.empty(); }));
  EXPECT_EQ(events.reasons.at(0).text, "no answer from " + address + " within 0.5 s: nothing listens there");
}

TEST(Handshake, TakesTheFirstAddressThatAnswers) {
  Pair pair;
  Recorder silent_events;
  // Another host, of another key, and a port where nobody listens.
  auto other = listen_quic("127.0.0.1:0", Identity::generate(), silent_events);
  ASSERT_TRUE(other);
  pair.connect({"127.0.0.1:9", other.value()->local_address(), pair.host->local_address()});
  ASSERT_TRUE(pair.peer) << pair.problem;
  ASSERT_TRUE(
      run_until({pair.host.get(), pair.peer.get(), other.value().get()}, [&] { return pair.connected(); }));
  EXPECT_EQ(pair.peer_events.addresses.at(0), pair.host->local_address());
  ASSERT_TRUE(run_until({pair.host.get(), pair.peer.get(), other.value().get()},
                        [&] { return pair.peer->endpoint_stats().connections == 1; }));
  EXPECT_TRUE(pair.peer_events.closed.empty());
}

TEST(Handshake, WorksOverIpv6AndBothAtOnce) {
  if (const std::string why = test::no_ipv6(); !why.empty()) GTEST_SKIP() << why;
  Pair pair({}, "[::]:0");
  ASSERT_TRUE(pair.host) << pair.problem;
  const std::string port = pair.host->local_address().substr(pair.host->local_address().rfind(':'));
  pair.connect({"[::1]" + port});
  ASSERT_TRUE(pair.peer) << pair.problem;
  ASSERT_TRUE(pair.run([&] { return pair.connected(); }));
  EXPECT_EQ(pair.peer_events.addresses.at(0), "[::1]" + port);

  Recorder v4_events;
  auto v4 =
      connect_quic({"127.0.0.1" + port}, pair.host_identity.fingerprint(), Identity::generate(), v4_events);
  ASSERT_TRUE(v4);
  ASSERT_TRUE(run_until({pair.host.get(), v4.value().get()}, [&] {
    return !v4_events.connected.empty() && pair.host_events.connected.size() == 2;
  }));
  EXPECT_EQ(pair.host_events.addresses.at(1), v4.value()->local_address());
}

TEST(Handshake, SaysWhatIsWrongWithAnAddress) {
  Recorder events;
  const Identity identity = Identity::generate();
  for (const char* bad : {"", "127.0.0.1", "127.0.0.1:70000", "::1:4433", "127.0.0.1:x", ":5"}) {
    EXPECT_FALSE(listen_quic(bad, identity, events)) << bad;
    EXPECT_FALSE(connect_quic({bad}, identity.fingerprint(), identity, events)) << bad;
  }
  EXPECT_FALSE(connect_quic({"127.0.0.1:0"}, identity.fingerprint(), identity, events));
  EXPECT_FALSE(connect_quic({}, identity.fingerprint(), identity, events));
  auto first = listen_quic("127.0.0.1:0", identity, events);
  ASSERT_TRUE(first);
  const auto second = listen_quic(first.value()->local_address(), identity, events);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().text().find("Choose another port"), std::string::npos) << second.error().text();
}

}  // namespace
}  // namespace slosh::testing
