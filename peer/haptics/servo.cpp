#include "peer/haptics/servo.h"

#include <algorithm>
#include <cmath>

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
  channel_.bodies().update();
  run_ = channel_.bodies().front().run;
  devices.resize(scene.grips.size());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const Grip& grip = scene.grips[i];
    Hand& hand = hands_.emplace_back(
        CouplingGains{grip.stiffness, grip.damping, grip.rotational_stiffness, grip.rotational_damping},
        grip_start(scene, i));
    if (devices[i]) set_device(i, std::move(devices[i]));
    if (Device* const device = claim_device(hand)) change_device(hand, device);
  }
}

void Servo::set_device(std::size_t i, std::unique_ptr<Device> device) {
  Hand& hand = hands_[i];
  free_unused(hand);
  Device* const wanted = device.get();
  if (device) hand.owned.push_back(std::move(device));
  hand.wanted.store(wanted);
}

bool Servo::holds_any() const {
  return std::any_of(hands_.begin(), hands_.end(),
                     [](const Hand& hand) { return hand.wanted.load(std::memory_order_relaxed) != nullptr; });
}

void Servo::close_devices() {
  for (Hand& hand : hands_) {
    for (const std::unique_ptr<Device>& device : hand.owned) device->close();
  }
}

void Servo::free_unused(Hand& hand) {
  // In this order: what the loop claims now becomes what it uses.
  const Device* const wanted = hand.wanted.load();
  const Device* const claimed = hand.claimed.load();
  const Device* const in_use = hand.in_use.load();
  std::erase_if(hand.owned, [&](const std::unique_ptr<Device>& device) {
    if (device.get() == in_use || device.get() == claimed || device.get() == wanted) return false;
    device->close();
    return true;
  });
}

Device* Servo::claim_device(Hand& hand) noexcept {
  Device* device = hand.wanted.load(std::memory_order_acquire);
  if (device == hand.device) return device;
  // Announced and still wanted: from here on free_unused() sees it. All sequentially consistent: one of the
  // two sides must see the other.
  for (;;) {
    hand.claimed.store(device);
    Device* const now = hand.wanted.load();
    if (now == device) return device;
    device = now;
  }
}

void Servo::change_device(Hand& hand, Device* device) noexcept {
  if (hand.device != nullptr) hand.device->write(Wrench{});
  hand.device = device;
  hand.engagement = Engagement{};
  if (device != nullptr) hand.limiter = ForceLimiter(device->limits());
  hand.good = DeviceReport{};
  hand.good.pose = hand.start;
  hand.good.engaged = false;
  hand.in_use.store(device);
}

void Servo::follow_run(const BodyMessage& message) noexcept {
  if (message.run == run_) return;
  run_ = message.run;
  // One interval further, so that the times of a file's rows rise.
  sample_offset_ += time_ - message.bodies.time + options_.sample_interval;
  time_ = message.bodies.time;
  next_sample_ = time_;
  for (Hand& hand : hands_) hand.engagement = Engagement{};
}

double Servo::freshness_now(const BodyMessage& message, double age) noexcept {
  const double interval = message.rate > 0.0 ? message.time_step / message.rate : 0.0;
  // Before the first step the world waits, and its state holds; after that, a pace of 0 means that it
  // stopped.
  const bool stopped = message.rate <= 0.0 && message.bodies.tick > 0;
  const double believed = stopped ? 0.0 : message.bodies.tick == 0 ? 1.0 : freshness(age, interval);
  // What comes back after a gap comes back as gently as it went, and where it is then.
  if (believed >= 1.0 && hold_anew_) {
    for (Hand& hand : hands_) hand.engagement = Engagement{};
  }
  hold_anew_ = believed < 1.0;
  fresh_ = std::min(believed, fresh_ + options_.period / kFadeStale);
  return fresh_;
}

void Servo::tick(std::int64_t now_ns) noexcept {
  channel_.bodies().update();
  const BodyMessage& message = channel_.bodies().front();
  const BodySnapshot& bodies = message.bodies;
  const double age = to_seconds(now_ns - message.stamp_ns);  // negative while the state is still to come

  follow_run(message);
  // Simulated time now: the newest state's, carried on at the pace the world runs, at most two ticks.
  const double longest = 2.0 * message.time_step;
  time_ = std::max(time_, bodies.time + std::clamp(age * message.rate, -longest, longest));
  const double ahead = std::clamp(time_ - bodies.time, -longest, longest);
  const double fresh = freshness_now(message, age);

  const bool stopped = message.rate <= 0.0 && bodies.tick > 0;
  const bool sample_due = !stopped && time_ + kRounding >= next_sample_;
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    Hand& hand = hands_[i];
    Device* const device = claim_device(hand);
    if (device != hand.device) change_device(hand, device);
    if (device == nullptr) continue;
    const DeviceReport report = device->read({time_, options_.period});
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
      GripState proxy = bodies.grips[i];
      proxy.pose = extrapolate(proxy.pose, proxy.twist, ahead);
      const Engagement::Held held =
          hand.engagement.update(good.engaged, time_, good.pose, good.twist, hand.gains, proxy);
      const Wrench full = coupling_wrench_on_hand(hand.gains, held.pose, held.twist, proxy.pose, proxy.twist);
      const double scale = hand.engagement.felt() * fresh;
      wanted = {scale * full.force, scale * full.torque};
    }
    const ForceLimiter::Outcome outcome = hand.limiter.limit(wanted, options_.period);
    if (outcome.limited) note(kStatusForceLimited);
    if (outcome.non_finite) note(kStatusNonFinite);
    device->write(outcome.wrench);

    PoseMessage& up = channel_.pose(i).back();
    up.stamp_ns = now_ns;
    up.tick_ack = bodies.tick;
    up.time = time_;
    up.device = static_cast<std::uint32_t>(i);
    up.pose = good.pose;
    up.twist = good.twist;
    up.engaged = good.engaged;
    channel_.pose(i).publish();

    if (sample_due &&
        !samples_.push({sample_offset_ + time_, static_cast<std::uint32_t>(i), outcome.wrench, good.pose})) {
      lost_.fetch_add(1, std::memory_order_relaxed);
    }
  }
  if (sample_due) {
    // On the grid of intervals, whatever the tick that met it: rows stay evenly spread over the run.
    const double interval = options_.sample_interval;
    next_sample_ = interval * (std::floor((time_ + kRounding) / interval) + 1.0);
  }
  shown_time_.store(time_, std::memory_order_relaxed);
}

}  // namespace slosh
