// The world as those who change it see it: its switches, and whether it still waits for hands.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "host/host.h"
#include "net/wire/messages.h"

namespace slosh {

/// One thread, the network's. What is asked is carried out elsewhere; told() brings what came of it.
class WorldSwitches {
 public:
  /// `hands_to_start`: grips that must be held before a world that stands starts by itself; 0 = never.
  WorldSwitches(HostState state, std::size_t hands_to_start)
      : state_(std::move(state)),
        hands_to_start_(hands_to_start),
        waits_(state_.paused && hands_to_start > 0) {}

  const HostState& state() const { return state_; }
  void told(const HostState& state) { state_ = state; }

  bool waits_for_hands() const { return waits_; }
  /// Who pauses or starts the world by hand does not want it to start by itself any more.
  void note_wish(const HostCommand& command) {
    if (command.action == HostAction::kPause || command.action == HostAction::kContinue) waits_ = false;
  }
  /// True once: as many grips are held as were waited for (or all there are).
  bool starts_with(std::size_t held, std::size_t grips) {
    if (!waits_ || held < std::min(hands_to_start_, grips)) return false;
    waits_ = false;
    return true;
  }
  /// For who comes while it waits.
  std::string waiting_text() const {
    return (hands_to_start_ == 1
                ? std::string("the world waits for the first hand to take hold")
                : "the world waits until " + std::to_string(hands_to_start_) + " grips are held") +
           ", or until somebody who may types continue";
  }

  wire::WorldInfo message() const {
    wire::WorldInfo info{state_.paused, state_.run, state_.gravity_scale, state_.viscosities,
                         state_.grip_stiffness};
    if (info.viscosities.size() > wire::kMaxFluids) info.viscosities.resize(wire::kMaxFluids);
    if (info.grip_stiffness.size() > wire::kMaxGrips) info.grip_stiffness.resize(wire::kMaxGrips);
    return info;
  }

 private:
  HostState state_;
  std::size_t hands_to_start_;
  bool waits_;
};

}  // namespace slosh
