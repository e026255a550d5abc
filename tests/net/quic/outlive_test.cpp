// What ngtcp2 itself does not survive never reaches it. Each case here ended the process before net/quic
// refused it.
#include <gtest/gtest.h>

#include <algorithm>

#include "net/quic/frame_guard.h"
#include "tests/net/quic/crafted_end.h"
#include "tests/net/quic/ends.h"

namespace slosh::testing {
namespace {

using quic::FrameVerdict;
using quic::guard_frames;

/// A host of ours, a bystander, and a client that keeps no rules.
struct Attack : Pair {
  explicit Attack(CraftedEnd::Rewrite rewrite = {}) {
    establish();
    crafted = CraftedEnd::client(host->local_address(), "127.0.0.1:0", std::move(rewrite));
  }
  bool until(const std::function<bool()>& done, double seconds = 20.0) {
    const std::int64_t give_up = steady_now_ns() + to_nanoseconds(seconds);
    while (!done()) {
      if (steady_now_ns() > give_up) return false;
      turn();
    }
    return true;
  }
  void turn() {
    crafted->turn();
    host->run_once(steady_now_ns() + 500'000);
    peer->run_once(0);
  }
  void run_on(double seconds) {
    const std::int64_t end = steady_now_ns() + to_nanoseconds(seconds);
    until([&] { return steady_now_ns() >= end; });
  }
  bool open() {
    return until([&] { return crafted->open() && host_events.connected.size() == 2; });
  }
  bool bystander_is_well() {
    const std::size_t had = peer_events.datagrams.size();
    host->send_datagram(host_events.connected[0], Priority::kState, shared({1}));
    return peer_events.closed.empty() && until([&] { return peer_events.datagrams.size() > had; });
  }
  std::unique_ptr<CraftedEnd> crafted;
};

TEST(Outlive, APortThatFlipsAndComesBack) {
  Attack attack;
  ASSERT_TRUE(attack.open());
  const std::size_t other = attack.crafted->add_socket();
  for (int round = 0; round < 3; ++round) {
    attack.crafted->use_socket(other);
    ASSERT_TRUE(attack.crafted->send_datagram({1, 2, 3}));
    attack.turn();
    attack.crafted->use_socket(0);
    ASSERT_TRUE(attack.crafted->send_datagram({4, 5, 6}));
    attack.turn();
  }
  attack.run_on(0.5);
  EXPECT_FALSE(attack.crafted->over());
  EXPECT_TRUE(attack.host_events.closed.empty());
  EXPECT_EQ(attack.host_events.datagrams.size(), 6u);
  EXPECT_LE(attack.crafted->largest_received(), 1200u) << "a probe for longer packets was sent";
  EXPECT_TRUE(attack.bystander_is_well());
}

TEST(Outlive, ConnectionIdsThatAreTakenBackTwice) {
  Attack attack;
  ASSERT_TRUE(attack.open());
  for (const auto& [sequence, prior] : {std::pair{20, 19}, {3, 1}, {3, 1}}) {
    attack.crafted->send_frames(
        new_connection_id(static_cast<std::uint64_t>(sequence), static_cast<std::uint64_t>(prior)));
    attack.turn();
  }
  ASSERT_TRUE(attack.until([&] { return attack.crafted->over(); }));
  EXPECT_EQ(attack.crafted->last_words().text, "the other side takes its connection ids back");
  EXPECT_EQ(attack.crafted->last_words().code, std::uint64_t{NGTCP2_PROTOCOL_VIOLATION});
  EXPECT_TRUE(attack.bystander_is_well());
}

TEST(Outlive, AFrameOfIdsBehindWhatIsNoFrame) {
  // ngtcp2 takes every type with the bit of STREAM for one: behind it stands what was refused above.
  Attack attack;
  ASSERT_TRUE(attack.open());
  for (const auto& [sequence, prior] : {std::pair{20, 19}, {3, 1}, {3, 1}}) {
    Bytes frames{0x2a, 0x04, 0x01, 0x00};  // no such frame; read as STREAM 4, a byte
    const Bytes ids =
        new_connection_id(static_cast<std::uint64_t>(sequence), static_cast<std::uint64_t>(prior));
    frames.insert(frames.end(), ids.begin(), ids.end());
    attack.crafted->send_frames(frames);
    attack.turn();
  }
  ASSERT_TRUE(attack.until([&] { return attack.crafted->over(); }));
  EXPECT_EQ(attack.crafted->last_words().text, "the other side sent what is no frame of QUIC");
  EXPECT_TRUE(attack.bystander_is_well());
}

TEST(Outlive, MoreConnectionIdsThanAnybodyKeeps) {
  // The same number twice is a repeated packet: allowed, and nothing comes of it.
  Attack attack;
  ASSERT_TRUE(attack.open());
  for (std::uint64_t round = 0; round < 60; ++round) {
    attack.crafted->send_frames(new_connection_id(1 + round / 2, 0));
    attack.turn();
  }
  attack.run_on(0.2);
  EXPECT_FALSE(attack.crafted->over());
  ASSERT_TRUE(attack.crafted->send_datagram({9}));
  EXPECT_TRUE(attack.until([&] { return !attack.host_events.datagrams.empty(); }));
  EXPECT_TRUE(attack.bystander_is_well());
}

TEST(Outlive, AClientHelloWithoutTransportParameters) {
  int hidden = 0;
  Attack attack([&](std::uint8_t first, std::span<std::uint8_t> payload) {
    if (!(first & 0x80) || (first & 0x30) != 0) return;  // Initial packets only
    for (std::size_t i = 0; i + 4 < payload.size(); ++i)
      if (payload[i] == 0x00 && payload[i + 1] == 0x39 && payload[i + 2] == 0x00 && payload[i + 3] > 20) {
        payload[i] = 0x3a;
        ++hidden;
        break;
      }
  });
  ASSERT_TRUE(attack.until([&] { return attack.crafted->over(); }));
  EXPECT_GT(hidden, 0);
  EXPECT_FALSE(attack.crafted->open());
  EXPECT_EQ(attack.crafted->last_words().code, 0x100u + 109u) << "the alert is missing_extension";
  EXPECT_EQ(attack.host_events.connected.size(), 1u);
  EXPECT_TRUE(attack.bystander_is_well());
}

/// A move to another port with another connection id while a change of port alone is still looked into.
void meet_two_moves(bool answer) {
  Attack attack;
  ASSERT_TRUE(attack.open());
  attack.run_on(0.1);
  const std::size_t rebound = attack.crafted->add_socket(), moved = attack.crafted->add_socket();
  attack.crafted->use_socket(rebound);
  ASSERT_TRUE(attack.crafted->send_datagram({1}));
  ASSERT_TRUE(!answer || attack.until([&] { return !attack.host_events.migrated.empty(); }));
  attack.host->run_once(steady_now_ns() + 500'000);
  ASSERT_TRUE(attack.crafted->migrate_to(moved));
  for (int i = 0; i < 20; ++i) {
    attack.crafted->send_datagram({2});
    attack.run_on(0.1);
  }
  EXPECT_FALSE(attack.crafted->over()) << attack.crafted->last_words().text;
  EXPECT_TRUE(attack.host_events.closed.empty());
  ASSERT_FALSE(attack.host_events.migrated.empty());
  EXPECT_EQ(attack.host_events.migrated.back(), attack.crafted->address());
  EXPECT_TRUE(attack.bystander_is_well());
}

TEST(Outlive, AMoveWithANewIdAfterAChangeOfPort) {
  meet_two_moves(true);
}

TEST(Outlive, AMoveWithANewIdDuringAChangeOfPort) {
  meet_two_moves(false);
}

/// A peer of ours at a host that keeps no rules.
struct Trap {
  Trap() : identity(Identity::generate()), crafted(CraftedEnd::host(identity)) {
    peer = std::move(
        connect_quic({crafted->address()}, identity.fingerprint(), Identity::generate(), events).value());
  }
  bool until(const std::function<bool()>& done, double seconds = 20.0) {
    const std::int64_t give_up = steady_now_ns() + to_nanoseconds(seconds);
    while (!done()) {
      if (steady_now_ns() > give_up) return false;
      peer->run_once(steady_now_ns() + 500'000);
      crafted->turn();
    }
    return true;
  }
  bool open() {
    return until([&] { return crafted->open() && !events.connected.empty(); });
  }
  Identity identity;
  std::unique_ptr<CraftedEnd> crafted;
  Recorder events;
  std::unique_ptr<Endpoint> peer;
};

TEST(Outlive, AHostThatTakesItsConnectionIdsBackTwice) {
  Trap trap;
  ASSERT_TRUE(trap.open());
  for (const auto& [sequence, prior] : {std::pair{20, 19}, {3, 1}, {3, 1}}) {
    trap.crafted->send_frames(
        new_connection_id(static_cast<std::uint64_t>(sequence), static_cast<std::uint64_t>(prior), 100));
    trap.peer->run_once(steady_now_ns() + 500'000);
  }
  ASSERT_TRUE(trap.until([&] { return !trap.events.closed.empty(); }));
  EXPECT_EQ(trap.events.reasons[0].text, "the other side takes its connection ids back");
  EXPECT_EQ(trap.events.reasons[0].cause, CloseCause::kBroken);
}

TEST(Outlive, AHostThatRepeatsItsConnectionIds) {
  Trap trap;
  ASSERT_TRUE(trap.open());
  for (std::uint64_t round = 0; round < 60; ++round) {
    trap.crafted->send_frames(new_connection_id(1 + round / 2, 0, 100));
    trap.peer->run_once(steady_now_ns() + 500'000);
  }
  ASSERT_TRUE(trap.crafted->send_datagram({9}));
  EXPECT_TRUE(trap.until([&] { return !trap.events.datagrams.empty(); }));
  EXPECT_TRUE(trap.events.closed.empty());
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(FrameGuard, PutsPingAndPaddingInThePlaceOfAnId) {
  const Bytes before{0x10, 0x41, 0x00};                      // MAX_DATA
  const Bytes after{0x31, 0x02, 0xaa, 0xbb, 0x08, 4, 0x18};  // DATAGRAM, STREAM to the end
  const Bytes id = new_connection_id(1, 0);
  Bytes payload = joined({before, id, after});
  EXPECT_EQ(guard_frames(payload), FrameVerdict::kPass);
  Bytes ping(id.size(), 0);
  ping[0] = 1;
  EXPECT_EQ(payload, joined({before, ping, after}));
}

TEST(FrameGuard, ReadsEveryFrameToItsEnd) {
  const std::vector<Bytes> frames{
      {0x00},
      {0x01},
      {0x02, 9, 1, 1, 2, 0, 3},     // ACK with a second range
      {0x03, 9, 1, 0, 2, 1, 2, 3},  // with ECN
      {0x04, 4, 1, 2},              // RESET_STREAM
      {0x05, 4, 1},                 // STOP_SENDING
      {0x06, 0, 2, 0x18, 0x18},     // CRYPTO
      {0x07, 2, 0x18, 0x18},        // NEW_TOKEN
      {0x0e, 4, 7, 2, 0x18, 0x18},  // STREAM with offset and length
      {0x0a, 4, 2, 0x18, 0x18},     // STREAM with length
      {0x10, 1},
      {0x11, 4, 1},
      {0x12, 1},
      {0x13, 1},
      {0x14, 1},
      {0x15, 4, 1},
      {0x16, 1},
      {0x17, 1},
      {0x19, 1},                          // RETIRE_CONNECTION_ID
      {0x1a, 0x18, 1, 2, 3, 4, 5, 6, 7},  // PATH_CHALLENGE
      {0x1b, 0x18, 1, 2, 3, 4, 5, 6, 7},
      {0x1c, 1, 6, 2, 0x18, 0x18},  // CONNECTION_CLOSE
      {0x1d, 1, 2, 0x18, 0x18},
      {0x1e},
      {0x31, 2, 0x18, 0x18},  // DATAGRAM
  };
  for (const Bytes& frame : frames) {
    Bytes payload = joined({frame, new_connection_id(5, 4)});
    EXPECT_EQ(guard_frames(payload), FrameVerdict::kRetiresAnId) << int(frame[0]);
    Bytes harmless = joined({frame, new_connection_id(5, 0)});
    EXPECT_EQ(guard_frames(harmless), FrameVerdict::kPass) << int(frame[0]);
    EXPECT_TRUE(std::equal(frame.begin(), frame.end(), harmless.begin())) << int(frame[0]);
    for (std::size_t size = 1; size < frame.size(); ++size) {
      Bytes cut(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_EQ(guard_frames(cut), FrameVerdict::kMalformed) << int(frame[0]) << " of " << size;
    }
  }
  // Ranges below zero, behind more than the library looks at.
  Bytes many{0x02, 0x3f, 1, 40, 0};
  for (int i = 0; i < 80; ++i) many.push_back(i < 70 ? 0 : 0x3f);
  Bytes payload = joined({many, new_connection_id(5, 4)});
  EXPECT_EQ(guard_frames(payload), FrameVerdict::kRetiresAnId);
  Bytes open_ended{0x08, 4, 0x18, 0x18};  // STREAM to the end of the packet
  EXPECT_EQ(guard_frames(open_ended), FrameVerdict::kPass);
  Bytes last{0x30, 0x18, 0x18};
  EXPECT_EQ(guard_frames(last), FrameVerdict::kPass);
}

TEST(FrameGuard, LetsNothingPassThatIsNoFrame) {
  for (int type = 0; type < 256; ++type) {
    const bool known = type <= 0x1e || type == 0x30 || type == 0x31;
    if (known) continue;
    Bytes payload(40, 0);
    payload[0] = static_cast<std::uint8_t>(type);
    EXPECT_EQ(guard_frames(payload), FrameVerdict::kMalformed) << type;
  }
  Bytes huge{0x02, 1, 1, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0};  // 2^62 ranges
  EXPECT_EQ(guard_frames(huge), FrameVerdict::kMalformed);
}

}  // namespace
}  // namespace slosh::testing
