// A device on a thread of its own, and all that it was ever sent, with the moment of each.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "net/clock.h"
#include "peer/haptics/device.h"

namespace slosh::test {

struct Write {
  std::int64_t ns = 0;
  double force = 0.0;  ///< N, along x
};

/// What the test and the device's thread share.
class NotedWrites {
 public:
  std::atomic<double> place{0.0};         ///< m, along x, that the device reads
  std::atomic<std::uint32_t> buttons{0};
  std::atomic<bool> engaged{true};

  void add(double force) {
    const std::lock_guard lock(mutex_);
    all_.push_back({steady_now_ns(), force});
  }
  std::vector<Write> since(std::int64_t ns) const {
    const std::lock_guard lock(mutex_);
    std::vector<Write> found;
    for (const Write& write : all_)
      if (write.ns >= ns) found.push_back(write);
    return found;
  }
  double last() const {
    const std::lock_guard lock(mutex_);
    return all_.empty() ? 0.0 : all_.back().force;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Write> all_;
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
  void write(const Wrench& on_hand) override { noted_->add(on_hand.force.x); }
  DeviceLimits limits() const override { return limits_; }
  std::string kind() const override { return "noting"; }

 private:
  std::shared_ptr<NotedWrites> noted_;
  DeviceLimits limits_;
};

/// The largest change from a write to the next, N, over what a device of `rate` N/s and 1 kHz may be given: in the
/// shorter of the times that it and the write before it took, a ms at least. A thread that stood still has no more to
/// give at once for it.
inline double steepest(const std::vector<Write>& writes, double rate) {
  double most = 0.0;
  for (std::size_t i = 1; i < writes.size(); ++i) {
    const double took = to_seconds(writes[i].ns - writes[i - 1].ns);
    const double before = i > 1 ? to_seconds(writes[i - 1].ns - writes[i - 2].ns) : 0.001;
    const double allowed = rate * std::max(std::min(took, before), 0.001);
    most = std::max(most, std::abs(writes[i].force - writes[i - 1].force) / allowed);
  }
  return most;
}

/// s from `ns` to the first write from which on all are zero; 1e9 where the last is not.
inline double zero_after(const std::vector<Write>& writes, std::int64_t ns) {
  double zero = 1e9;
  for (std::size_t i = writes.size(); i-- > 0 && writes[i].force == 0.0;) zero = to_seconds(writes[i].ns - ns);
  return zero;
}

}  // namespace slosh::test
