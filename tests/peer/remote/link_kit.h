// Hands that move while their link misbehaves, and the link.
#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <numbers>
#include <random>
#include <string>

#include "net/clock.h"
#include "peer/haptics/device.h"
#include "sim/math/pose.h"

namespace slosh::test {

constexpr double kSwing = 0.25;     // m from end to end,
constexpr double kSwingTime = 3.0;  // s to and fro: 0.26 m/s and 0.55 m/s² at most
constexpr double kTilt = 1.6;       // rad from one side to the other,
constexpr double kTiltTime = 7.0;   // s to and fro: as the hands that spill the bucket

enum class Motion { kToAndFro, kTurning };

/// A hand that goes to and fro with the beam or turns it about its middle: by the world's time as a script
/// does, or by the clock on the wall as a person.
class MovingDevice final : public Device {
 public:
  MovingDevice(const Pose& start, const std::int64_t* clock, Motion motion)
      : start_(start), clock_(clock), motion_(motion) {}
  DeviceReport read(const DeviceMoment& moment) override {
    const double t = (clock_ != nullptr ? to_seconds(*clock_) - 1000.0 : moment.time) - 2.0;
    DeviceReport report;
    report.pose = start_;
    if (t <= 0.0) return report;
    if (motion_ == Motion::kTurning) {
      const double w = 2.0 * std::numbers::pi / kTiltTime;
      const glm::dvec3 axis(0.0, 0.0, 1.0);
      const glm::dvec3 middle(0.0, start_.position.y, 0.0);
      report.twist.angular = 0.5 * kTilt * w * std::cos(w * t) * axis;
      const glm::dvec3 turned = 0.5 * kTilt * std::sin(w * t) * axis;
      report.pose.orientation = rotate_by(start_.orientation, turned);
      report.pose.position = middle + rotate_by(glm::dquat(1, 0, 0, 0), turned) * (start_.position - middle);
      report.twist.linear = glm::cross(report.twist.angular, report.pose.position - middle);
      return report;
    }
    const double w = 2.0 * std::numbers::pi / kSwingTime;
    const glm::dvec3 way = glm::normalize(glm::dvec3(1.0, 0.5, 0.3));
    report.pose.position += 0.5 * kSwing * (1.0 - std::cos(w * t)) * way;
    report.twist.linear = 0.5 * kSwing * w * std::sin(w * t) * way;
    return report;
  }
  void write(const Wrench& on_hand) override { last = on_hand; }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return true; }
  std::string kind() const override { return "swinging"; }
  Wrench last;

 private:
  Pose start_;
  const std::int64_t* clock_;
  Motion motion_;
};

enum class Flow { kOpen, kStands, kDrops };

/// One direction of one person's link.
template <class M>
class Wire {
 public:
  Flow flow = Flow::kOpen;
  void send(const M& message, std::int64_t now_ns, std::mt19937_64& random) {
    if (flow == Flow::kDrops) return;
    std::uniform_real_distribution<> jitter(0.005, 0.007);
    on_way_.push_back({now_ns + to_nanoseconds(jitter(random)), message});
  }
  /// What has arrived, in order; a link that stood gives out at once what it kept.
  template <class Take>
  void deliver(std::int64_t now_ns, Take&& take) {
    if (flow == Flow::kStands) return;
    while (!on_way_.empty() && on_way_.front().due_ns <= now_ns) {
      take(on_way_.front().message);
      on_way_.pop_front();
    }
  }
  void keep_at_most(std::size_t count) {
    if (on_way_.size() > count) on_way_.resize(count);
  }

 private:
  struct OnWay {
    std::int64_t due_ns;
    M message;
  };
  std::deque<OnWay> on_way_;
};

}  // namespace slosh::test
