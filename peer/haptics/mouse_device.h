// A mouse as a haptic device: it moves the handle, and feels nothing.
#pragma once

#include <memory>

#include "net/triple_buffer.h"
#include "peer/haptics/device.h"

namespace slosh {

/// Where the mouse wants the handle. Written by the window's thread, read by the device loop.
using MouseTarget = TripleBuffer<Pose>;

/// Follows the target as a critically damped second-order system: a mouse reports some 60 times a second in
/// steps, and the loop wants a pose and a velocity without jumps at 1 kHz.
class MouseDevice final : public Device {
 public:
  MouseDevice(std::shared_ptr<MouseTarget> target, const Pose& start)
      : target_(std::move(target)), wanted_(start), pose_(start) {}

  DeviceReport read(const DeviceMoment& moment) noexcept override {
    if (target_->update()) wanted_ = target_->front();
    const double dt = moment.period;
    const double w = kFollow;
    const glm::dvec3 gap = wanted_.position - pose_.position;
    const glm::dvec3 turn = rotation_between(pose_.orientation, wanted_.orientation);
    twist_.linear += dt * (w * w * gap - 2.0 * w * twist_.linear);
    twist_.angular += dt * (w * w * turn - 2.0 * w * twist_.angular);
    pose_.position += dt * twist_.linear;
    pose_.orientation = rotate_by(pose_.orientation, dt * twist_.angular);
    DeviceReport report;
    report.pose = pose_;
    report.twist = twist_;
    return report;
  }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return true; }
  bool gives_way() const override { return false; }
  std::string kind() const override { return "mouse"; }

 private:
  static constexpr double kFollow = 45.0;  // rad/s: 95 % of a step within about 0.1 s
  std::shared_ptr<MouseTarget> target_;
  Pose wanted_;
  Pose pose_;
  Twist twist_;
};

}  // namespace slosh
