#include "peer/haptics/servo.h"

#include <algorithm>

#include "net/clock.h"
#include "peer/haptics/make_device.h"

namespace slosh {
namespace {

constexpr double kRounding = 1e-9;  // s: sums of time steps miss a multiple by less than this

}  // namespace

double freshness(double age, double interval) {
  const double hold = std::max(kHoldStale, 4.0 * interval);
  return std::clamp(1.0 - (age - hold) / kFadeStale, 0.0, 1.0);
}

Servo::Servo(const Scene& scene, std::vector<std::unique_ptr<Device>> devices, Channel& channel,
             ServoOptions options)
    : channel_(channel), options_(options), samples_(options.sample_capacity) {
  hands_.reserve(devices.size());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const Grip& grip = scene.grips[i];
    hands_.emplace_back(
        std::move(devices[i]),
        CouplingGains{grip.stiffness, grip.damping, grip.rotational_stiffness, grip.rotational_damping},
        grip_start(scene, i));
  }
}

void Servo::tick(std::int64_t now_ns) noexcept {
  channel_.bodies().update();
  const BodyMessage& message = channel_.bodies().front();
  const BodySnapshot& bodies = message.bodies;
  const double age = to_seconds(now_ns - message.stamp_ns);  // negative while the state is still to come

  // Simulated time now: the newest state's, carried on at the pace the world runs, at most two ticks.
  const double longest = 2.0 * message.time_step;
  time_ = std::max(time_, bodies.time + std::clamp(age * message.rate, -longest, longest));
  const double ahead = std::clamp(time_ - bodies.time, -longest, longest);
  const double interval = message.rate > 0.0 ? message.time_step / message.rate : 0.0;
  // Before the first step the world waits, and its state holds; after that, a pace of 0 means that it
  // stopped.
  const bool stopped = message.rate <= 0.0 && bodies.tick > 0;
  const double fresh = stopped ? 0.0 : bodies.tick == 0 ? 1.0 : freshness(age, interval);

  const bool sample_due = !stopped && time_ + kRounding >= next_sample_;
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    Hand& hand = hands_[i];
    const DeviceReport report = hand.device->read({time_, options_.period});
    if (is_sound(report)) {
      hand.good = report;
    } else {
      rejected_.fetch_add(1, std::memory_order_relaxed);
      note(kStatusInputRejected);
      hand.good.twist = Twist{};
    }
    const DeviceReport& good = hand.good;

    Wrench wanted;
    if (i < bodies.grips.size()) {
      const GripState& grip = bodies.grips[i];
      const Pose proxy = extrapolate(grip.pose, grip.twist, ahead);
      const Wrench full = coupling_wrench_on_hand(hand.gains, good.pose, good.twist, proxy, grip.twist);
      const double jolt = glm::length(full.force - grip.on_hand.force);
      const double twist = glm::length(full.torque - grip.on_hand.torque);
      const double scale = hand.engagement.update(good.engaged, time_, jolt, twist) * fresh;
      wanted = {scale * full.force, scale * full.torque};
    }
    const ForceLimiter::Outcome outcome = hand.limiter.limit(wanted, options_.period);
    if (outcome.limited) note(kStatusForceLimited);
    if (outcome.non_finite) note(kStatusNonFinite);
    hand.device->write(outcome.wrench);

    PoseMessage& up = channel_.pose(i).back();
    up.stamp_ns = now_ns;
    up.tick_ack = bodies.tick;
    up.time = time_;
    up.device = static_cast<std::uint32_t>(i);
    up.pose = good.pose;
    up.twist = good.twist;
    up.engaged = good.engaged;
    channel_.pose(i).publish();

    if (sample_due && !samples_.push({time_, static_cast<std::uint32_t>(i), outcome.wrench, good.pose})) {
      lost_.fetch_add(1, std::memory_order_relaxed);
    }
  }
  if (sample_due) {
    // On the grid of intervals, whatever the tick that met it: rows stay evenly spread over the run.
    while (next_sample_ <= time_ + kRounding) next_sample_ += options_.sample_interval;
  }
  shown_time_.store(time_, std::memory_order_relaxed);
}

}  // namespace slosh
