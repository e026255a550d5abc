// A hand in a world in one process, all parts the real ones but their threads: world, pacer, gate, models of
// the fluid's wrench, channel and servo, on a clock that the test moves.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "host/input_gate.h"
#include "host/pace_line.h"
#include "host/pacer.h"
#include "net/grip_start.h"
#include "peer/devices/operator_device.h"
#include "peer/haptics/servo.h"
#include "scenes/sample.h"
#include "sim/fluid_models.h"
#include "sim/world.h"

namespace slosh::test {

/// One tick of a device.
struct FeltTick {
  double wall = 0.0;  ///< s since the run began
  double time = 0.0;  ///< simulated s
  Pose handle;
  Twist twist;
  Wrench on_hand;
  Wrench at_host;  ///< of the newest state then
};

/// Passes on and keeps what a device says and is sent.
class NotedDevice final : public Device {
 public:
  /// `on_the_wall`: what is within is told the wall's time in place of the world's, and goes by that.
  NotedDevice(std::unique_ptr<Device> within, std::vector<FeltTick>& ticks, bool on_the_wall = false)
      : within_(std::move(within)), ticks_(ticks), on_the_wall_(on_the_wall) {}

  DeviceReport read(const DeviceMoment& moment) override {
    wall_ = 0.001 * static_cast<double>(ticks_.size());
    const DeviceReport report = within_->read({on_the_wall_ ? wall_ : moment.time, moment.period});
    now_ = {wall_, moment.time, report.pose, report.twist, {}, {}};
    return report;
  }
  void write(const Wrench& on_hand) override {
    now_.on_hand = on_hand;
    ticks_.push_back(now_);
    within_->write(on_hand);
  }
  DeviceLimits limits() const override { return within_->limits(); }
  bool immediate() const override { return true; }
  bool gives_way() const override { return within_->gives_way(); }
  bool goes_with_world() const override { return !on_the_wall_ && within_->goes_with_world(); }
  std::string kind() const override { return within_->kind(); }

 private:
  std::unique_ptr<Device> within_;
  std::vector<FeltTick>& ticks_;
  bool on_the_wall_;
  double wall_ = 0.0;
  FeltTick now_;
};

struct RigOptions {
  double spacing = 0.01;  ///< m
  /// Sub-steps of 1 ms in a step of the host's; 0: the plan's own step.
  int sub_steps = 0;
  double step_size = 0.0;    ///< s of such a step; 0: 1 ms a sub-step
  bool models = true;        ///< of the fluid's wrench
  bool on_the_wall = false;  ///< the hand goes by the clock on the wall
  Coupling coupling = Coupling::kReplica;
  /// s of the wall's clock that the step after simulated time t takes.
  std::function<double(double)> step_takes;
  /// s after which a tick at so many s of the wall's clock is followed by the next; empty: 1 ms.
  std::function<double(double)> tick_after;
};

/// Grip 0 of a scene in a hand.
class HandRig {
 public:
  HandRig(const Scene& scene, std::unique_ptr<Device> device, RigOptions options)
      : options_(std::move(options)),
        world_(make(scene, options_)),
        models_(scene),
        gate_(scene),
        wanted_(scene.bodies.size(), 0),
        pacer_(world_.plan().time_step) {
    wanted_[static_cast<std::size_t>(scene.grips[0].body)] = options_.models ? 1 : 0;
    const Pose start = grip_start(scene, 0);
    world_.settle(0.5, std::vector<HandleInput>{{start, Twist{}, true, 1.0}});
    world_.fill(now_);
    BodyMessage first;
    first.stamp_ns = clock_ns_;
    first.time_step = world_.plan().time_step;
    first.bodies = now_;
    channel_ = std::make_unique<Channel>(scene.grips.size(), first, std::size_t{1000});
    std::vector<std::unique_ptr<Device>> devices;
    devices.push_back(std::make_unique<NotedDevice>(std::move(device), ticks_, options_.on_the_wall));
    ServoOptions servo;
    servo.coupling = options_.coupling;
    servo_ = std::make_unique<Servo>(scene, std::move(devices), *channel_, servo);
    servo_->tick(clock_ns_);
    tick_ns_ = clock_ns_ + kTick_ns;
    pacer_.restart(clock_ns_);
    line_.restart(clock_ns_);
    take_turn();
  }

  /// On until the world is at `seconds`.
  void run(double seconds) {
    while (now_.time < seconds) {
      clock_ns_ = std::min(stepping_ ? ready_ns_ : turn_.deadline_ns, tick_ns_);
      if (clock_ns_ == tick_ns_) {
        servo_->tick(clock_ns_);
        ticks_.back().at_host = now_.grips[0].on_hand;
        tick_ns_ += options_.tick_after
                        ? to_nanoseconds(options_.tick_after(to_seconds(clock_ns_ - began_ns_)))
                        : kTick_ns;
      } else if (!stepping_) {
        stepping_ = true;
        ready_ns_ =
            clock_ns_ + to_nanoseconds(options_.step_takes ? options_.step_takes(now_.time) : 0.0) + 1;
        const std::span<const HandleInput> input = gate_.take(*channel_, now_, clock_ns_);
        poses_.assign(gate_.poses().begin(), gate_.poses().end());
        world_.step(input);
      } else {
        stepping_ = false;
        world_.fill(now_);
        publish();
        take_turn();
      }
    }
  }

  const std::vector<FeltTick>& ticks() const { return ticks_; }
  double time_step() const { return world_.plan().time_step; }
  double rate() const { return rate_; }  ///< as the host says it
  std::int64_t clock_ns() const { return clock_ns_; }

 private:
  static constexpr std::int64_t kTick_ns = 1'000'000;

  static World make(const Scene& scene, const RigOptions& options) {
    Plan plan = make_plan(scene, options.spacing);
    if (options.sub_steps > 0) {
      plan.sub_steps = options.sub_steps;
      plan.time_step = options.step_size > 0.0 ? options.step_size : 0.001 * options.sub_steps;
      plan.max_speed = speed_limit(plan, plan.time_step / plan.sub_steps);
    }
    auto sampled = sample_scene(scene, options.spacing);
    if (!sampled) throw std::runtime_error(sampled.error().text());
    return {scene, sampled.value(), plan, WorldOptions{1, Backend::kCpu}};
  }
  void take_turn() {
    // As after a sleep until the deadline, which is now where that is past.
    turn_ = pacer_.next(clock_ns_);
    begin_ns_ = turn_.deadline_ns;
    turn_.deadline_ns = std::max(turn_.deadline_ns, clock_ns_);
  }
  void publish() {
    const double dt = time_step();
    Pacer::Turn turn = turn_;
    turn.deadline_ns = begin_ns_;
    const PaceLine::Moment moment = line_.after_step(dt, 1.0, turn, clock_ns_);
    rate_ = moment.rate;
    BodyMessage& message = channel_->bodies().back();
    message.time_step = dt;
    message.rate = moment.rate;
    message.stamp_ns = moment.stamp_ns;
    message.bodies = now_;
    message.fluid_models.clear();
    if (options_.models) models_.after_step(world_, now_, wanted_, message.fluid_models);
    message.hands.clear();
    for (const PoseMessage& pose : poses_)
      message.hands.push_back({pose.number, pose.stamp_ns, pose.time, pose.counted, pose.energy});
    channel_->bodies().publish();
  }

  RigOptions options_;
  World world_;
  FluidModels models_;
  InputGate gate_;
  std::vector<char> wanted_;
  Pacer pacer_;
  PaceLine line_;
  std::int64_t clock_ns_ = 1'000'000'000'000;
  std::int64_t began_ns_ = clock_ns_;
  std::int64_t tick_ns_ = 0, ready_ns_ = 0, begin_ns_ = 0;
  Pacer::Turn turn_;
  bool stepping_ = false;
  double rate_ = 1.0;
  BodySnapshot now_;
  std::vector<PoseMessage> poses_;
  std::vector<FeltTick> ticks_;
  std::unique_ptr<Channel> channel_;
  std::unique_ptr<Servo> servo_;
};

/// The largest force from simulated time `from` on, N.
inline double peak_force(const std::vector<FeltTick>& ticks, double from = 0.0) {
  double most = 0.0;
  for (const FeltTick& tick : ticks)
    if (tick.time >= from) most = std::max(most, glm::length(tick.on_hand.force));
  return most;
}

/// RMS over simulated time of the difference of two hands' forces, over that of the second's about its mean.
inline double force_off(const std::vector<FeltTick>& ticks, const std::vector<FeltTick>& reference,
                        double from, double to) {
  double off = 0.0, square = 0.0, count = 0.0;
  glm::dvec3 sum(0.0);
  std::size_t j = 0;
  for (double t = from; t < to; t += 0.001) {
    while (j + 1 < ticks.size() && ticks[j + 1].time <= t) j += 1;
    const auto at = std::lower_bound(reference.begin(), reference.end(), t,
                                     [](const FeltTick& tick, double time) { return tick.time < time; });
    if (at == reference.end()) break;
    const glm::dvec3 is = at->on_hand.force, difference = ticks[j].on_hand.force - is;
    off += glm::dot(difference, difference);
    square += glm::dot(is, is);
    sum += is;
    count += 1.0;
  }
  return std::sqrt(off / (square - glm::dot(sum, sum) / count));
}

}  // namespace slosh::test
