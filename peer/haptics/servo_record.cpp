// What the device loop keeps of a tick for who records it: samples, and signals stage by stage.
#include <cmath>

#include "net/clock.h"
#include "peer/haptics/servo.h"

namespace slosh {
namespace {

constexpr double kRowRounding = 1e-9;  // s: sums of time steps miss a multiple by less than this
constexpr double kStatesApart =
    4.0;  // ticks: a loop that missed states knows what was between two that it has

}  // namespace

/// No row shows more than the device could have given: what a host says of the world may be anything.
Wrench Servo::within_limits(std::size_t grip, const Wrench& wrench) const noexcept {
  const double size = glm::dot(wrench.force, wrench.force) + glm::dot(wrench.torque, wrench.torque);
  if (grip >= hands_.size() || !std::isfinite(size)) return {};
  const DeviceLimits& limits = hands_[grip].limits;
  bool limited = false;
  return {limit_length(wrench.force, limits.max_force, limited),
          limit_length(wrench.torque, limits.max_torque, limited)};
}

/// What the world put on the hands up to this message.
void Servo::note_steps(const BodyMessage& message) noexcept {
  const double longest = kStatesApart * message.time_step;
  StepWrench step;
  while (options_.steps != nullptr && options_.steps->pop(step)) {
    if (step.run == run_) line_.note(step.grip, step.time, step.on_hand, longest);
  }
  if (message.run != run_) return;
  for (std::size_t i = 0; i < message.bodies.grips.size(); ++i) {
    line_.note(static_cast<std::uint32_t>(i), message.bodies.time, message.bodies.grips[i].on_hand, longest);
  }
}

/// Samples that are as they stay, or all.
void Servo::pass_on(bool all) noexcept {
  while (!line_.empty() && (all || line_.ready())) {
    ServoSample sample = line_.take();
    sample.on_hand = within_limits(sample.device, sample.on_hand);
    if (!samples_.push(sample)) lost_.fetch_add(1, std::memory_order_relaxed);
  }
}

/// Where a row is asked for each period, each tick has one whose time is another: a loop is early or late by
/// parts of a period, and on a grid of whole periods it would miss one row and have two ticks for the next.
/// Else on the grid.
bool Servo::sample_due(bool stopped) const noexcept {
  if (stopped) return false;
  if (options_.sample_interval > options_.period + kRowRounding) return time_ + kRowRounding >= next_sample_;
  return time_ > sampled_ + kRowRounding;
}

void Servo::note_signals(std::size_t i, SignalSample& signals, std::int64_t now_ns) noexcept {
  const Hand& hand = hands_[i];
  signals.time = sample_offset_ + time_;
  signals.tick = ticks_;
  signals.wall = to_seconds(now_ns - first_tick_ns_);
  signals.period = to_seconds(now_ns - tick_before_ns_);
  signals.device = static_cast<std::uint32_t>(i);
  signals.reading = hand.readings;
  signals.age = hand.readings == 0 ? 0.0 : to_seconds(now_ns - hand.read_ns);
  signals.engaged = hand.good.engaged;
  signals.at_device = hand.good.at_device;
  signals.hand = hand.good.pose;
  signals.hand_twist = hand.good.twist;
  signals.sent = hand.given;
  signals.rendered = hand.good.rendered;
  if (!signals_.push(signals)) lost_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace slosh
