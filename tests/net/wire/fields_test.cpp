// What a Writer does with values that a Reader would refuse, and how a Reader bounds what it keeps.
#include <gtest/gtest.h>

#include <limits>
#include <tuple>

#include "net/wire/all_messages.h"
#include "tests/net/wire/damage.h"

namespace slosh {
namespace {

using namespace wire;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(Writer, BringsAPoseIntoRangeAndTells) {
  HandEntry hand;
  hand.pose.position = {kNan, 1e9, -kInfinite};
  hand.pose.orientation = glm::dquat(0.0, 0.0, 0.0, 0.0);
  hand.received_ns = std::numeric_limits<std::int64_t>::min();
  hand.grip = 200;
  Bytes bytes;
  const Fault fault = encode(hand, bytes);
  EXPECT_EQ(fault.text(), "grip: 200 is out of range");
  HandEntry back;
  const Fault refused = decode(bytes, back);
  ASSERT_FALSE(refused) << refused.text();
  EXPECT_EQ(back.pose.position, glm::dvec3(0.0, kMaxPosition, -kMaxPosition));
  EXPECT_EQ(back.pose.orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
  EXPECT_EQ(back.grip, kMaxGrips - 1);
  EXPECT_EQ(back.received_ns, -kMaxStamp);
}

TEST(Writer, NormalisesARotationThatIsNone) {
  Pose pose;
  pose.orientation = glm::dquat(3.0, 0.0, 4.0, 0.0);
  Bytes bytes;
  EXPECT_EQ(encode(pose, bytes).text(), "orientation: is not of unit length");
  Pose back;
  ASSERT_FALSE(decode(bytes, back));
  EXPECT_NEAR(back.orientation.w, 0.6, 1e-7);
  EXPECT_NEAR(back.orientation.y, 0.8, 1e-7);
}

TEST(Writer, CutsListsAndNamesTheElement) {
  Poses poses;
  poses.samples.resize(kMaxPoseRepeats + 3);
  Bytes bytes;
  EXPECT_EQ(encode(poses, bytes).field, "samples");
  Poses back;
  ASSERT_FALSE(decode(bytes, back));
  EXPECT_EQ(back.samples.size(), kMaxPoseRepeats);

  poses.samples.resize(2);
  poses.samples[1].time = kNan;
  bytes.clear();
  EXPECT_EQ(encode(poses, bytes).text(), "samples.time: is not a finite number");
  EXPECT_FALSE(decode(bytes, back));
}

TEST(Writer, CutsAndCleansASentenceWithoutComplaint) {
  Notice notice{std::string(2 * kMaxText, 'x') + "\n"};
  Bytes bytes;
  EXPECT_FALSE(encode(notice, bytes));
  Notice back;
  ASSERT_FALSE(decode(bytes, back));
  EXPECT_EQ(back.text, std::string(kMaxText, 'x'));
}

TEST(Writer, RoundsWithinTheRange) {
  // The largest single-precision number below 0.1 is what 0.1 must become when 0.1 is the end.
  struct Tenth {
    double value = 0.1;
  };
  Tenth tenth;
  Bytes bytes;
  Writer writer(bytes);
  writer.real32("value", tenth.value, 0.0, 0.1);
  EXPECT_FALSE(writer.fault());
  Reader reader(bytes);
  reader.real32("value", tenth.value, 0.0, 0.1);
  EXPECT_FALSE(reader.fault()) << reader.fault().text();
}

TEST(Reader, StopsAtTheFirstFaultAndKeepsItsName) {
  Poses poses;
  poses.samples.resize(3);
  Bytes bytes = encoded(poses);
  bytes[1] = kMaxGrips;
  Poses back;
  EXPECT_EQ(decode(bytes, back).text(), "samples.grip: 64 is above 63");
  EXPECT_EQ(back.samples.size(), 1u);
}

TEST(Reader, ACountAloneDoesNotMakeItKeepMemory) {
  // A roster that claims 1024 peers and has bytes for none of them.
  const Bytes bytes{0x80, 0x08, 0, 0};
  Roster back;
  EXPECT_EQ(decode(bytes, back).text(), "peers: ends too early");
  EXPECT_EQ(back.peers.capacity(), 0u);
}

TEST(Reader, EveryFormOfANumber) {
  const auto read = [](Bytes bytes) {
    std::uint64_t value = 0;
    Reader reader(bytes);
    reader.natural("n", value, 0, ~std::uint64_t{0});
    reader.finish();
    return reader.ok() ? std::to_string(value) : reader.fault().problem;
  };
  EXPECT_EQ(read({0}), "0");
  EXPECT_EQ(read({0x7f}), "127");
  EXPECT_EQ(read({0x80, 1}), "128");
  EXPECT_EQ(read({0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1}), "18446744073709551615");
  EXPECT_EQ(read({0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 2}),
            "is a number too long for 64 bits");
  EXPECT_EQ(read({0x80, 0}), "is a number written too long");
  EXPECT_EQ(read({0x80}), "ends too early");
  EXPECT_EQ(read({}), "ends too early");
}

/// Kinds of fields that no message uses yet.
struct Rare {
  int index = 2;
  int maybe = -1;
  Bytes blob{1, 2, 3};
  std::uint64_t bits = ~std::uint64_t{0};
};
template <class V>
void visit(V& v, Rare& m) {
  v.index("index", m.index, "things", 3, false);
  v.index("maybe", m.maybe, "things", 3, true);
  v.bytes("blob", m.blob, 2, 100);
  v.bits64("bits", m.bits);
}

TEST(Fields, RareKindsRoundTripAndRefuse) {
  test::expect_round_trip(Rare{});
  test::expect_cuts_refused(Rare{});
  EXPECT_EQ(test::expect_damages_refused(Rare{}), 5u + 4u + 6u);
  for (std::uint64_t seed = 0; seed < 200; ++seed) test::expect_round_trip(random_message<Rare>(seed));
}

struct Growing {
  std::uint32_t old_field = 1;
  std::uint32_t new_field = 2;
};
constexpr Capabilities kNewField = 1u << 5;
template <class V>
void visit(V& v, Growing& m) {
  v.natural("old_field", m.old_field, 0, 100);
  if (v.agreed(kNewField)) v.natural("new_field", m.new_field, 0, 100);
}

TEST(Capabilities, AFieldBehindOneIsThereOnlyWhenBothSidesSaidSo) {
  const Growing sent{7, 9};
  const Capabilities both = kNewField | 1;
  for (const auto& [writer, reader, whole] : {std::tuple{both, both, true},
                                              {0ul, 0ul, true},
                                              {1ul, 1ul, true},
                                              {both, 0ul, false},
                                              {0ul, both, false}}) {
    Bytes bytes;
    ASSERT_FALSE(encode(sent, bytes, writer));
    Growing back{0, 0};
    const Fault fault = decode(bytes, back, reader);
    EXPECT_EQ(!fault, whole) << fault.text();
    if (!whole) continue;
    EXPECT_EQ(back.old_field, 7u);
    EXPECT_EQ(back.new_field, writer & kNewField ? 9u : 0u);
  }
}

TEST(Capabilities, WhatANewerPeerAddsToItsHelloIsSkipped) {
  Hello hello;
  hello.name = "Ana";
  hello.capabilities = ~Capabilities{0};
  hello.later = Bytes(kMaxLater, 0xff);
  Hello back;
  ASSERT_FALSE(decode(encoded(hello), back));
  EXPECT_EQ(back.name, "Ana");
  EXPECT_EQ(back.capabilities & kOurCapabilities, kOurCapabilities);
}

}  // namespace
}  // namespace slosh
