#include "peer/remote/pose_uplink.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace slosh {
namespace {

struct Uplink {
  explicit Uplink(std::size_t grips) : channel(grips, BodyMessage{}, 1 << 20), uplink(channel) {}
  Channel channel;
  PoseUplink uplink;

  void post(std::size_t grip, std::int64_t stamp_ns, double x = 0.0, bool engaged = true, bool felt = true) {
    PoseMessage& m = channel.pose(grip).back();
    m.device = static_cast<std::uint32_t>(grip);
    m.stamp_ns = stamp_ns;
    m.pose.position.x = x;
    m.engaged = engaged;
    m.felt = felt;
    channel.pose(grip).publish();
  }
  static wire::Poses read(const SharedBytes& bytes) {
    wire::Poses poses;
    const wire::Fault fault = wire::decode(wire::ByteView(*bytes).subspan(1), poses);
    EXPECT_FALSE(fault) << fault.text();
    EXPECT_EQ((*bytes)[0], static_cast<std::uint8_t>(wire::DatagramType::kPoses));
    EXPECT_LE(bytes->size(), wire::kMaxDatagram);
    return poses;
  }
};

TEST(PoseUplink, NumbersEachReadingAndRepeatsTheLastFew) {
  Uplink kit(1);
  for (int i = 1; i <= 6; ++i) {
    kit.post(0, 1000 * i, i);
    const SharedBytes bytes = kit.uplink.make({true});
    ASSERT_NE(bytes, nullptr);
    const wire::Poses poses = Uplink::read(bytes);
    ASSERT_EQ(poses.samples.size(), std::min<std::size_t>(i, kPoseSends));
    for (std::size_t k = 0; k < poses.samples.size(); ++k) {
      EXPECT_EQ(poses.samples[k].number, static_cast<std::uint64_t>(i) - k) << "newest first";
      EXPECT_EQ(poses.samples[k].stamp_ns, 1000 * (i - static_cast<int>(k))) << "a repeat is the same";
      EXPECT_EQ(poses.samples[k].pose.position.x, i - static_cast<int>(k));
    }
  }
}

TEST(PoseUplink, SaysNothingWhenThereIsNothingNew) {
  Uplink kit(1);
  EXPECT_EQ(kit.uplink.make({true}), nullptr) << "the device was not read yet";
  kit.post(0, 1000);
  EXPECT_NE(kit.uplink.make({true}), nullptr);
  EXPECT_EQ(kit.uplink.make({true}), nullptr) << "the same reading";
  EXPECT_EQ(kit.uplink.numbered(), 1u);
}

TEST(PoseUplink, SaysNothingOfHandsThatAreNotOurs) {
  Uplink kit(2);
  kit.post(0, 1000);
  kit.post(1, 1000);
  const wire::Poses poses = Uplink::read(kit.uplink.make({false, true}));
  ASSERT_EQ(poses.samples.size(), 1u);
  EXPECT_EQ(poses.samples[0].grip, 1u);
  EXPECT_EQ(kit.uplink.make({}), nullptr);
}

TEST(PoseUplink, AGripTakenAgainDoesNotRepeatWhatWasBefore) {
  Uplink kit(1);
  kit.post(0, 1000);
  (void)kit.uplink.make({true});
  EXPECT_EQ(kit.uplink.make({false}), nullptr);
  kit.post(0, 9000);
  const wire::Poses poses = Uplink::read(kit.uplink.make({true}));
  ASSERT_EQ(poses.samples.size(), 1u);
  EXPECT_EQ(poses.samples[0].stamp_ns, 9000);
  EXPECT_EQ(poses.samples[0].number, 2u) << "numbers go on";
}

TEST(PoseUplink, ManyHandsFitWithTheNewestOfEach) {
  Uplink kit(12);
  const std::vector<bool> held(12, true);
  for (int i = 1; i <= 5; ++i) {
    for (std::size_t grip = 0; grip < 12; ++grip) kit.post(grip, 1000 * i);
    const wire::Poses poses = Uplink::read(kit.uplink.make(held));
    std::set<std::uint32_t> newest;
    for (const wire::PoseSample& s : poses.samples) {
      if (s.stamp_ns == 1000 * i) newest.insert(s.grip);
    }
    EXPECT_EQ(newest.size(), 12u);
  }
}

TEST(PoseUplink, AHostThatKnowsOfItIsToldThatAHandIsNotFeltYet) {
  using wire::HoldsOn;
  for (const bool known : {true, false}) {
    Uplink kit(1);
    const wire::Capabilities agreed = known ? wire::kAllCapabilities : ~wire::kFeltHands;
    const auto said = [&](std::int64_t stamp_ns, bool engaged, bool felt) {
      kit.post(0, stamp_ns, 0.0, engaged, felt);
      return Uplink::read(kit.uplink.make({true}, agreed)).samples.front().engaged;
    };
    EXPECT_EQ(said(1000, true, false), known ? HoldsOn::kUnfelt : HoldsOn::kYes);
    EXPECT_EQ(said(2000, true, true), HoldsOn::kYes);
    EXPECT_EQ(said(3000, false, false), HoldsOn::kNo);
    EXPECT_EQ(said(4000, false, true), HoldsOn::kNo);
  }
}

/// An older host is sent a field that it never read, and reads all others as they are; so does a host of now
/// from an older peer, who counts in it.
TEST(PoseUplink, AnOlderHostIsSentWhatNobodyReads) {
  Uplink kit(1);
  kit.post(0, 1000, 0.25, true, true);
  const wire::Capabilities older = ~wire::kNoTickAcks;
  const wire::Poses poses = Uplink::read(kit.uplink.make({true}));
  ASSERT_EQ(poses.samples.size(), 1u);
  const wire::Bytes now = wire::datagram(poses), before = wire::datagram(poses, nullptr, older);
  EXPECT_EQ(before.size(), now.size() + 1);
  wire::Poses read;
  EXPECT_FALSE(wire::decode(wire::ByteView(before).subspan(1), read, older));
  ASSERT_EQ(read.samples.size(), 1u);
  EXPECT_EQ(read.samples[0].pose.position, poses.samples[0].pose.position);
  EXPECT_EQ(read.samples[0].time, poses.samples[0].time);
  // Type, count, grip, number and stamp_ns come before it; 300 takes two bytes.
  wire::Bytes counted = before;
  const std::size_t at = 1 + 1 + 1 + 1 + 8;
  ASSERT_EQ(counted[at], 0);
  counted[at] = 0xAC;
  counted.insert(counted.begin() + at + 1, 0x02);
  EXPECT_FALSE(wire::decode(wire::ByteView(counted).subspan(1), read, older));
  EXPECT_EQ(read.samples[0].time, poses.samples[0].time);
}

TEST(PoseUplink, WhatTheWireCannotCarryIsNotSent) {
  Uplink kit(1);
  kit.post(0, 1000, 1e9);
  EXPECT_EQ(kit.uplink.make({true}), nullptr);
}

TEST(PoseUplink, RepeatsBringNearlyAllSamplesOverALossyLink) {
  Uplink kit(1);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<> chance(0.0, 1.0);
  std::set<std::uint64_t> arrived;
  constexpr int kCount = 20000;
  for (int i = 1; i <= kCount; ++i) {
    kit.post(0, i);
    const SharedBytes bytes = kit.uplink.make({true});
    if (chance(random) < 0.05) continue;
    for (const wire::PoseSample& s : Uplink::read(bytes).samples) arrived.insert(s.number);
  }
  EXPECT_GT(static_cast<double>(arrived.size()), 0.999 * kCount);
}

}  // namespace
}  // namespace slosh
