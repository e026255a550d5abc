// A host that means harm, or is broken: a peer ends in words or goes on, and never crashes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "net/wire/all_messages.h"
#include "net/wire/text.h"
#include "scripted_host.h"
#include "tests/support/randomize.h"

namespace slosh {
namespace {

using test::Together;

wire::Bytes noise(std::mt19937_64& random, std::size_t bytes) {
  wire::Bytes out(bytes);
  for (std::uint8_t& byte : out) byte = static_cast<std::uint8_t>(random());
  return out;
}

TEST(HostileHost, NoiseOnTheControlStreamEndsInWords) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 40; ++i) {
    Together both(MemoryLink{});
    both.host.on_hello = [&](const wire::Hello&) {
      both.host.raw_control(noise(random, 1 + random() % 3000));
    };
    const bool ended = both.run_until(LinkState::kEnded, 12.0);
    EXPECT_TRUE(ended);
    ASSERT_TRUE(both.status().error);
    EXPECT_FALSE(both.status().error->what.empty());
  }
}

TEST(HostileHost, NoiseInDatagramsIsCountedAndHarmless) {
  Together both(MemoryLink{});
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  std::mt19937_64 random(2);
  for (int i = 0; i < 3000; ++i) {
    wire::Bytes bytes = noise(random, random() % 1100);
    if (!bytes.empty() && i % 2 == 0) {
      constexpr std::uint8_t kTypes[] = {16, 17, 18, 19};
      bytes[0] = kTypes[random() % 4];
    }
    both.host.raw_datagram(bytes);
    if (i % 10 == 0) both.run(0.001);
  }
  both.run(0.5);
  EXPECT_EQ(both.status().state, LinkState::kLive);
  EXPECT_GT(both.status().numbers.bad_datagrams, 1000u);
  EXPECT_NEAR(both.bodies().bodies.bodies[0].pose.position.x, both.host.time, 0.1) << "bodies still come";
}

/// A message that decodes: of any content, but drawn again while it breaks a rule between its fields.
template <class M>
M valid_message(std::uint64_t& seed) {
  while (true) {
    const M message = wire::random_message<M>(seed++);
    M back{};
    if (!wire::decode(wire::encoded(message), back)) return message;
  }
}

/// What the link hands on is as large as the scene and a number everywhere, and what it tells can be shown.
void expect_sound(Together& both) {
  const BodySnapshot& bodies = both.bodies().bodies;
  ASSERT_EQ(bodies.bodies.size(), 1u);
  ASSERT_EQ(bodies.grips.size(), 2u);
  const auto finite = [](const glm::dvec3& v) { return std::isfinite(v.x + v.y + v.z); };
  for (const auto& body : bodies.bodies) {
    EXPECT_TRUE(finite(body.pose.position) && finite(body.twist.linear) && finite(body.twist.angular));
    EXPECT_NEAR(glm::length(body.pose.orientation), 1.0, 1e-3);
  }
  for (const auto& grip : bodies.grips) {
    EXPECT_TRUE(finite(grip.pose.position));
    EXPECT_NEAR(glm::length(grip.pose.orientation), 1.0, 1e-3);
  }
  EXPECT_TRUE(std::isfinite(both.bodies().rate) && both.bodies().rate >= 0.0);
  const RemoteStatus status = both.status();
  EXPECT_TRUE(std::isfinite(status.world_time));
  EXPECT_TRUE(status.held.empty() || status.held.size() == 2u);
  for (const std::string& notice : both.shared.notices) EXPECT_EQ(wire::text_problem(notice), "") << notice;
  if (status.state == LinkState::kEnded) {
    ASSERT_TRUE(status.error) << "it says why";
    EXPECT_EQ(wire::text_problem(status.error->what), "");
  }
}

TEST(HostileHost, ValidMessagesOfAnyContentAreSurvived) {
  // What decodes may still name grips, bodies and peers that are not, or times that cannot be.
  int came_back = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Together both(MemoryLink{});
    ASSERT_TRUE(both.run_until(LinkState::kLive));
    std::uint64_t at = seed * 1000;
    for (int i = 0; i < 40; ++i) {
      wire::for_each_message(wire::HostDatagrams{},
                             [&]<class M>(const M&) { both.host.send(valid_message<M>(at)); });
      both.run(0.004);
      expect_sound(both);
    }
    EXPECT_EQ(both.status().state, LinkState::kLive) << "no datagram ends a link";
    EXPECT_EQ(both.status().numbers.bad_datagrams, 0u) << "every one of them decodes";
    wire::for_each_message(wire::HostControl{}, [&]<class M>(const M&) {
      // A second Welcome always ends it: half of the hosts say one.
      const bool ends = std::is_same_v<M, wire::Welcome> && seed % 2 == 0;
      if constexpr (!std::is_same_v<M, wire::Refused> && !std::is_same_v<M, wire::Bye>) {
        if (!ends) both.host.say(valid_message<M>(at));
      }
      both.run(0.004);
      expect_sound(both);
    });
    both.run(0.1);
    expect_sound(both);
    if (both.status().state == LinkState::kEnded) continue;  // a Welcome that comes twice may end it

    // The host falls and comes back in its right mind: so does the peer, and the world is the host's again.
    both.host.crash();
    ASSERT_TRUE(both.run_until(LinkState::kReconnecting, 20.0));
    both.host.come_back();
    ASSERT_TRUE(both.run_until(LinkState::kLive, 20.0));
    both.run(1.0);
    EXPECT_NEAR(both.bodies().bodies.bodies[0].pose.position.x, both.host.time, 0.2) << "bodies come again";
    came_back += 1;
  }
  EXPECT_GE(came_back, 10) << "else there is little that is shown";
}

TEST(HostileHost, ABodyThatTheSceneHasNotIsNotTaken) {
  Together both(MemoryLink{});
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  wire::Bodies m;
  m.tick = 1u << 20;
  m.stamp_ns = both.host.now_ns();
  m.bodies.resize(1);
  m.bodies[0].body = 200;
  both.host.send(m);
  both.run(0.2);
  EXPECT_EQ(both.status().numbers.bodies.wrong, 1u);
}

TEST(HostileHost, ASceneThatIsNoneEndsInWords) {
  Together both(MemoryLink{});
  both.host.package = {1, 2, 3, 4, 5};
  ASSERT_TRUE(both.run_until(LinkState::kEnded));
  EXPECT_NE(both.status().error->what.find("the scene of the host's is not understood"), std::string::npos);
}

TEST(HostileHost, EveryCutOfTheSceneIsSurvived) {
  const wire::Bytes whole = pack_scene(test::shared_scene(), 0.01, SceneParts::kSeen).value();
  for (std::size_t bytes = 0; bytes < whole.size(); bytes += 7) {
    Together both(MemoryLink{});
    both.host.package.assign(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(bytes));
    EXPECT_TRUE(both.run_until(LinkState::kEnded, 12.0)) << bytes;
  }
}

TEST(HostileHost, AnEndlessSceneIsCutOff) {
  Together both(MemoryLink{});
  both.host.sends_scene = false;
  ASSERT_TRUE(both.run(1.0, [&] { return !both.host.hellos.empty(); }));
  const std::int64_t stream = both.host.endpoint().open_stream(both.host.connection, false);
  const wire::Bytes lump(8u << 20, 0);
  for (int i = 0; i < 9; ++i) both.host.endpoint().send_stream(both.host.connection, stream, lump, false);
  ASSERT_TRUE(both.run_until(LinkState::kEnded));
  EXPECT_NE(both.status().error->what.find("larger than allowed"), std::string::npos);
}

TEST(HostileHost, OneThatSaysNothingIsLeftAfterAWhile) {
  Together both(MemoryLink{});
  both.host.welcomes = both.host.sends_scene = false;
  ASSERT_TRUE(both.run_until(LinkState::kEnded, 15.0));
  EXPECT_NE(both.status().error->what.find("said nothing"), std::string::npos);
}

TEST(HostileHost, PongsThatWereNotAskedForDoNotMoveTheClock) {
  Together both(MemoryLink{});
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  both.run(1.0);
  for (std::uint32_t number = 0; number < 2000; ++number) {
    wire::ClockPong pong;
    pong.number = number;
    pong.received_ns = pong.sent_ns = 77;
    both.host.send(pong);
    if (number % 50 == 0) both.run(0.001);
  }
  both.run(0.2);
  EXPECT_EQ(both.status().numbers.clock_steps, 0u);
  EXPECT_NEAR(both.status().world_time, both.host.time, 0.06) << "told 20 times a second";
}

}  // namespace
}  // namespace slosh
