#include "net/channel.h"

#include <gtest/gtest.h>

#include <thread>

namespace slosh {
namespace {

std::shared_ptr<Snapshot> snapshot_of(std::size_t particles, double time = 0.0) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->positions.resize(particles);
  snapshot->rigid.time = time;
  return snapshot;
}

TEST(SnapshotQueue, HandsSnapshotsOnInOrder) {
  SnapshotQueue queue(1 << 20);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(queue.push(snapshot_of(10, i)));
  EXPECT_EQ(queue.waiting(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(queue.pop(std::chrono::milliseconds(0))->rigid.time, i);
  EXPECT_EQ(queue.pop(std::chrono::milliseconds(0)), nullptr);
}

TEST(SnapshotQueue, DropsWhatDoesNotFitAndCountsIt) {
  const std::size_t one = size_in_bytes(*snapshot_of(1000));
  SnapshotQueue queue(2 * one);
  EXPECT_TRUE(queue.push(snapshot_of(1000)));
  EXPECT_TRUE(queue.push(snapshot_of(1000)));
  EXPECT_FALSE(queue.push(snapshot_of(1000)));
  EXPECT_EQ(queue.dropped(), 1u);
  EXPECT_NE(queue.pop(std::chrono::milliseconds(0)), nullptr);
  EXPECT_TRUE(queue.push(snapshot_of(1000))) << "room was made";
}

TEST(SnapshotQueue, ASnapshotLargerThanTheBoundStillGetsThroughAlone) {
  SnapshotQueue queue(10);
  EXPECT_TRUE(queue.push(snapshot_of(1000)));
  EXPECT_FALSE(queue.push(snapshot_of(1)));
}

// As World::fill_later() leaves one: who takes it gets it whole, and it counts for the bound as if it were.
TEST(SnapshotQueue, WhoTakesASnapshotHasItsParticlesBrought) {
  const std::size_t one = size_in_bytes(*snapshot_of(1000));
  SnapshotQueue queue(3 * one);
  int brought = 0;
  const auto left_behind = [&brought](float x) {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->to_come = 1000;
    snapshot->fetch = [&brought, x](std::span<glm::vec3> positions, std::span<std::uint8_t> fluid_index) {
      std::fill(positions.begin(), positions.end(), glm::vec3(x));
      std::fill(fluid_index.begin(), fluid_index.end(), std::uint8_t{7});
      ++brought;
    };
    return snapshot;
  };
  EXPECT_TRUE(queue.push(left_behind(1.0f)));
  EXPECT_TRUE(queue.push(left_behind(2.0f)));
  EXPECT_FALSE(queue.push(left_behind(3.0f)) && queue.push(left_behind(3.0f)));
  const SnapshotPointer first = queue.pop(std::chrono::milliseconds(0));
  ASSERT_EQ(first->positions.size(), 1000u);
  ASSERT_EQ(first->fluid_index.size(), 1000u);
  EXPECT_EQ(first->positions.back(), glm::vec3(1.0f));
  EXPECT_EQ(first->fluid_index.back(), 7);
  EXPECT_EQ(first->to_come, 0u);
  EXPECT_EQ(queue.pop_newest()->positions.size(), 1000u);
  EXPECT_EQ(queue.waiting(), 0u);
  EXPECT_EQ(brought, 2) << "those thrown away stay where they are";
}

TEST(SnapshotQueue, NewestThrowsTheOthersAway) {
  SnapshotQueue queue(1 << 20);
  EXPECT_EQ(queue.pop_newest(), nullptr);
  for (int i = 0; i < 4; ++i) queue.push(snapshot_of(10, i));
  EXPECT_EQ(queue.pop_newest()->rigid.time, 3.0);
  EXPECT_EQ(queue.waiting(), 0u);
}

TEST(SnapshotQueue, ClosingWakesAWaitingReaderAfterTheLastSnapshot) {
  SnapshotQueue queue(1 << 20);
  std::thread writer([&] {
    queue.push(snapshot_of(10, 1.0));
    queue.close();
  });
  int snapshots = 0;
  while (!queue.finished()) snapshots += queue.pop(std::chrono::milliseconds(10000)) != nullptr;
  writer.join();
  EXPECT_EQ(snapshots, 1);
}

TEST(Channel, CarriesPosesUpAndBodiesDown) {
  BodyMessage initial;
  initial.bodies.bodies.resize(2);
  Channel channel(3, initial, 1 << 20);
  ASSERT_EQ(channel.devices(), 3u);
  EXPECT_EQ(channel.bodies().front().bodies.bodies.size(), 2u) << "the peer sees the start before any step";
  EXPECT_EQ(channel.pose(2).front().device, 2u);

  channel.pose(1).back().pose.position.y = 4.0;
  channel.pose(1).publish();
  EXPECT_FALSE(channel.pose(0).update());
  ASSERT_TRUE(channel.pose(1).update());
  EXPECT_EQ(channel.pose(1).front().pose.position.y, 4.0);

  channel.bodies().back().bodies.tick = 9;
  channel.bodies().publish();
  ASSERT_TRUE(channel.bodies().update());
  EXPECT_EQ(channel.bodies().front().bodies.tick, 9u);
}

}  // namespace
}  // namespace slosh
