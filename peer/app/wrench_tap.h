// What every step puts on the hands, from the host's thread to the device loop: for the record of hands that
// do not give way.
#pragma once

#include "host/tap.h"
#include "net/ring.h"
#include "peer/haptics/sample_line.h"

namespace slosh {

/// Told before the bodies are published, so that who has a body state has its steps too. When nobody takes
/// them, what comes last is lost, and body states have to do.
class WrenchTap final : public HostTap {
 public:
  explicit WrenchTap(std::size_t grips) : steps_(kSteps * grips) {}

  Ring<StepWrench>& steps() { return steps_; }

  void on_start(const World&, const HostState& state) override { run_ = state.run; }
  void after_step(const World& world) override {
    world.fill(bodies_);
    for (std::size_t i = 0; i < bodies_.grips.size(); ++i) {
      steps_.push({run_, static_cast<std::uint32_t>(i), bodies_.time, bodies_.grips[i].on_hand});
    }
  }
  void after_change(const World&, const HostCommand&, const HostState& state) override { run_ = state.run; }

 private:
  static constexpr std::size_t kSteps = 1024;  // a device loop that is held up for a second and more

  Ring<StepWrench> steps_;
  BodySnapshot bodies_;
  std::uint32_t run_ = 0;
};

}  // namespace slosh
