#include <gtest/gtest.h>

#include "net/clock.h"
#include "peer/remote/remote_status.h"
#include "scripted_host.h"

namespace slosh {
namespace {

TEST(RemoteStatus, SaysWhoIsHere) {
  RemoteStatus status;
  status.welcome.peer = 1;
  status.peers = {{0, "Ana", wire::Role::kParticipant, true, {0, 9}},
                  {1, "Ben", wire::Role::kParticipant, true, {}},
                  {2, "Cyd", wire::Role::kSpectator, false, {}}};
  EXPECT_EQ(people_text(status, {"left", "right"}), "Ana: left\nBen (you)\nCyd (away) looks on")
      << "a grip that the scene has not is left out";
  EXPECT_EQ(others_here(status), 1u) << "Ana: neither oneself nor who is away";
}

TEST(RemoteStatus, ALongListIsCut) {
  RemoteStatus status;
  for (std::uint32_t i = 0; i < 100; ++i) status.peers.push_back({i, "P", wire::Role::kSpectator, true, {}});
  EXPECT_NE(people_text(status, {}).find("and 92 more"), std::string::npos);
}

TEST(RemoteStatus, SaysHowTheNetworkIs) {
  RemoteStatus status;
  status.state = LinkState::kLive;
  status.numbers.round_trip = 0.061;
  EXPECT_NE(connection_text(status, 0.034, 0).find("rtt 61 ms"), std::string::npos);
  EXPECT_NE(connection_text(status, 0.034, 0).find("pictures 34 ms behind"), std::string::npos);
  status.state = LinkState::kReconnecting;
  status.lost_ns = 0;
  EXPECT_EQ(connection_text(status, 0.0, 3 * kNanosecondsPerSecond), "contact lost, reconnecting for 3 s");
}

TEST(RemoteStatus, SaysWhereTheHostsTaskIs) {
  test::Together both;
  ASSERT_TRUE(both.run_until(LinkState::kLive));
  EXPECT_EQ(both.status().task, TaskLines{});
  both.host.say(wire::Task{"step 2 of 3", "Pour.", "0.1 kg", "Slowly."});
  ASSERT_TRUE(both.run(1.0, [&] { return !both.status().task.title.empty(); }));
  EXPECT_EQ(both.status().task, (TaskLines{"step 2 of 3", "Pour.", "0.1 kg", "Slowly."}));
}

}  // namespace
}  // namespace slosh
