// The authoritative loop on a shipped scene, unpaced: nothing here waits for or asserts a wall time.
#include "host/host.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "scenes/load.h"
#include "scenes/sample.h"

namespace slosh {
namespace {

class HostTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Result<std::filesystem::path> file = find_scene("probe");
    ASSERT_TRUE(file) << file.error().text();
    Result<Scene> loaded = load_scene(file.value());
    ASSERT_TRUE(loaded) << loaded.error().text();
    scene = std::move(loaded.value());
    Result<SampledScene> result = sample_scene(scene, scene.spacing_max);
    ASSERT_TRUE(result) << result.error().text();
    sampled = std::move(result.value());
    plan = make_plan(scene, scene.spacing_max);
  }

  World world() const { return World(scene, sampled, plan, WorldOptions{1}); }

  /// A host with its channel; the hands are where `place` says, for the whole run.
  struct Rig {
    Channel channel;
    Host host;
    Rig(const HostTest& test, World made, HostOptions options)
        : channel(test.scene.grips.size(), initial_message(made), 64 << 20),
          host(std::move(made), test.scene, channel, options) {}
  };
  std::unique_ptr<Rig> rig(HostOptions options) const {
    options.paced = false;
    return std::make_unique<Rig>(*this, world(), std::move(options));
  }
  void hold(Channel& channel) const {
    PoseMessage m;
    m.engaged = true;
    m.pose = channel.bodies().front().bodies.grips[0].pose;
    channel.pose(0).back() = m;
    channel.pose(0).publish();
  }

  Scene scene;
  SampledScene sampled;
  Plan plan;
};

TEST_F(HostTest, RunsForTheTimeAskedAndReportsIt) {
  HostOptions options;
  options.until = 0.1;
  const auto r = rig(options);
  hold(r->channel);
  r->host.start();
  r->host.wait();
  EXPECT_FALSE(r->host.running());
  const HostReport& report = r->host.report();
  const auto expected = static_cast<std::uint64_t>(std::llround(0.1 / plan.time_step));
  EXPECT_EQ(report.steps, expected);
  EXPECT_EQ(report.step_time.count(), expected);
  EXPECT_NEAR(report.simulated, 0.1, plan.time_step);
  EXPECT_GT(report.wall, 0.0);
  EXPECT_GT(report.total.total, 0.0);
  EXPECT_EQ(report.rejected_poses, 0u);
  EXPECT_EQ(report.status & kStatusInputRejected, 0u);
  EXPECT_NEAR(report.diagnostics.mass, report.start.mass, 1e-6 * report.start.mass);
}

TEST_F(HostTest, PublishesSnapshotsAtTheRateOfSimulatedTime) {
  HostOptions options;
  options.until = 0.2;
  options.snapshot_rate = 50.0;
  const auto r = rig(options);
  r->host.start();
  r->host.wait();
  SnapshotQueue& snapshots = r->channel.snapshots();
  double expected = 0.0;
  int count = 0;
  while (SnapshotPointer snapshot = snapshots.pop(std::chrono::milliseconds(0))) {
    EXPECT_NEAR(snapshot->rigid.time, expected, plan.time_step);
    EXPECT_EQ(snapshot->positions.size(), sampled.fluid_positions.size());
    expected += 0.02;
    count += 1;
  }
  EXPECT_EQ(count, 11);
  EXPECT_TRUE(snapshots.finished());
}

TEST_F(HostTest, PublishesNoSnapshotWithoutAViewer) {
  HostOptions options;
  options.until = 0.05;
  options.snapshot_rate = 0.0;
  const auto r = rig(options);
  r->host.start();
  r->host.wait();
  EXPECT_EQ(r->host.report().snapshots, 0u);
  EXPECT_TRUE(r->channel.snapshots().finished());
}

TEST_F(HostTest, PublishesTheBodiesAfterEveryTick) {
  HostOptions options;
  options.until = 0.02;
  const auto r = rig(options);
  r->host.start();
  r->host.wait();
  ASSERT_TRUE(r->channel.bodies().update());
  const BodyMessage& last = r->channel.bodies().front();
  EXPECT_EQ(last.bodies.tick, r->host.report().steps);
  EXPECT_EQ(last.bodies.bodies.size(), scene.bodies.size());
  EXPECT_EQ(last.time_step, plan.time_step);
  EXPECT_EQ(last.rate, 0.0) << "the world has stopped, and says so";
}

TEST_F(HostTest, ABadPoseSetsAStatusAndTheWorldStaysFinite) {
  HostOptions options;
  options.until = 0.02;
  const auto r = rig(options);
  PoseMessage m;
  m.engaged = true;
  m.pose.position.x = std::numeric_limits<double>::quiet_NaN();
  r->channel.pose(0).back() = m;
  r->channel.pose(0).publish();
  r->host.start();
  r->host.wait();
  EXPECT_EQ(r->host.report().rejected_poses, 1u);
  EXPECT_NE(r->host.report().status & kStatusInputRejected, 0u);
  EXPECT_EQ(r->host.report().status & kStatusNonFinite, 0u);
  ASSERT_TRUE(r->channel.bodies().update());
  for (const BodyState& body : r->channel.bodies().front().bodies.bodies) {
    EXPECT_TRUE(std::isfinite(glm::length(body.pose.position)));
  }
}

TEST_F(HostTest, TheSameInputGivesTheSameWorld) {
  HostOptions options;
  options.until = 0.1;
  std::uint64_t hashes[2];
  for (std::uint64_t& hash : hashes) {
    const auto r = rig(options);
    hold(r->channel);
    r->host.start();
    r->host.wait();
    hash = r->host.world().hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(HostTest, StopsWhenAskedAndGoesOnAfterAPause) {
  HostOptions options;  // no end
  const auto r = rig(options);
  r->host.pause(true);
  r->host.start();
  EXPECT_TRUE(r->host.running());
  EXPECT_EQ(r->host.progress().tick, 0u) << "paused from the start";
  r->host.pause(false);
  while (r->host.progress().tick < 10) std::this_thread::yield();
  r->host.request_stop();
  r->host.wait();
  EXPECT_FALSE(r->host.running());
  EXPECT_GE(r->host.report().steps, 10u);
}

TEST_F(HostTest, AWorldThatStandsTakesTheStepsThatAreAskedAndShowsEach) {
  const auto r = rig(HostOptions{});
  hold(r->channel);
  r->host.pause(true);
  r->host.start();
  for (const int steps : {1, 3}) {
    const std::uint64_t before = r->host.progress().tick;
    r->host.step_standing(steps);
    while (r->host.progress().tick < before + static_cast<std::uint64_t>(steps)) std::this_thread::yield();
  }
  EXPECT_TRUE(r->host.progress().paused) << "and stands again";
  r->host.request_stop();
  r->host.wait();
  EXPECT_EQ(r->host.report().steps, 4u);
  EXPECT_EQ(r->host.report().snapshots, 5u) << "one of each, and the first of the run";
  ASSERT_TRUE(r->channel.bodies().update());
  EXPECT_EQ(r->channel.bodies().front().rate, 0.0) << "hands do not carry on a world that stands";
}

TEST_F(HostTest, StepsAskedOfAWorldThatRunsAreNotTakenLater) {
  const auto r = rig(HostOptions{});
  hold(r->channel);
  r->host.start();
  r->host.step_standing(1000000);
  while (r->host.progress().tick < 10) std::this_thread::yield();
  std::future<Result<bool>> paused = r->host.ask({HostAction::kPause});
  ASSERT_TRUE(paused.get());
  const std::uint64_t tick = r->host.progress().tick;
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_LE(r->host.progress().tick, tick + 1);
  r->host.request_stop();
  r->host.wait();
}

TEST_F(HostTest, ABodyThatLeavesTheWorldIsToldOnceARunWithItsNameAndPlace) {
  for (Body& body : scene.bodies) {
    if (body.point_probe) body.twist.linear = {6.0, 3.0, 0.0};
  }
  struct Listener : HostTap {
    void on_gone_body(std::size_t, const std::string& words) override { told.push_back(words); }
    std::vector<std::string> told;
  } listener;
  HostOptions options;
  options.until = 2.0;
  const auto r = rig(options);
  r->host.add_tap(listener);
  r->host.start();
  r->host.wait();
  ASSERT_EQ(listener.told.size(), 1u);
  EXPECT_EQ(r->host.report().gone, listener.told);
  EXPECT_EQ(listener.told[0].rfind("'probe' left the world at ", 0), 0u) << listener.told[0];
  EXPECT_NE(r->host.report().status & kStatusBodyGone, 0u);
}

TEST_F(HostTest, AtASlowPaceTheWorldTakesItsTime) {
  HostOptions options;
  options.until = 0.05;
  Rig slow(*this, world(), options);
  hold(slow.channel);
  slow.host.set_pace(0.25);
  slow.host.start();
  slow.host.wait();
  EXPECT_NEAR(slow.host.report().simulated, 0.05, plan.time_step);
  EXPECT_GT(slow.host.report().wall, 0.19)
      << "s: four times the simulated time at least, whatever the machine does";
  Rig r(*this, world(), HostOptions{});
  r.host.set_pace(1e-9);
  EXPECT_EQ(r.host.pace(), kSlowestPace);
  r.host.set_pace(7.0);
  EXPECT_EQ(r.host.pace(), 1.0);
}

}  // namespace
}  // namespace slosh
