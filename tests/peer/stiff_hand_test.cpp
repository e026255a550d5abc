// What is written of a scripted hand that holds stiffly: the world's own wrench, whatever the hand, the world
// and the device loop do meanwhile. World, gate and device loop are the real ones, on a clock that the test
// moves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "host/input_gate.h"
#include "net/grip_start.h"
#include "peer/app/hands_tap.h"
#include "peer/haptics/make_device.h"
#include "peer/haptics/script_device.h"
#include "peer/haptics/servo.h"
#include "scenes/sample.h"
#include "tests/physics/lab.h"

namespace slosh {
namespace {

constexpr double kMass = 3.0;  // kg
constexpr double kWeight = kMass * lab::kGravity;
constexpr double kSpacing = 0.02;  // m
constexpr double kSwing = 0.05;    // m, about the middle,
constexpr double kRate = 12.0;     // rad/s: 7.2 m/s² at most, 22 N
constexpr double kTurn = 0.3;      // rad

Scene held_box() {
  lab::SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("tank", lab::tank_at_floor({0.16, 0.16, 0.16}, 0.03));
  const int box = b.add_free("box", make::box({-0.03, -0.02, -0.02}, {0.03, 0.02, 0.02}), kMass,
                             {{0.0, 1.0, 0.0}, {1, 0, 0, 0}});
  b.add_volume(make::box({-0.08, 0.0, -0.08}, {0.08, 0.04, 0.08}));
  b.add_grip(box, 20000.0, 1000.0, 20.0, 0.5, {{0, 0, 0}, {1, 0, 0, 0}});
  b.set_domain({-1.0, -0.5, -1.0}, {1.0, 2.0, 1.0});
  return b.scene;
}

/// Begins at rest, in 0.5 s.
std::vector<PoseKey> swinging(const Pose& start) {
  std::vector<PoseKey> keys;
  for (int i = 0; i <= 2000; ++i) {
    const double t = 0.001 * i;
    const double in = std::min(t / 0.5, 1.0);
    const double s = in * in * (3.0 - 2.0 * in) * std::sin(kRate * t);
    keys.push_back({t,
                    {start.position + glm::dvec3(kSwing * s, 0.0, 0.0),
                     rotate_by(start.orientation, glm::dvec3(0.0, kTurn * s, 0.0))}});
  }
  return keys;
}

class StiffHand : public ::testing::Test {
 protected:
  struct Row {
    double time;
    Wrench wrench;
  };
  Scene scene = held_box();
  std::vector<Row> world_rows;  // each step's
  std::vector<Row> rows;        // what is written
  double dt = 0.0;

  /// Runs for `seconds` of simulated time at `pace` simulated seconds a second; `loop_waits(t)`: s that the
  /// device loop, `world_waits(t)`: s that the world is held up after simulated time t.
  template <class LoopWaits, class WorldWaits>
  void run(double seconds, double pace, LoopWaits&& loop_waits, WorldWaits&& world_waits) {
    World world(scene, sample_scene(scene, kSpacing).value(), make_plan(scene, kSpacing),
                WorldOptions{1, Backend::kCpu});
    dt = world.plan().time_step;
    const Pose start = grip_start(scene, 0);
    world.settle(0.5, std::vector<HandleInput>{{start, Twist{}, true, 1.0}});
    BodySnapshot now;
    world.fill(now);
    std::int64_t clock = to_nanoseconds(1000.0);
    BodyMessage first;
    first.stamp_ns = clock;
    first.time_step = dt;
    first.bodies = now;
    Channel channel(1, first, 1000);
    InputGate gate(scene);
    HandsTap tap(1);
    tap.on_start(world, {});
    ServoOptions options;
    options.steps = &tap.steps();
    std::vector<std::unique_ptr<Device>> devices;
    devices.push_back(std::make_unique<TrackDevice>(PoseTrack(swinging(start), start), "script"));
    Servo servo(scene, std::move(devices), channel, options);
    servo.tick(clock);

    const double interval = dt / pace;  // s a step
    std::int64_t step_ns = clock + to_nanoseconds(interval);
    std::int64_t tick_ns = clock + 1'000'000;
    world_rows.push_back({now.time, now.grips[0].on_hand});
    while (now.time < seconds) {
      clock = std::min(step_ns, tick_ns);
      if (clock == tick_ns) {
        servo.tick(clock);
        tick_ns += 1'000'000 + to_nanoseconds(loop_waits(now.time));
        continue;
      }
      world.step(gate.take(channel, now, clock));
      world.fill(now);
      world_rows.push_back({now.time, now.grips[0].on_hand});
      tap.after_step(world);
      step_ns += to_nanoseconds(interval + world_waits(now.time));
      BodyMessage& message = channel.bodies().back();
      message.time_step = dt;
      message.rate = pace;
      message.stamp_ns = pace < 1.0 ? clock : clock + to_nanoseconds(dt);  // as Host has it
      message.bodies = now;
      channel.bodies().publish();
    }
    servo.let_go();
    ServoSample sample;
    while (servo.samples().pop(sample)) rows.push_back({sample.time, sample.on_hand});
  }

  /// The world's wrench at a time between its steps.
  Wrench world_at(double time) const {
    const double at = time / dt;
    const std::size_t i = std::min(static_cast<std::size_t>(at), world_rows.size() - 2);
    const double later = at - static_cast<double>(i);
    const Wrench& a = world_rows[i].wrench;
    const Wrench& b = world_rows[i + 1].wrench;
    return {a.force + later * (b.force - a.force), a.torque + later * (b.torque - a.torque)};
  }

  struct Error {
    double force = 0.0, torque = 0.0;            // the largest difference
    double most_force = 0.0, most_torque = 0.0;  // of the world's
    double least = 1e9;                          // N written
  };
  Error compare(double from, double to) const {
    Error e;
    for (const Row& row : rows) {
      if (row.time < from || row.time > to) continue;
      const Wrench truth = world_at(row.time);
      e.force = std::max(e.force, glm::length(row.wrench.force - truth.force));
      e.torque = std::max(e.torque, glm::length(row.wrench.torque - truth.torque));
      e.most_force = std::max(e.most_force, glm::length(truth.force));
      e.most_torque = std::max(e.most_torque, glm::length(truth.torque));
      e.least = std::min(e.least, glm::length(row.wrench.force));
    }
    std::printf("%zu rows: force off by %.4f of %.2f N, torque by %.6f of %.4f N·m, least force %.2f N\n",
                rows.size(), e.force, e.most_force, e.torque, e.most_torque, e.least);
    return e;
  }
};

constexpr auto kNever = [](double) { return 0.0; };

TEST_F(StiffHand, IsWrittenAsTheWorldHasItWhileItAccelerates) {
  run(1.8, 1.0, kNever, kNever);
  const Error e = compare(0.0, 1.7);
  EXPECT_GT(e.most_force, 1.15 * kWeight) << "it does accelerate";
  EXPECT_LT(e.force, 0.001 * e.most_force);
  EXPECT_LT(e.torque, 0.001 * e.most_torque);
  EXPECT_NEAR(static_cast<double>(rows.size()), 1.8 / 0.002, 5.0) << "a row each 2 ms";
}

TEST_F(StiffHand, IsWrittenAsTheWorldHasItWhenTheDeviceLoopIsHeldUp) {
  run(1.8, 1.0, [](double t) { return std::fmod(t, 0.1) < 0.002 ? 0.006 : 0.0; }, kNever);
  const Error e = compare(0.0, 1.7);
  EXPECT_LT(e.force, 0.001 * e.most_force);
  EXPECT_LT(e.torque, 0.001 * e.most_torque);
}

TEST_F(StiffHand, IsWrittenAsTheWorldHasItWhenTheWorldIsSlow) {
  // A twentieth of real time, and now and then a step that takes half a second: to a device the force would
  // fade.
  run(0.6, 0.05, kNever, [&](double t) { return std::fmod(t, 0.1) < dt ? 0.5 : 0.0; });
  const Error e = compare(0.0, 0.55);
  EXPECT_LT(e.force, 0.001 * e.most_force);
  EXPECT_LT(e.torque, 0.001 * e.most_torque);
  EXPECT_GT(e.least, 0.9 * kWeight) << "no row in which it weighs nothing";
}

}  // namespace
}  // namespace slosh
