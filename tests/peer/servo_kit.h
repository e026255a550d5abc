// A one-grip scene and a channel, without a world: the servo against made-up body states.
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "net/clock.h"
#include "peer/haptics/servo.h"

namespace slosh::test {

constexpr double kTick = 0.002;  // the made-up world's time step

/// Reports what the test sets, remembers what it was sent.
class FakeDevice final : public Device {
 public:
  DeviceReport next;
  DeviceLimits limit = limits_without_a_hand();
  Wrench last;
  double last_time = -1.0;
  bool with_world = false;
  bool feels = true;

  DeviceReport read(const DeviceMoment& moment) noexcept override {
    last_time = moment.time;
    return next;
  }
  void write(const Wrench& on_hand) noexcept override { last = on_hand; }
  DeviceLimits limits() const override { return limit; }
  bool immediate() const override { return true; }
  bool goes_with_world() const override { return with_world; }
  bool gives_way() const override { return feels; }
  std::string kind() const override { return "fake"; }
};

inline Pose at(double x) {
  Pose pose;
  pose.position.x = x;
  return pose;
}

inline Scene one_grip_scene() {
  Scene scene;
  scene.bodies.resize(1);
  Grip grip;
  grip.name = "grip";
  grip.body = 0;
  grip.stiffness = 1000.0;
  grip.damping = 20.0;
  grip.rotational_stiffness = 10.0;
  grip.rotational_damping = 0.2;
  scene.grips.push_back(grip);
  return scene;
}

struct ServoKit {
  Scene scene = one_grip_scene();
  Channel channel{1, first(), 1 << 20};
  FakeDevice* device = nullptr;
  std::unique_ptr<Servo> servo;
  bool stands = false;  // BodyMessage::stands_until_felt

  explicit ServoKit(DeviceLimits limits = limits_without_a_hand(), ServoOptions options = {}) {
    auto made = std::make_unique<FakeDevice>();
    made->limit = limits;
    device = made.get();
    std::vector<std::unique_ptr<Device>> devices;
    devices.push_back(std::move(made));
    servo = std::make_unique<Servo>(scene, std::move(devices), channel, options);
  }

  static BodyMessage first() {
    BodyMessage message;
    message.time_step = kTick;
    message.bodies.bodies.resize(1);
    message.bodies.grips.resize(1);
    return message;
  }

  /// A body state of simulated time `time`, published at the same wall time. `heard`: s, when the newest of
  /// our poses was read that a host far away heard, 0 = none; less: it is in this process.
  void publish(double time, const Pose& grip = {}, const Twist& twist = {}, double rate = 1.0,
               double heard = -1.0) {
    BodyMessage& message = channel.bodies().back();
    message = first();
    message.stamp_ns = to_nanoseconds(time);
    message.rate = rate;
    message.heard_pose_ns = heard < 0.0 ? kPoseNotTold : to_nanoseconds(heard);
    message.stands_until_felt = stands;
    message.bodies.tick = static_cast<std::uint64_t>(std::lround(time / kTick));
    message.bodies.time = time;
    message.bodies.grips[0].pose = grip;
    message.bodies.grips[0].twist = twist;
    channel.bodies().publish();
  }
  void tick(double wall) { servo->tick(to_nanoseconds(wall)); }
};

/// A world that stands still, as its `tick`-th state, a state a millisecond: stamped ahead, so that none is
/// ever old however late the machine is.
inline void publish_ahead(Channel& channel, int tick,
                          std::vector<GripState> grips = std::vector<GripState>(2)) {
  BodyMessage& message = channel.bodies().back();
  message = ServoKit::first();
  message.bodies.grips = std::move(grips);
  message.rate = 1.0;
  message.bodies.tick = static_cast<std::uint64_t>(tick);
  message.bodies.time = 0.001 * tick;
  message.stamp_ns = steady_now_ns() + to_nanoseconds(10.0);
  channel.bodies().publish();
}

/// A channel for two hands; from then on `scene` has its grip twice.
inline std::unique_ptr<Channel> channel_of_two(Scene& scene) {
  scene.grips.push_back(scene.grips[0]);
  BodyMessage first = ServoKit::first();
  first.bodies.grips.resize(2);
  return std::make_unique<Channel>(2, first, 1000);
}

}  // namespace slosh::test
