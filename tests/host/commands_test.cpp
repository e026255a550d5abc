// What a host does on command, while it runs and while it stands still.
#include <gtest/gtest.h>

#include "tests/host/world_kit.h"

namespace slosh {
namespace {

using testing::AtTick;
using testing::Rig;
using testing::small_world;

HostOptions until(double time) {
  HostOptions options;
  options.until = time;
  return options;
}

/// What a host said between steps, in order.
class Log : public HostTap {
 public:
  void after_change(const World& world, const HostCommand& change, const HostState& s) override {
    changes.push_back(change.action);
    ticks.push_back(world.tick());
    state = s;
  }
  void before_step(const World& world, const StepInput& input) override {
    steps += 1;
    EXPECT_EQ(input.hands.size(), 1u);
    EXPECT_EQ(input.poses.size(), 1u);
    EXPECT_EQ(input.poses[0].stamp_ns, static_cast<std::int64_t>(world.tick()) * 1'000'000);
  }
  void after_publish() override { published += 1; }
  std::vector<HostAction> changes;
  std::vector<std::uint64_t> ticks;
  HostState state;
  int steps = 0;
  int published = 0;
};

TEST(HostCommands, AResetLeadsBackToTheStartToTheBit) {
  Rig once(until(0.2));
  once.run();
  Rig again(until(0.2));
  Log log;
  again.host.add_tap(log);
  AtTick halfway(17, [&] { again.host.post({HostAction::kReset}); });
  again.host.add_tap(halfway);
  again.run();
  EXPECT_EQ(again.host.world().hash(), once.host.world().hash());
  EXPECT_EQ(again.host.report().steps, once.host.report().steps + 17) << "the report goes on";
  EXPECT_EQ(again.host.progress().run, 1u);
  ASSERT_EQ(log.changes, std::vector<HostAction>{HostAction::kReset});
  EXPECT_EQ(log.ticks[0], 0u);
  EXPECT_EQ(log.state.run, 1u);
  ASSERT_TRUE(again.channel.bodies().update());
  EXPECT_EQ(again.channel.bodies().front().run, 1u);
  EXPECT_GE(log.published, log.steps);
}

TEST(HostCommands, KeepTheirOrderAndAnswer) {
  HostOptions options = until(0.05);
  options.paused = true;
  Rig rig(options);
  Log log;
  rig.host.add_tap(log);
  auto thick = rig.host.ask({HostAction::kViscosity, 0, 1e9});
  auto none = rig.host.ask({HostAction::kViscosity, 99, 0.001});
  auto light = rig.host.ask({HostAction::kGravityScale, 0, 0.5});
  auto soft = rig.host.ask({HostAction::kGripStiffness, 0, 0.5});
  auto nobodys = rig.host.ask({HostAction::kGripStiffness, 7, 0.5});
  auto reset = rig.host.ask({HostAction::kReset});
  rig.host.start();
  const Result<bool> answer = thick.get();
  ASSERT_FALSE(answer);
  EXPECT_NE(answer.error().text().find("will do"), std::string::npos) << answer.error().text();
  EXPECT_FALSE(none.get());
  EXPECT_TRUE(light.get());
  EXPECT_TRUE(soft.get());
  EXPECT_FALSE(nobodys.get());
  EXPECT_TRUE(reset.get());
  EXPECT_EQ(rig.host.progress().tick, 0u);
  EXPECT_TRUE(rig.host.progress().paused);
  EXPECT_TRUE(rig.host.ask({HostAction::kContinue}).get());
  rig.host.wait();
  EXPECT_EQ(log.changes, (std::vector<HostAction>{HostAction::kGravityScale, HostAction::kGripStiffness,
                                                  HostAction::kReset, HostAction::kContinue}));
  EXPECT_EQ(log.state.grip_stiffness, std::vector<double>{0.5}) << "a reset leaves it";
  EXPECT_EQ(log.state.gravity_scale, 0.5) << "a reset leaves the parameters";
  EXPECT_EQ(rig.host.world().gravity_scale(), 0.5);
  const Result<bool> late = rig.host.ask({HostAction::kReset}).get();
  ASSERT_FALSE(late);
  EXPECT_NE(late.error().text().find("ended"), std::string::npos);
}

TEST(HostCommands, ThatNobodyCameToGetAnAnswerToo) {
  std::future<Result<bool>> answer;
  {
    HostOptions options = until(1e9);
    Rig rig(options);
    AtTick stop(5, [&] {
      rig.host.request_stop();
      answer = rig.host.ask({HostAction::kReset});
    });
    rig.host.add_tap(stop);
    rig.run();
  }
  EXPECT_FALSE(answer.get());
}

TEST(HostCommands, APausedHostPublishesAndTellsWhoListens) {
  HostOptions options = until(1e9);
  Rig rig(options);
  Log log;
  rig.host.add_tap(log);
  rig.host.start();
  EXPECT_TRUE(rig.host.ask({HostAction::kPause}).get());
  const std::uint64_t tick = rig.host.progress().tick;
  EXPECT_TRUE(rig.host.ask({HostAction::kReset}).get());
  EXPECT_EQ(rig.host.progress().tick, 0u);
  rig.channel.bodies().update();
  EXPECT_EQ(rig.channel.bodies().front().rate, 0.0);
  rig.host.request_stop();
  rig.host.wait();
  EXPECT_EQ(rig.host.report().steps, static_cast<std::uint64_t>(log.steps));
  EXPECT_EQ(static_cast<std::uint64_t>(log.steps), tick);
}

TEST(HostCommands, ARestoredWorldGoesOnAndResetsToItsOwnStart) {
  Rig whole(until(0.2));
  whole.run();
  std::vector<std::uint8_t> middle;
  Rig first(until(0.1));
  first.run();
  ASSERT_TRUE(first.host.world().save(middle));
  const auto carry_on = [&] {
    World world = small_world().world();
    EXPECT_TRUE(world.restore(middle));
    HostOptions options = until(0.2);
    options.run = 4;
    options.start_state = first.host.start_state();
    return std::make_unique<Rig>(std::move(world), options);
  };
  const auto rest = carry_on();
  rest->run();
  // The hand's coupling re-engages, so only the world's time and the run's number are told from this.
  EXPECT_EQ(rest->host.progress().tick, whole.host.progress().tick);
  EXPECT_EQ(rest->host.progress().run, 4u);
  EXPECT_NEAR(rest->host.report().simulated, 0.1, 2 * small_world().plan.time_step);
  const auto back = carry_on();
  AtTick reset(60, [&] { back->host.post({HostAction::kReset}); });
  back->host.add_tap(reset);
  back->run();
  EXPECT_EQ(back->host.progress().run, 5u);
  EXPECT_EQ(back->host.world().hash(), whole.host.world().hash());
}

/// A host that has snapshots to show.
struct Shown {
  SnapshotDemand demand;
  Channel channel;
  Host host;
  explicit Shown(HostOptions options)
      : channel(small_world().scene.grips.size(), initial_message(small_world().world(), 0), 64 << 20),
        host(small_world().world(), small_world().scene, channel, with_snapshots(std::move(options))) {}
  HostOptions with_snapshots(HostOptions options) {
    options.demand = &demand;
    options.paced = false;
    options.snapshot_rate = 60.0;
    options.shell = true;
    return options;
  }
  std::size_t drain() {
    std::size_t count = 0;
    while (channel.snapshots().pop(std::chrono::milliseconds(0))) count += 1;
    return count;
  }
};

TEST(HostSnapshots, AreMadeOnlyWhileSomebodyLooks) {
  Shown watched(until(1.0));
  watched.host.start();
  watched.host.wait();
  EXPECT_NEAR(static_cast<double>(watched.drain()), 60.0, 2.0);

  Shown alone(until(1.0));
  alone.demand.want(false);
  alone.host.start();
  alone.host.wait();
  EXPECT_EQ(alone.host.report().snapshots, 1u) << "the first of the run";
  EXPECT_EQ(alone.drain(), 1u);
  std::printf("1 s: %llu snapshots watched, %llu alone\n",
              static_cast<unsigned long long>(watched.host.report().snapshots),
              static_cast<unsigned long long>(alone.host.report().snapshots));
}

TEST(HostSnapshots, WhoBeginsToLookAtAStandingWorldSeesIt) {
  Shown rig(until(1e9));
  rig.demand.want(false);
  rig.host.start();
  ASSERT_TRUE(rig.host.ask({HostAction::kPause}).get());
  ASSERT_EQ(rig.drain(), 1u);
  const std::uint64_t tick = rig.host.progress().tick;
  rig.demand.want(true);
  const SnapshotPointer seen = rig.channel.snapshots().pop(std::chrono::seconds(20));
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->rigid.tick, tick);
  rig.demand.want(true);
  EXPECT_FALSE(rig.channel.snapshots().pop(std::chrono::milliseconds(100))) << "once";
  rig.demand.want(false);
  ASSERT_TRUE(rig.host.ask({HostAction::kReset}).get());
  EXPECT_TRUE(rig.channel.snapshots().pop(std::chrono::seconds(20))) << "each run begins with one";
  rig.host.request_stop();
  rig.host.wait();
}

}  // namespace
}  // namespace slosh
