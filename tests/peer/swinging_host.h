// A host far away with a held body in which fluid swings, as its words say it: made up, a word each 2 ms.
#pragma once

#include <cmath>
#include <numbers>

#include "net/channel.h"
#include "peer/haptics/device.h"
#include "peer/replica/slosh_mode.h"
#include "scenes/scene.h"
#include "servo_kit.h"

namespace slosh::test {

/// A body of 0.8 kg with 2 kg of fluid that hangs in one hand and is led to and fro by two sines.
class SwingingHost {
 public:
  static constexpr double kPace = 2.0 * std::numbers::pi * 2.2;  // rad/s
  static constexpr double kRoundTrip = 0.1;                      // s

  SwingingHost() {
    scene = one_grip_scene();
    scene.gravity = {0.0, -9.81, 0.0};
    scene.bodies[0].motion = BodyMotion::kFree;
    scene.bodies[0].mass.mass = kBody;
    scene.bodies[0].mass.inertia = glm::dmat3(1e-3);
  }

  Scene scene;

  /// The state at `ms` with the hand's reading of a round trip before; in order.
  BodyMessage word(int ms) {
    const double t = 0.001 * ms, v = speed(t);
    const double elapsed = t - time_;
    BodyMessage message = ServoKit::first();
    message.stamp_ns = to_nanoseconds(t);
    message.rate = 1.0;
    message.time_step = kWord;
    message.heard_pose_ns = to_nanoseconds(std::max(t - kRoundTrip, 0.001));
    message.bodies.tick = static_cast<std::uint64_t>(ms / 2);
    message.bodies.time = t;
    if (ms % 2 == 0 && elapsed > 0.0) {
      const SloshState was = swings_;
      swings_ = SloshStep(kMode.pace, kMode.damping, elapsed)(was, v - before_);
      const double a = (v - before_) / elapsed;
      const double swing = 0.5 * (slosh_force(kMode, was) + slosh_force(kMode, swings_));
      fluid_ = {swing - (kFluid - kMode.mass) * a, -kFluid * 9.81, 0.0};
      on_hand_ = fluid_ + glm::dvec3(-kBody * a, -kBody * 9.81, 0.0);
      time_ = t;
      before_ = v;
    }
    BodyState& body = message.bodies.bodies[0];
    body.center_of_mass.x = body.pose.position.x = place(t);
    body.twist.linear.x = v;
    body.fluid.force = fluid_;
    GripState& grip = message.bodies.grips[0];
    grip.pose = body.pose;
    grip.twist = body.twist;
    grip.handle = hand(ms).pose;
    grip.on_hand.force = on_hand_;
    HandWord& said = message.hands.emplace_back();
    said.number = message.bodies.tick;
    said.read_ns = message.heard_pose_ns;
    said.time = t - kWord;
    said.counted = true;
    FluidWrenchModel& model = message.fluid_models.emplace_back();
    model.body = 0;
    model.tick = message.bodies.tick;
    for (std::size_t i = 0; i < 3; ++i) {
      model.added_mass[i][i] = kFluid - kMode.mass;
      model.d_velocity[i][i] = -0.5;
    }
    return message;
  }

  /// As far from the grip as it takes to carry and to lead it.
  DeviceReport hand(int ms) const {
    const double t = 0.001 * ms;
    DeviceReport report;
    report.pose.position.x = place(t);
    report.pose.position -= on_hand_ / scene.grips[0].stiffness;
    report.twist.linear.x = speed(t);
    return report;
  }

 private:
  static constexpr double kWord = 0.002;              // s
  static constexpr double kBody = 0.8, kFluid = 2.0;  // kg
  static constexpr SloshMode kMode{0.86, kPace, 0.03};

  static double speed(double t) {
    const double angle = 2.0 * std::numbers::pi * t;
    return 0.1 * (std::sin(0.9 * angle) + std::sin(1.9 * angle));
  }
  static double place(double t) {
    const double full = 2.0 * std::numbers::pi;
    return 0.1 * ((1.0 - std::cos(0.9 * full * t)) / (0.9 * full) +
                  (1.0 - std::cos(1.9 * full * t)) / (1.9 * full));
  }

  SloshState swings_;
  glm::dvec3 fluid_{0.0, -kFluid * 9.81, 0.0};
  glm::dvec3 on_hand_{0.0, -(kFluid + kBody) * 9.81, 0.0};
  double time_ = 0.0, before_ = 0.0;
};

}  // namespace slosh::test
