// A second hand on a running device loop, beside one that something goes wrong with.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>

#include "tests/peer/servo_kit.h"

namespace slosh::test {

constexpr double kOff = 0.01;     // m that a hand is from its grip,
constexpr double kForce = -10.0;  // N for that

/// What it was sent: how often, and N along x.
struct OtherHand {
  std::atomic<std::uint64_t> writes{0};
  std::atomic<double> felt{0.0};  ///< newest
  std::atomic<double> least{0.0};
  std::atomic<double> most{-1e9};
};

/// On the loop itself, with the world that both hold: a state each reading. For `on_the_grip` readings it is
/// there, so that it takes hold; then it is off by kOff.
class OtherDevice final : public Device {
 public:
  OtherDevice(std::shared_ptr<OtherHand> seen, Channel& channel, int on_the_grip)
      : seen_(std::move(seen)), channel_(channel), on_the_grip_(on_the_grip) {}
  DeviceReport read(const DeviceMoment&) override {
    reads_ += 1;
    publish_ahead(channel_, reads_);
    DeviceReport report;
    report.pose.position.x = reads_ > on_the_grip_ ? kOff : 0.0;
    return report;
  }
  void write(const Wrench& on_hand) override {
    seen_->felt = on_hand.force.x;
    seen_->least = std::min(seen_->least.load(), on_hand.force.x);
    seen_->most = std::max(seen_->most.load(), on_hand.force.x);
    seen_->writes += 1;
  }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return true; }
  std::string kind() const override { return "other"; }

 private:
  std::shared_ptr<OtherHand> seen_;
  Channel& channel_;
  int on_the_grip_;
  int reads_ = 0;
};

}  // namespace slosh::test
