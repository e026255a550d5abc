// The instruments of a run, told by its host.
#pragma once

#include "host/tap.h"
#include "peer/app/measurer.h"

namespace slosh {

class MeasureTap final : public HostTap {
 public:
  /// `measurer` must outlive it.
  explicit MeasureTap(Measurer& measurer) : measurer_(measurer) {}

  void on_start(const World& world, const HostState&) override { measurer_.begin(world, world.time()); }
  void after_step(const World& world) override {
    time_ = world.time();
    measurer_.step(world, before_ + time_);
  }
  void after_change(const World& world, const HostCommand& change, const HostState&) override {
    if (change.action != HostAction::kReset) return;
    before_ += time_ - world.time();
    time_ = world.time();
  }

 private:
  Measurer& measurer_;
  double before_ = 0.0;  // s of the runs before a reset
  double time_ = 0.0;
};

}  // namespace slosh
