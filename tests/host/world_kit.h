// A stirred tank under a host, for tests: no file, no sampling, no clock.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "host/host.h"
#include "scenes/load.h"
#include "scenes/sample.h"
#include "tests/support/places.h"

namespace slosh::testing {

/// The shipped probe at its coarsest: a scene that can be packed, sampled and run again.
struct SmallWorld {
  Scene scene;
  SampledScene sampled;
  Plan plan;

  SmallWorld() {
    scene = load_scene(find_scene("probe").value()).value();
    sampled = sample_scene(scene, scene.spacing_max).value();
    plan = make_plan(scene, scene.spacing_max);
  }
  World world(int threads = 1) const { return World(scene, sampled, plan, WorldOptions{threads}); }
};

/// Sampling takes most of a second: once for all tests of a program.
inline const SmallWorld& small_world() {
  static const SmallWorld world;
  return world;
}

/// Moves the hand itself, at each step, so that an unpaced run is the same again.
class Stirrer : public HostTap {
 public:
  Stirrer(Channel& channel, const Pose& from) : channel_(channel), from_(from) {}
  void on_start(const World& world, const HostState&) override { post(world); }
  void after_step(const World& world) override { post(world); }
  void after_change(const World& world, const HostCommand&, const HostState&) override { post(world); }

 private:
  void post(const World& world) {
    const double t = world.time();
    PoseMessage m;
    m.engaged = t < 0.35;
    m.time = t;
    m.pose = from_;
    m.pose.position += 0.01 * glm::dvec3(std::sin(9.0 * t), 0.5 * std::cos(7.0 * t) - 0.5, 0.0);
    m.stamp_ns = static_cast<std::int64_t>(world.tick()) * 1'000'000;
    channel_.pose(0).back() = m;
    channel_.pose(0).publish();
  }
  Channel& channel_;
  Pose from_;
};

/// A host, its channel and a hand.
struct Rig {
  Channel channel;
  Host host;
  Stirrer stirrer;
  Rig(World made, HostOptions options)
      : channel(small_world().scene.grips.size(), initial_message(made, options.run), 64 << 20),
        host(std::move(made), small_world().scene, channel, unpaced(std::move(options))),
        stirrer(channel, small_world_grip()) {
    host.add_tap(stirrer);
  }
  explicit Rig(HostOptions options) : Rig(small_world().world(), std::move(options)) {}
  void run() {
    host.start();
    host.wait();
  }
  static Pose small_world_grip() {
    BodySnapshot bodies;
    small_world().world().fill(bodies);
    return bodies.grips[0].pose;
  }
  static HostOptions unpaced(HostOptions options) {
    options.paced = false;
    options.snapshot_rate = 0.0;
    return options;
  }
};

/// Does something at a tick, on the host's thread.
class AtTick : public HostTap {
 public:
  AtTick(std::uint64_t tick, std::function<void()> what) : tick_(tick), what_(std::move(what)) {}
  void after_step(const World& world) override {
    if (!done_ && world.tick() == tick_) {
      done_ = true;
      what_();
    }
  }

 private:
  std::uint64_t tick_;
  std::function<void()> what_;
  bool done_ = false;
};

/// An empty folder named after the current test.
inline std::filesystem::path fresh_folder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder =
      test::build_dir() / "test_files" / "keep" / (std::string(test->test_suite_name()) + "." + test->name());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace slosh::testing
