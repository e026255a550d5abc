// Every message: round trips, damages, sizes.
#include <gtest/gtest.h>

#include <algorithm>

#include "net/wire/all_messages.h"
#include "net/wire/describe.h"
#include "tests/net/wire/damage.h"

namespace slosh {
namespace {

using namespace wire;

template <class M>
class EveryMessage : public ::testing::Test {};

template <class List>
struct TestedTypes;
template <class... M>
struct TestedTypes<MessageList<M...>> {
  using Types = ::testing::Types<M...>;
};
template <class A, class B>
struct Joined;
template <class... A, class... B>
struct Joined<MessageList<A...>, MessageList<B...>> {
  using List = MessageList<A..., B...>;
};
// Bye goes both ways; twice tested is no harm.
using Control = Joined<PeerControl, HostControl>::List;
using Datagrams = Joined<PeerDatagrams, HostDatagrams>::List;
using All = TestedTypes<Joined<Control, Datagrams>::List>::Types;
TYPED_TEST_SUITE(EveryMessage, All);

/// Puts right what rules between fields ask for.
template <class M>
M drawn(std::uint64_t seed, std::size_t least_list = 0) {
  M message = random_message<M>(seed, least_list);
  if constexpr (std::is_same_v<M, SnapshotFeedback>) {
    for (BlockRange& range : message.missing) range.count = std::min(range.count, 0x1000000 - range.first);
  }
  if constexpr (std::is_same_v<M, Cuts>) {
    for (CutEntry& entry : message.bodies) {
      for (CutPlane& plane : entry.cut.planes) plane.normal = {0.6, 0.0, 0.8};
      entry.cut.mass.mass = std::max(entry.cut.mass.mass, 1.0);
      entry.cut.mass.inertia = glm::dmat3(2.0);
    }
  }
  return message;
}

TYPED_TEST(EveryMessage, ComesBackToTheBit) {
  test::expect_round_trip(TypeParam{});
  for (std::uint64_t seed = 0; seed < 300; ++seed) test::expect_round_trip(drawn<TypeParam>(seed));
}

TYPED_TEST(EveryMessage, CutAnywhereIsRefused) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) test::expect_cuts_refused(drawn<TypeParam>(seed));
}

TYPED_TEST(EveryMessage, EveryDamageIsRefusedByItsFieldsName) {
  std::size_t damages = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    damages += test::expect_damages_refused(drawn<TypeParam>(seed, 1));
  EXPECT_GE(damages, 10 * 3u);
}

TYPED_TEST(EveryMessage, ItsSizeIsWithinWhatThePageSays) {
  Describer describer;
  TypeParam empty{};
  visit(describer, empty);
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const std::size_t size = encoded(drawn<TypeParam>(seed)).size();
    EXPECT_GE(size, describer.least_bytes());
    EXPECT_LE(size, describer.most_bytes());
  }
}

template <class M>
std::uint64_t most_bytes() {
  Describer describer;
  M empty{};
  visit(describer, empty);
  return describer.most_bytes();
}

TEST(Messages, EveryControlMessageFitsItsEnvelope) {
  for_each_message(Control{}, []<class M>(const M&) { EXPECT_LE(most_bytes<M>(), kMaxControlMessage); });
}

TEST(Messages, WhatAPeerSendsFitsADatagram) {
  for_each_message(PeerDatagrams{}, []<class M>(const M&) { EXPECT_LE(1 + most_bytes<M>(), kMaxDatagram); });
}

TEST(Messages, TypeNumbersAreUnique) {
  std::vector<int> control, datagrams{static_cast<int>(DatagramType::kSnapshotPiece)};
  for_each_message(PeerControl{}, [&](const auto& m) { control.push_back(static_cast<int>(m.kType)); });
  for_each_message(HostControl{}, [&]<class M>(const M& m) {
    if (!std::is_same_v<M, Bye>) control.push_back(static_cast<int>(m.kType));
  });
  for_each_message(Datagrams{}, [&](const auto& m) { datagrams.push_back(static_cast<int>(m.kType)); });
  for (std::vector<int>* numbers : {&control, &datagrams}) {
    std::sort(numbers->begin(), numbers->end());
    EXPECT_EQ(std::adjacent_find(numbers->begin(), numbers->end()), numbers->end());
  }
}

TEST(Messages, ABlockRangePastTheEndIsRefused) {
  SnapshotFeedback feedback;
  feedback.missing = {{0xffffff, 2}};
  Bytes bytes;
  EXPECT_EQ(encode(feedback, bytes).field, "missing.count");
  SnapshotFeedback back;
  EXPECT_EQ(decode(bytes, back).text(), "missing.count: reaches past the last block");
}

TEST(Messages, DispatchFindsTheTypeOrSaysThatThereIsNone) {
  Hello hello;
  hello.name = "Ada";
  std::string seen;
  const auto handle = [&]<class M>(M& message) {
    if constexpr (std::is_same_v<M, Hello>) seen = message.name;
  };
  EXPECT_FALSE(dispatch(PeerControl{}, 1, encoded(hello), handle));
  EXPECT_EQ(seen, "Ada");
  EXPECT_EQ(dispatch(PeerControl{}, 16, encoded(hello), handle).text(),
            "type: 16 is no message that may come here");
  EXPECT_EQ(dispatch(PeerControl{}, 1, ByteView{}, handle).text(), "version: ends too early");
  EXPECT_EQ(
      dispatch(PeerControl{}, 1, encoded(hello), [](auto&) { return Fault{"turn", "said twice"}; }).text(),
      "turn: said twice");
  EXPECT_EQ(dispatch_datagram(PeerDatagrams{}, ByteView{}, handle).text(), "type: ends too early");
  EXPECT_FALSE(dispatch_datagram(PeerDatagrams{}, datagram(ClockPing{7, 8}), handle));
}

TEST(Messages, AFullRosterFits) {
  Roster roster;
  RosterEntry entry{kMaxPeers - 1, std::string(kMaxName, 'n'), Role::kParticipant, true, {}};
  for (std::uint32_t grip = 0; grip < kMaxGrips; ++grip) entry.grips.push_back(grip);
  roster.peers.assign(kMaxPeers, entry);
  Fault fault;
  const Bytes bytes = control(roster, &fault);
  EXPECT_FALSE(fault);
  EXPECT_LE(bytes.size(), kMaxControlMessage);
  Roster back;
  EXPECT_FALSE(decode(ByteView(bytes).subspan(4), back));
  EXPECT_EQ(back.peers.size(), kMaxPeers);
}

}  // namespace
}  // namespace slosh
