// Samples on their way to who records them, in order; those of a hand that does not give way wait for the
// world.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/math/pose.h"

namespace slosh {

/// What was felt at one moment.
struct ServoSample {
  double time = 0.0;  ///< simulated s; goes on across a reset of the world, see Servo
  std::uint32_t device = 0;
  Wrench on_hand;  ///< torque about the handle, world axes; see SampleLine
  Pose handle;     ///< world
};

/// What the world put on one hand in the step that ended at `time`.
struct StepWrench {
  std::uint32_t run = 0;  ///< BodyMessage::run
  std::uint32_t grip = 0;
  double time = 0.0;  ///< simulated s
  Wrench on_hand;
};

/// A sample is taken at a simulated time that the world has mostly not reached yet. For a hand that gives way
/// it is what was sent to the device. For any other it is what the world puts on the hand at that time,
/// between its two states around it: it waits for the second of them, which
/// comes within a step. Where that state does not come soon (a silence, the end), it stays what was sent. One
/// thread; no allocation after construction.
class SampleLine {
 public:
  explicit SampleLine(std::size_t hands) : histories_(hands) {}

  /// The world's states in order, one call a grip; what is not later than the one before is passed over.
  /// `longest`: s between two states up to which what is between them is known.
  void note(std::uint32_t grip, double time, const Wrench& on_hand, double longest) noexcept {
    if (grip >= histories_.size()) return;
    History& history = histories_[grip];
    if (history.count > 0 && time <= history.back(0).time + kRounding) return;
    history.put({time, on_hand});
    longest_ = longest;
    for (std::size_t i = 0; i < count_; ++i) {
      Waiting& waiting = line_[(first_ + i) % kMax];
      if (waiting.sample.device == grip && waiting.awaits) settle(waiting, history);
    }
  }
  /// The world went back to its start: what is known of it is of another run.
  void forget() noexcept { std::fill(histories_.begin(), histories_.end(), History{}); }

  bool full() const { return count_ == kMax; }
  bool empty() const { return count_ == 0; }
  /// `world_time`: the sample's time as the world has it. `follows_world` as ForceRendering has it. Not when
  /// full.
  void add(const ServoSample& sample, double world_time, bool follows_world) noexcept {
    Waiting& waiting = line_[(first_ + count_) % kMax];
    waiting = {sample, world_time, follows_world};
    count_ += 1;
    if (follows_world) settle(waiting, histories_[sample.device]);
  }

  /// Whether the oldest sample need not wait any more. Not when empty.
  bool ready() const { return !line_[first_].awaits; }
  /// Takes the oldest, as it is known by now. Not when empty.
  ServoSample take() noexcept {
    const ServoSample sample = line_[first_].sample;
    first_ = (first_ + 1) % kMax;
    count_ -= 1;
    return sample;
  }

 private:
  struct Waiting {
    ServoSample sample;
    double world_time = 0.0;
    bool awaits = false;  // the world's word
  };
  struct State {
    double time = 0.0;
    Wrench on_hand;
  };
  /// The newest states of one hand.
  struct History {
    static constexpr std::size_t kKept = 8;  // a world that catches up is some steps ahead of the device loop
    std::array<State, kKept> states{};
    std::size_t count = 0;  // ever put

    void put(const State& state) {
      states[count % kKept] = state;
      count += 1;
    }
    const State& back(std::size_t i) const { return states[(count - 1 - i) % kKept]; }
    std::size_t kept() const { return std::min(count, kKept); }
  };

  /// As far as its time is known by now.
  void settle(Waiting& waiting, const History& history) const noexcept {
    const double time = waiting.world_time;
    if (history.count == 0 || time > history.back(0).time + kRounding) return;
    waiting.awaits = false;
    for (std::size_t i = 0; i < history.kept(); ++i) {
      const State& state = history.back(i);
      if (time < state.time - kRounding) continue;
      double later = 0.0;
      if (i > 0 && time > state.time) {
        const double apart = history.back(i - 1).time - state.time;
        if (apart > longest_) return;
        later = (time - state.time) / apart;
      }
      const Wrench& a = state.on_hand;
      const Wrench& b = history.back(i > 0 ? i - 1 : 0).on_hand;
      waiting.sample.on_hand = {a.force + later * (b.force - a.force),
                                a.torque + later * (b.torque - a.torque)};
      return;
    }
  }

  static constexpr std::size_t kMax = 256;
  static constexpr double kRounding = 1e-9;  // s: sums of time steps miss a multiple by less than this

  std::array<Waiting, kMax> line_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  double longest_ = 0.0;
  std::vector<History> histories_;  // one a hand
};

}  // namespace slosh
