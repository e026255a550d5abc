// A device on a thread of its own, and all that it was ever sent, with the moment of each.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "net/clock.h"
#include "peer/haptics/device.h"
#include "tests/support/written_forces.h"

namespace slosh::test {

/// What the test and the device's thread share.
class NotedWrites {
 public:
  std::atomic<double> place{0.0};  ///< m, along x, that the device reads
  std::atomic<std::uint32_t> buttons{0};
  std::atomic<bool> engaged{true};

  void add(const glm::dvec3& force) {
    const std::lock_guard lock(mutex_);
    all_.push_back({steady_now_ns(), force});
  }
  std::vector<WrittenForce> since(std::int64_t ns) const {
    const std::lock_guard lock(mutex_);
    return written_since(all_, ns);
  }
  /// N, along x.
  double last() const {
    const std::lock_guard lock(mutex_);
    return all_.empty() ? 0.0 : all_.back().force.x;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<WrittenForce> all_;
};

/// An arm of 20 N and 1000 N/s whose hand gets its force over 0.2 s.
inline DeviceLimits quick_arm() {
  DeviceLimits limits = limits_without_a_hand();
  limits.max_force = 20.0;
  limits.max_force_rate = 1000.0;
  limits.max_force_jerk = 1e6;
  limits.engagement_time = 0.2;
  return limits;
}

class NotingDevice final : public Device {
 public:
  explicit NotingDevice(std::shared_ptr<NotedWrites> noted, const DeviceLimits& limits = quick_arm())
      : noted_(std::move(noted)), limits_(limits) {}
  DeviceReport read(const DeviceMoment&) override {
    DeviceReport report;
    report.pose.position.x = noted_->place;
    report.buttons = noted_->buttons;
    report.engaged = noted_->engaged;
    return report;
  }
  void write(const Wrench& on_hand) override { noted_->add(on_hand.force); }
  DeviceLimits limits() const override { return limits_; }
  std::string kind() const override { return "noting"; }

 private:
  std::shared_ptr<NotedWrites> noted_;
  DeviceLimits limits_;
};

}  // namespace slosh::test
