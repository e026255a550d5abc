// Poses and states flow whatever congestion control thinks of the link, as long as the link carries them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "tests/net/quic/virtual_link.h"

namespace slosh::testing {
namespace {

constexpr std::size_t kPoseBytes = 450;       // four samples of a hand
constexpr std::size_t kPoseStateBytes = 300;  // two bodies

/// What arrived of one kind.
struct Arrivals {
  std::size_t sent = 0;
  std::size_t came = 0;
  std::size_t fewest = SIZE_MAX;  ///< in a tenth of a second
  double age_p99 = 0.0;           ///< s
};

Bytes stamped_pose(std::int64_t now_ns, std::size_t size) {
  Bytes bytes(size, 1);
  std::memcpy(bytes.data(), &now_ns, sizeof(now_ns));
  return bytes;
}

/// Poses up and states down, 500 a second each, for `seconds` after two of warming up.
void pose_flow(VirtualLink& link, double seconds, Arrivals& poses, Arrivals& states) {
  std::vector<double> ages[2];
  std::size_t window[2] = {};
  const auto collect = [&](Recorder& events, Arrivals& into, int kind, bool counts) {
    for (const Bytes& datagram : events.datagrams) {
      std::int64_t sent_ns = 0;
      std::memcpy(&sent_ns, datagram.data(), sizeof(sent_ns));
      if (!counts) continue;
      ++into.came;
      ++window[kind];
      ages[kind].push_back(to_seconds(link.now_ns - sent_ns));
    }
    events.datagrams.clear();
  };
  const int steps = static_cast<int>((seconds + 2.0) * 2000.0);
  for (int i = 0; i < steps; ++i) {
    const bool counts = i >= 4000;
    if (i % 4 == 0) {
      link.peer->send_datagram(link.at_peer(), Priority::kPose,
                               shared(stamped_pose(link.now_ns, kPoseBytes)));
      link.host->send_datagram(link.at_host(), Priority::kState,
                               shared(stamped_pose(link.now_ns, kPoseStateBytes)));
      poses.sent += counts ? 1 : 0;
      states.sent += counts ? 1 : 0;
    }
    link.step();
    collect(link.host_events, poses, 0, counts);
    collect(link.peer_events, states, 1, counts);
    if (i % 200 == 199 && i >= 4200) {
      poses.fewest = std::min(poses.fewest, window[0]);
      states.fewest = std::min(states.fewest, window[1]);
    }
    if (i % 200 == 199) window[0] = window[1] = 0;
  }
  for (int kind = 0; kind < 2; ++kind) {
    if (ages[kind].empty()) continue;
    std::sort(ages[kind].begin(), ages[kind].end());
    (kind == 0 ? poses : states).age_p99 = ages[kind][ages[kind].size() * 99 / 100];
  }
}

void tell(const char* link, const Arrivals& poses, const Arrivals& states) {
  for (const auto& [kind, a] : {std::pair{"poses", poses}, {"states", states}})
    std::printf("%-28s %-6s %5.1f %% came, fewest in 0.1 s %zu of 50, age p99 %.0f ms\n", link, kind,
                100.0 * static_cast<double>(a.came) / static_cast<double>(a.sent), a.fewest, 1e3 * a.age_p99);
}

double share(const Arrivals& a) {
  return static_cast<double>(a.came) / static_cast<double>(a.sent);
}

TEST(Poses, AreNotHeldBackWhileTheRoundTripIsProbed) {
  for (const double round_trip : {0.1, 0.2, 0.3}) {
    Impairment far;
    far.delay = 0.5 * round_trip;
    VirtualLink link(far, far);
    ASSERT_TRUE(link.connect());
    Arrivals poses, states;
    pose_flow(link, 40.0, poses, states);
    tell(("round trip " + std::to_string(static_cast<int>(1e3 * round_trip)) + " ms").c_str(), poses, states);
    for (const Arrivals& each : {poses, states}) {
      EXPECT_GE(share(each), 0.999);
      EXPECT_GE(each.fewest, 48u);
      EXPECT_LE(each.age_p99, 0.5 * round_trip + 0.005);
    }
  }
}

TEST(Poses, FlowOverALinkThatLosesRepeatsAndReorders) {
  Impairment bad;
  bad.delay = 0.15;
  bad.loss = 0.2;
  bad.reorder = 0.1;
  bad.reorder_delay = 0.03;
  bad.duplicate = 0.05;
  VirtualLink link(bad, bad);
  ASSERT_TRUE(link.connect());
  Arrivals poses, states;
  pose_flow(link, 30.0, poses, states);
  tell("300 ms, 20 % loss", poses, states);
  for (const Arrivals& each : {poses, states}) {
    EXPECT_GE(share(each), 0.78) << "a fifth is the link's";
    EXPECT_GE(each.fewest, 25u);
  }
}

TEST(Poses, DoNotFillTheQueueOfAThinLink) {
  // 250 kB a second want to go where 100 go: what cannot is left out here, and does not grow old in a router.
  Impairment thin;
  thin.delay = 0.02;
  thin.rate = 100e3;
  thin.queue = 256e3;
  Impairment wide;
  wide.delay = 0.02;
  VirtualLink link(thin, wide);
  ASSERT_TRUE(link.connect());
  Arrivals poses, states;
  pose_flow(link, 20.0, poses, states);
  tell("100 kB/s up", poses, states);
  EXPECT_GE(share(poses), 0.3);
  EXPECT_LE(poses.age_p99, 0.4) << "2.6 s is what the queue holds";
  EXPECT_GE(states.fewest, 4u) << "the queue is not theirs: their acknowledgements stand in it";
}

TEST(States, DoNotFillTheQueueOfAThinLink) {
  Impairment thin;
  thin.delay = 0.02;
  thin.rate = 75e3;
  thin.queue = 200e3;
  Impairment wide;
  wide.delay = 0.02;
  VirtualLink link(wide, thin);
  ASSERT_TRUE(link.connect());
  Arrivals poses, states;
  pose_flow(link, 20.0, poses, states);
  tell("75 kB/s down", poses, states);
  EXPECT_GE(share(states), 0.3);
  EXPECT_LE(states.age_p99, 1.3) << "2.7 s is what the queue holds";
  EXPECT_GE(poses.fewest, 4u) << "the queue is not theirs: their acknowledgements stand in it";
}

/// Poses up and states down for so long; how many of either came that were sent since it began.
std::pair<std::size_t, std::size_t> pump(VirtualLink& link, double seconds) {
  const std::int64_t began_ns = link.now_ns;
  std::size_t came[2] = {};
  const int steps = static_cast<int>(seconds * 2000.0);
  for (int i = 0; i < steps; ++i) {
    if (i % 4 == 0) {
      link.peer->send_datagram(link.at_peer(), Priority::kPose,
                               shared(stamped_pose(link.now_ns, kPoseBytes)));
      link.host->send_datagram(link.at_host(), Priority::kState,
                               shared(stamped_pose(link.now_ns, kPoseStateBytes)));
    }
    link.step();
    for (const auto& [events, count] :
         {std::pair{&link.host_events, &came[0]}, {&link.peer_events, &came[1]}}) {
      for (const Bytes& datagram : events->datagrams) {
        std::int64_t sent_ns = 0;
        std::memcpy(&sent_ns, datagram.data(), sizeof(sent_ns));
        *count += sent_ns >= began_ns ? 1 : 0;
      }
      events->datagrams.clear();
    }
  }
  return {came[0], came[1]};
}

/// A link that was dark has lost what was sent, one that stood delivers it all at once: either way congestion
/// control believes that it carries nothing any more.
TEST(Poses, AndStatesFlowAgainAsSoonAsTheLinkDoes) {
  for (const bool dark : {true, false}) {
    for (const double seconds : {0.5, 1.0, 2.0}) {
      Impairment near;
      near.delay = 0.005;
      VirtualLink link(near, near);
      ASSERT_TRUE(link.connect());
      (void)pump(link, 4.0);
      Impairment cut = near;
      cut.loss = dark ? 1.0 : 0.0;
      link.set(cut, cut);
      link.stands = !dark;
      (void)pump(link, seconds);
      link.set(near, near);
      link.stands = false;
      const auto [poses, states] = pump(link, 0.2);
      std::printf("%s for %.1f s, in the 0.2 s after it: %zu poses, %zu states of 100\n",
                  dark ? "dark" : "stood", seconds, poses, states);
      EXPECT_GE(poses, 80u);
      EXPECT_GE(states, 80u);
    }
  }
}

TEST(Losses, AreNotWhatComesLate) {
  // A few come late, and a few overtake all the others, as netem has it.
  for (const auto& [share_late, late] : {std::pair{0.05, 0.01}, {0.05, 0.08}, {0.95, 0.08}}) {
    Impairment link_way;
    link_way.delay = 0.02;
    link_way.reorder = share_late;
    link_way.reorder_delay = late;
    VirtualLink link(link_way, link_way);
    ASSERT_TRUE(link.connect());
    Arrivals poses, states;
    pose_flow(link, 20.0, poses, states);
    const ConnectionStats stats = link.peer->stats(link.at_peer());
    const ConnectionStats down = link.host->stats(link.at_host());
    tell("reordered", poses, states);
    std::printf(
        "%.0f %% late by %.0f ms: %.2f %% of the poses and %.2f %% of the states count as lost\n",
        100.0 * share_late, 1e3 * late,
        100.0 * static_cast<double>(stats.datagrams_lost) / static_cast<double>(stats.datagrams_sent[0]),
        100.0 * static_cast<double>(down.datagrams_lost) / static_cast<double>(down.datagrams_sent[1]));
    EXPECT_LE(static_cast<double>(stats.datagrams_lost),
              0.005 * static_cast<double>(stats.datagrams_sent[0]));
    EXPECT_LE(static_cast<double>(down.datagrams_lost), 0.005 * static_cast<double>(down.datagrams_sent[1]));
  }
}

}  // namespace
}  // namespace slosh::testing
