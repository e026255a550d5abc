#include "host/server/body_parts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "net/wire/all_messages.h"
#include "tests/host/server/scripted_peer.h"

namespace slosh {
namespace {

Scene many(std::size_t free_bodies, std::size_t grips) {
  Scene scene;
  for (std::size_t i = 0; i < free_bodies; ++i) {
    Body body;
    body.motion = BodyMotion::kFree;
    scene.bodies.push_back(body);
  }
  scene.grips.resize(grips);
  return scene;
}

BodyMessage state_of(const Scene& scene) {
  BodyMessage message;
  message.run = 3;
  message.rate = 0.5;
  message.stamp_ns = 123456789;
  message.bodies.tick = 1'000'000;
  message.bodies.time = 12.5;
  message.bodies.status = 0xffffffff;
  message.bodies.bodies.resize(scene.bodies.size());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    message.bodies.bodies[i].pose.position.x = static_cast<double>(i);
  message.bodies.grips.resize(scene.grips.size());
  for (std::size_t i = 0; i < scene.grips.size(); ++i)
    message.bodies.grips[i].handle.position.y = static_cast<double>(i);
  return message;
}

std::vector<wire::Bodies> decode_all(const std::vector<SharedBytes>& datagrams) {
  std::vector<wire::Bodies> all;
  for (const SharedBytes& bytes : datagrams) {
    EXPECT_LE(bytes->size(), wire::kMaxDatagram);
    const wire::Fault fault =
        wire::dispatch_datagram(wire::MessageList<wire::Bodies>{}, *bytes,
                                [&](const wire::Bodies& message) { all.push_back(message); });
    EXPECT_FALSE(fault) << fault.text();
  }
  return all;
}

TEST(BodyParts, EveryBodyArrivesOnceInDatagramsThatFit) {
  for (const std::size_t count : {0u, 1u, 11u, 12u, 13u, 100u, 256u}) {
    const Scene scene = many(count, count == 0 ? 0 : 64);
    BodyParts parts(scene);
    parts.set(state_of(scene));
    const std::vector<wire::Bodies> all = decode_all(parts.to(wire::kMaxTick, std::int64_t{1} << 60));
    std::vector<int> bodies(count);
    std::size_t grips = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i].parts, all.size());
      EXPECT_EQ(all[i].part, i);
      EXPECT_EQ(all[i].tick, 1'000'000u);
      EXPECT_EQ(all[i].run, 3u);
      EXPECT_EQ(all[i].pose_number, wire::kMaxTick);
      EXPECT_EQ(all[i].pose_stamp_ns, std::int64_t{1} << 60);
      for (const wire::BodyEntry& entry : all[i].bodies) {
        bodies[entry.body] += 1;
        EXPECT_EQ(entry.pose.position.x, entry.body);
      }
      for (const wire::GripEntry& entry : all[i].grips) {
        EXPECT_EQ(entry.handle.position.y, entry.grip);
        grips += 1;
      }
    }
    EXPECT_EQ(std::count(bodies.begin(), bodies.end(), 1), static_cast<std::ptrdiff_t>(count));
    EXPECT_EQ(grips, scene.grips.size());
  }
}

TEST(BodyParts, AFixedBodyIsSentOnlyWhenItIsMeasured) {
  Scene scene = many(3, 0);
  scene.bodies[0].motion = BodyMotion::kFixed;
  scene.bodies[1].motion = BodyMotion::kFixed;
  scene.bodies[1].measured = true;
  BodyParts parts(scene);
  parts.set(state_of(scene));
  const std::vector<wire::Bodies> all = decode_all(parts.to(0, 0));
  ASSERT_EQ(all.size(), 1u);
  ASSERT_EQ(all[0].bodies.size(), 2u);
  EXPECT_EQ(all[0].bodies[0].body, 1u);
}

TEST(BodyParts, WatchersShareTheSameBytes) {
  const Scene scene = many(3, 1);
  BodyParts parts(scene);
  parts.set(state_of(scene));
  const SharedBytes first = parts.to(0, 0)[0];
  parts.to(5, 6);
  EXPECT_EQ(parts.to(0, 0)[0], first);
  parts.set(state_of(scene));
  EXPECT_NE(parts.to(0, 0)[0], first);
}

}  // namespace
}  // namespace slosh
