#include "peer/haptics/servo.h"

#include <algorithm>
#include <cmath>

#include "net/clock.h"
#include "net/grip_start.h"
#include "net/leap.h"
#include "peer/haptics/world_pace.h"

namespace slosh {
namespace {

constexpr double kRounding = 1e-9;  // s: sums of time steps miss a multiple by less than this
/// Times the world's pace that simulated time goes at least and at most while it goes on, and s by which it
/// may be behind before it leaps.
constexpr double kMinOn = 0.5;
constexpr double kMaxOn = 1.5;
constexpr double kFarBehind = 0.03;
constexpr double kPaceMemory = 0.1;   // s over which the world's pace is smoothed
constexpr double kMaxSpeed = 18.0;    // m/s that a hand is said to have: a host refuses 20
constexpr double kMaxTurning = 90.0;  // rad/s, the same of 100

}  // namespace

Servo::Servo(const Scene& scene, std::vector<std::unique_ptr<Device>> devices, Channel& channel,
             ServoOptions options)
    : channel_(channel),
      options_(options),
      link_freshness_(options.period),
      held_(scene, options.coupling),
      line_(scene.grips.size()),
      samples_(options.sample_capacity),
      signals_(options.signals ? options.sample_capacity : 0) {
  channel_.bodies().update();
  const BodyMessage& first = channel_.bodies().front();
  run_ = first.run;
  note_steps(first);
  devices.resize(scene.grips.size());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const Grip& grip = scene.grips[i];
    Hand& hand = hands_.emplace_back(
        CouplingGains{grip.stiffness, grip.damping, grip.rotational_stiffness, grip.rotational_damping},
        grip_start(scene, i));
    hand.body = grip.body;
    for (const GuidedHand& guided : options_.guided)
      if (guided.grip == i && guided.most > 0.0) {
        hand.guide.emplace(guided.way, guided.most);
        hand.ghost = guided.clock;
      }
    if (devices[i]) (void)set_device(i, std::move(devices[i]));
    if (DevicePort* const port = claim_device(hand)) change_device(hand, port);
  }
}

// What leads the hand beside its coupling, in N.
glm::dvec3 Servo::guidance(Hand& hand) noexcept {
  if (!hand.guide) return glm::dvec3(0.0);
  if (!hand.good.engaged || hand.leapt || !hand.port->device().gives_way()) {
    hand.guide->restart();
    return glm::dvec3(0.0);
  }
  return hand.guide->force(hand.ghost->at(time_), hand.good.pose.position, hand.good.twist.linear,
                           options_.period, hand.limits.max_damping);
}

Servo::~Servo() {
  close_devices();
}

Result<bool> Servo::set_device(std::size_t i, std::unique_ptr<Device> device) {
  Hand& hand = hands_[i];
  if (device) {
    if (Result<bool> sound = check_limits(device->limits(), device->kind()); !sound) return sound;
  }
  free_unused(hand);
  DevicePort* wanted = nullptr;
  if (device) {
    hand.owned.push_back(std::make_unique<DevicePort>(std::move(device)));
    wanted = hand.owned.back().get();
  }
  hand.wanted.store(wanted);
  return true;
}

bool Servo::holds_any() const {
  return std::any_of(hands_.begin(), hands_.end(),
                     [](const Hand& hand) { return hand.wanted.load(std::memory_order_relaxed) != nullptr; });
}

void Servo::close_devices() {
  let_go();
  for (Hand& hand : hands_) {
    for (const std::unique_ptr<DevicePort>& port : hand.owned) port->stop();
  }
}

void Servo::let_go() noexcept {
  let_go_ = true;
  for (Hand& hand : hands_) {
    if (hand.port != nullptr) hand.port->write_zero();
  }
  channel_.bodies().update();
  note_steps(channel_.bodies().front());
  pass_on(true);
}

void Servo::free_unused(Hand& hand) {
  // In this order: what the loop claims now becomes what it uses.
  const DevicePort* const wanted = hand.wanted.load();
  const DevicePort* const claimed = hand.claimed.load();
  const DevicePort* const in_use = hand.in_use.load();
  std::erase_if(hand.owned, [&](const std::unique_ptr<DevicePort>& port) {
    return port.get() != in_use && port.get() != claimed && port.get() != wanted;
  });
}

DevicePort* Servo::claim_device(Hand& hand) noexcept {
  DevicePort* port = hand.wanted.load(std::memory_order_acquire);
  if (port == hand.port) return port;
  // Announced and still wanted: from here on free_unused() sees it. All sequentially consistent: one of the
  // two sides must see the other.
  for (;;) {
    hand.claimed.store(port);
    DevicePort* const now = hand.wanted.load();
    if (now == port) return port;
    port = now;
  }
}

/// Whether what it was given is still to go, as gently as its device asks for, before it is parted with:
/// somebody has released its grip.
bool Servo::parts(const Hand& hand, const DevicePort* wanted) const noexcept {
  const bool felt = hand.given.force != glm::dvec3(0.0) || hand.given.torque != glm::dvec3(0.0);
  return wanted == nullptr && hand.port != nullptr && felt && hand.port->device().gives_way();
}

void Servo::change_device(Hand& hand, DevicePort* port) noexcept {
  if (hand.port != nullptr) hand.port->write_zero();
  hand.port = port;
  if (port != nullptr) {
    hand.limits = port->limits();
    hand.with_world = port->device().goes_with_world();
    hand.budget.restart();
    hand.felt.restart(stiffened(hand.gains, hand.stiffness), hand.limits, port->device().gives_way());
  }
  hand.good = DeviceReport{};
  hand.good.pose = hand.start;
  hand.good.engaged = false;
  hand.given = Wrench{};
  hand.readings = 0;
  hand.in_use.store(port);
}

/// Here as in the world, so that no hand is thrown; the device's limits go last. A host that does not tell
/// what acts is followed on the way to what was asked for, by the world's time.
void Servo::follow_stiffness(std::size_t i, Hand& hand, const BodySnapshot& bodies, double elapsed) noexcept {
  const double told = i < bodies.grips.size() ? bodies.grips[i].stiffness : 0.0;
  const double wanted = hand.stiffness_wanted.load(std::memory_order_relaxed);
  const double now = told > 0.0     ? told
                     : wanted > 0.0 ? toward_stiffness(hand.stiffness, wanted, elapsed)
                                    : hand.stiffness;
  if (now == hand.stiffness) return;
  hand.stiffness = now;
  const CouplingGains gains = stiffened(hand.gains, hand.stiffness);
  held_.set_gains(i, gains);
  hand.felt.set_gains(gains, hand.limits);
}

void Servo::follow_run(const BodyMessage& message) noexcept {
  if (message.run == run_) return;
  run_ = message.run;
  pass_on(true);
  line_.forget();
  // One interval further, so that the times of a file's rows rise.
  sample_offset_ += time_ - message.bodies.time + options_.sample_interval;
  time_ = message.bodies.time;
  ticked_ns_ = 0;
  next_sample_ = time_;
  sampled_ = time_ - options_.sample_interval;
}

/// What the host says of its pace, smoothed: a damper takes it times a velocity.
void Servo::follow_pace(const BodyMessage& message) noexcept {
  const bool moving = message.rate > 0.0;
  // A tick a step: the hands' time is the world's, however long a step takes, and runs repeat bitwise.
  const double said = lockstep_ ? 1.0 : std::clamp(message.rate, kSlowestFelt, 1.0);
  if (moving) pace_ = moving_ ? pace_ + options_.period / kPaceMemory * (said - pace_) : said;
  moving_ = moving;
}

/// On to where the world is now, never beyond `most`, and evenly: states that are late or early by some ms
/// are no reason for hands and replicas to stand and to leap.
void Servo::follow_time(double now, double most, std::int64_t now_ns) noexcept {
  const double even = ticked_ns_ == 0 ? 0.0 : pace_ * to_seconds(now_ns - ticked_ns_);
  ticked_ns_ = now_ns;
  const double on = now - time_;
  if (lockstep_ || !moving_ || even <= 0.0 || on > kFarBehind ||
      (on >= kMinOn * even && on <= kMaxOn * even)) {
    time_ = std::max(time_, now);
    return;
  }
  const double step = std::clamp(on, kMinOn * even, kMaxOn * even);
  time_ = std::max(time_, std::min(time_ + step, most));
}

bool Servo::read_device(Hand& hand, std::int64_t now_ns) noexcept {
  const DeviceReading& reading = hand.port->read({time_, options_.period, stands_}, now_ns);
  if (reading.number == hand.readings) {
    // Nothing new: the hand is where it was, and not known to move.
    if (to_seconds(now_ns - hand.read_ns) > kHoldStale) hand.good.twist = Twist{};
    return false;
  }
  const bool first = hand.readings == 0;
  const double elapsed = std::max(to_seconds(reading.stamp_ns - hand.read_ns), options_.period);
  hand.readings = reading.number;
  // What is no pose tells nothing of the hand: one that comes for ever is silence, and its force fades.
  if (!is_sound(reading.report)) {
    rejected_.fetch_add(1, std::memory_order_relaxed);
    note(kStatusInputRejected);
    hand.good.twist = Twist{};
    return false;
  }
  hand.read_ns = reading.stamp_ns;
  hand.read_time = reading.time;
  const DeviceReport before = hand.good;
  hand.good = reading.report;
  if (keep_in_workspace(hand.good.pose, hand.good.twist, hand.limits)) note(kStatusForceLimited);
  const double speed = std::max(glm::length(before.twist.linear), glm::length(hand.good.twist.linear));
  return !first && leapt(before.pose.position, hand.good.pose.position, speed, elapsed);
}

void Servo::post_pose(std::size_t i, const Hand& hand) noexcept {
  PoseMessage& up = channel_.pose(i).back();
  up.stamp_ns = hand.read_ns;
  up.time = hand.read_time;
  up.device = static_cast<std::uint32_t>(i);
  up.pose = hand.good.pose;
  // By the world's time, in which a hand is faster the slower the world is; no faster than hosts take.
  up.twist = sped_up(hand.good.twist, pace_of(hand));
  bool limited = false;
  up.twist.linear = limit_length(up.twist.linear, kMaxSpeed, limited);
  up.twist.angular = limit_length(up.twist.angular, kMaxTurning, limited);
  up.engaged = hand.good.engaged;
  up.felt = hand.felt.felt();
  up.counted = held_.counted(i);
  up.energy = held_.energy(i);
  channel_.pose(i).publish();
}

/// A body that left the world stands where it was, and one that is away is nowhere: a spring to it would be
/// one to nothing.
bool Servo::is_gone(const BodySnapshot& bodies, int body) const noexcept {
  const auto at = static_cast<std::size_t>(body);
  return at < bodies.bodies.size() && (bodies.bodies[at].gone || bodies.bodies[at].away());
}

/// Whether a hand but that of grip `i` holds the body, as far as the world says.
bool Servo::another_holds(const BodyMessage& message, std::size_t i) const noexcept {
  const BodySnapshot& bodies = message.bodies;
  for (std::size_t j = 0; j < bodies.grips.size() && j < hands_.size(); ++j) {
    const Wrench& felt = bodies.grips[j].on_hand;
    const bool stand = j < message.hands.size() && message.hands[j].stand;
    if (j != i && hands_[j].body == hands_[i].body && !stand &&
        (felt.force != glm::dvec3(0.0) || felt.torque != glm::dvec3(0.0)))
      return true;
  }
  return false;
}

void Servo::tick(std::int64_t now_ns) noexcept {
  tick(now_ns, channel_.bodies().update());
}

void Servo::tick_in_lockstep() noexcept {
  lockstep_ = true;
  const bool fresh = channel_.bodies().update();
  tick(channel_.bodies().front().stamp_ns, fresh);
}

void Servo::tick(std::int64_t now_ns, bool fresh) noexcept {
  const BodyMessage& message = channel_.bodies().front();
  const BodySnapshot& bodies = message.bodies;
  const double age = to_seconds(now_ns - message.stamp_ns);  // negative while the state is still to come

  const StateFreshness world = link_freshness_.update(message, fresh, now_ns);
  const bool fresh_newest = channel_.newest().update();
  states_apart_ = states_apart_ || fresh_newest;
  if (states_apart_)
    held_.update(channel_.newest().front(), fresh_newest, now_ns);
  else
    held_.update(message, fresh, now_ns);
  follow_run(message);
  follow_pace(message);
  note_steps(message);
  // Simulated time now: the newest state's, carried on at the pace the world runs; grips by two ticks at
  // most.
  const double longest = 2.0 * message.time_step;
  const double farthest = std::max(longest, message.carry_on);
  const double before = time_;
  follow_time(bodies.time + std::clamp(age * message.rate, -longest, farthest), bodies.time + farthest,
              now_ns);
  const double ahead = std::clamp(time_ - bodies.time, -longest, longest);

  const bool stopped = message.rate <= 0.0 && bodies.tick > 0;
  stands_ = stopped || (bodies.tick > 0 && world.share < 1.0);
  const bool samples = sample_due(stopped);
  if (ticks_ == 0) first_tick_ns_ = tick_before_ns_ = now_ns;
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    Hand& hand = hands_[i];
    DevicePort* const wanted = claim_device(hand);
    const bool parting = parts(hand, wanted);
    if (wanted != hand.port && !parting) change_device(hand, wanted);
    follow_stiffness(i, hand, bodies, time_ - before);
    if (hand.port == nullptr) {
      held_.not_here(i);
      continue;
    }
    const Pose was = hand.good.pose;
    hand.leapt = read_device(hand, now_ns) || held_.anew(i);
    if (!hand.leapt) held_.read(i, was, hand.good.pose);
    if (parting || is_gone(bodies, hand.body)) hand.good.engaged = false;
  }
  held_.catch_up(now_ns, options_.period, pace_, time_ - before);
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    Hand& hand = hands_[i];
    DevicePort* const port = hand.port;
    if (port == nullptr) continue;
    double device_share =
        hand.readings == 0 ? 0.0 : freshness(to_seconds(now_ns - hand.read_ns), options_.period);
    if (const double left = port->left(); left < 1.0 && port->device().gives_way()) {
      hand.felt.faded(left);
      device_share = std::min(device_share, left);
    }

    ForceLimiter::Outcome felt;
    SignalSample signals;
    if (i < bodies.grips.size()) {
      GripState grip = bodies.grips[i];
      grip.pose = extrapolate(grip.pose, grip.twist, ahead);
      if (port->device().gives_way()) grip = held_.grip(i, grip);
      felt = hand.felt.feel(world, hand.good, grip,
                            {time_, options_.period, device_share, hand.leapt, another_holds(message, i),
                             message.stands_until_felt, pace_of(hand)},
                            [&](const Wrench& wanted) {
                              const double elapses = options_.period * (hand.with_world ? pace_ : 1.0);
                              const Wrench safe =
                                  held_.guard(i, wanted, hand.good.pose, hand.good.twist, elapses,
                                              hand.limits.max_damping, pace_of(hand));
                              signals.coupled = wanted;
                              signals.guarded = port->device().gives_way() ? safe : wanted;
                              signals.guarded.force += guidance(hand);
                              return signals.guarded;
                            });
      held_.sent(i, felt.wrench,
                 {true, hand.felt.holds(), hand.felt.held().pose, hand.felt.held().twist,
                  port->device().gives_way()},
                 hand.felt.ramp_work(), hand.with_world);
    }
    hand.given = felt.wrench;
    if (felt.limited) note(kStatusForceLimited);
    hand.budget.note(felt.asked_force, felt.asked_torque, hand.limits, options_.period);
    if (felt.non_finite) note(kStatusNonFinite);
    if (!let_go_) port->write(felt.wrench);
    // A device that does not answer is not spoken for: the host takes its hand for silent, as it is.
    // In one process only a slow world is silent: a hand that does not give way goes on as its script has it.
    const bool waits_for_a_step = message.heard_pose_ns == kPoseNotTold && !port->device().gives_way();
    if (device_share >= 1.0 && (link_freshness_.speaks() || waits_for_a_step)) post_pose(i, hand);

    if (options_.signals) {
      signals.wanted = felt.wanted;
      note_signals(i, signals, now_ns);
    }
    if (!samples) continue;
    if (line_.full()) pass_on(true);
    line_.add({sample_offset_ + time_, static_cast<std::uint32_t>(i), felt.wrench, hand.good.pose}, time_,
              hand.felt.follows_world());
  }
  held_.advance(now_ns + to_nanoseconds(options_.period), pace_, time_ - before);
  pass_on(false);
  ticks_ += 1;
  tick_before_ns_ = now_ns;
  if (samples) {
    sampled_ = time_;
    // On the grid of intervals, whatever the tick that met it: rows stay evenly spread over the run.
    const double interval = options_.sample_interval;
    next_sample_ = interval * (std::floor((time_ + kRounding) / interval) + 1.0);
  }
  shown_time_.store(time_, std::memory_order_relaxed);
}

}  // namespace slosh
