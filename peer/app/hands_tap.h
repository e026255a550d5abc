// What the host tells of the hands: what every step puts on them, for the record of hands that do not give
// way, and whether they could act.
#pragma once

#include <string>
#include <vector>

#include "host/tap.h"
#include "net/ring.h"
#include "peer/haptics/sample_line.h"
#include "scenes/scene.h"

namespace slosh {

class HandsTap final : public HostTap {
 public:
  explicit HandsTap(std::size_t grips)
      : steps_(kSteps * grips), acted_(grips, false), refused_(grips, PoseFault::kNone) {}

  /// For the device loop. Told before the bodies are published, so that who has a body state has its steps
  /// too. When nobody takes them, what comes last is lost, and body states have to do.
  Ring<StepWrench>& steps() { return steps_; }

  /// When the run is over: a sentence for each hand whose every pose was refused.
  std::vector<std::string> never_acted(const Scene& scene) const {
    std::vector<std::string> all;
    for (std::size_t g = 0; g < acted_.size() && g < scene.grips.size(); ++g) {
      if (acted_[g] || refused_[g] == PoseFault::kNone) continue;
      all.push_back("nothing was held by '" + scene.grips[g].name +
                    "' in all of the run: its poses are not used, " + words_of(refused_[g]) +
                    ". 'slosh check' says where the scene's hands go");
    }
    return all;
  }

  void on_start(const World&, const HostState& state) override { run_ = state.run; }
  void before_step(const World&, const StepInput& input) override {
    for (std::size_t g = 0; g < acted_.size() && g < input.hands.size(); ++g)
      acted_[g] = acted_[g] || input.hands[g].engaged;
  }
  void after_step(const World& world) override {
    world.fill(bodies_);
    for (std::size_t i = 0; i < bodies_.grips.size(); ++i) {
      steps_.push({run_, static_cast<std::uint32_t>(i), bodies_.time, bodies_.grips[i].on_hand});
    }
  }
  void on_refused_pose(std::uint32_t grip, PoseFault fault) override {
    if (grip < refused_.size()) refused_[grip] = fault;
  }
  void after_change(const World&, const HostCommand&, const HostState& state) override { run_ = state.run; }

 private:
  static constexpr std::size_t kSteps = 1024;  // a device loop that is held up for a second and more

  Ring<StepWrench> steps_;
  BodySnapshot bodies_;
  std::uint32_t run_ = 0;
  std::vector<bool> acted_;
  std::vector<PoseFault> refused_;
};

}  // namespace slosh
