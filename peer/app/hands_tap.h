// Whether the hands of a run could act.
#pragma once

#include <string>
#include <vector>

#include "host/tap.h"
#include "scenes/scene.h"

namespace slosh {

/// Told by the host's thread; read when the run is over.
class HandsTap final : public HostTap {
 public:
  explicit HandsTap(std::size_t grips) : acted_(grips, false), refused_(grips, PoseFault::kNone) {}

  void before_step(const World&, const StepInput& input) override {
    for (std::size_t g = 0; g < acted_.size() && g < input.hands.size(); ++g)
      acted_[g] = acted_[g] || input.hands[g].engaged;
  }
  void on_refused_pose(std::uint32_t grip, PoseFault fault) override {
    if (grip < refused_.size()) refused_[grip] = fault;
  }

  /// A sentence for each hand whose every pose was refused.
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

 private:
  std::vector<bool> acted_;
  std::vector<PoseFault> refused_;
};

}  // namespace slosh
