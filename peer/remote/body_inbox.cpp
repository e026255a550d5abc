#include "peer/remote/body_inbox.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "net/clock.h"
#include "net/engagement.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxPending = 256;
constexpr std::size_t kKeptCuts = 32;
constexpr double kCarryOn = 0.5;          // s
constexpr double kIntervalShare = 0.05;   // of a new interval in the smoothed one
constexpr double kLongestInterval = 0.1;  // s
// Kept back is what loses this much lateness a s: a host's clock and a changing route lose far less.
constexpr double kDraining = 0.25;
constexpr double kDrainLook = 0.02;  // s over which that is looked at
constexpr double kAsUsual = 0.005;   // s above the delay at which a state is in time again
constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();

}  // namespace

double WorldMoment::time_at(std::int64_t host_ns) const {
  return time + rate * std::clamp(to_seconds(host_ns - stamp_ns), -kCarryOn, kCarryOn);
}

bool Backlog::holds(double lateness, double usual, std::int64_t now_ns) {
  const bool stood = last_ns_ != 0 && now_ns - last_ns_ > to_nanoseconds(kHoldAnew);
  last_ns_ = now_ns;
  if (stood) {
    draining_ = true;
    mark_ns_ = now_ns;
    mark_ = lateness;
  }
  if (!draining_) return false;
  if (lateness <= usual + kAsUsual) return draining_ = false;
  const double since = to_seconds(now_ns - mark_ns_);
  if (since >= kDrainLook) {
    draining_ = mark_ - lateness > kDraining * since;
    mark_ns_ = now_ns;
    mark_ = lateness;
  }
  return draining_;
}

BodyInbox::BodyInbox(const Scene& scene, double time_step)
    : scene_(scene), time_step_(time_step), interval_(time_step) {
  state_.time_step = time_step;
  state_.heard_pose_ns = 0;
  BodySnapshot& bodies = state_.bodies;
  for (const Body& body : scene.bodies) {
    BodyState& at = bodies.bodies.emplace_back();
    at.pose = body.pose;
    at.twist = body.twist;
    at.center_of_mass = transform_point(body.pose, body.mass.center_of_mass);
  }
  bodies.grips.resize(scene.grips.size());
  place_grips(bodies);
  for (GripState& grip : bodies.grips) grip.handle = grip.pose;
  state_.hands.resize(scene.grips.size());
  newest_ = state_;
}

void BodyInbox::restart() {
  state_.fluid_models.clear();
  models_run_ = 0;
  cuts_.clear();  // a host tells them anew
  pending_.clear();
  given_ = newest_fresh_ = false;
  newest_tick_ = 0;
  moment_.known = false;
  delay_.restart();
  backlog_.restart();
}

bool BodyInbox::sound(const wire::Bodies& part) const {
  if (part.part >= part.parts) return false;
  const auto known = [&](const wire::BodyEntry& entry) { return entry.body < scene_.bodies.size(); };
  const auto held = [&](const wire::GripEntry& entry) { return entry.grip < scene_.grips.size(); };
  return std::all_of(part.bodies.begin(), part.bodies.end(), known) &&
         std::all_of(part.grips.begin(), part.grips.end(), held);
}

void BodyInbox::take(const wire::Bodies& part, std::int64_t now_ns, const ClockSync& clock) {
  if (!sound(part)) {
    counts_.wrong += 1;
    return;
  }
  const std::uint32_t run = pending_.empty() ? state_.run : pending_.front().run;
  const bool anything = given_ || !pending_.empty();
  if (anything && part.run != run) {
    if (part.run < run) {
      counts_.late += 1;
      return;
    }
    pending_.clear();  // the world was reset
    given_ = false;
  }
  // What came too late says most about how late things come. A world at rest is told of again and again.
  if (part.rate > 0.0 && !(given_ && part.tick == given_tick_)) {
    const double lateness = to_seconds(now_ns - clock.to_peer(part.stamp_ns));
    if (!backlog_.holds(lateness, delay_.value(), now_ns)) delay_.add(lateness);
  }
  if (given_ && part.tick == given_tick_ && part.rate <= 0.0) {
    stands_on_ = true;
    return;
  }
  if (given_ && part.tick <= given_tick_) {
    counts_.late += 1;
    return;
  }
  const auto place = std::lower_bound(pending_.begin(), pending_.end(), part.tick,
                                      [](const Pending& p, std::uint64_t tick) { return p.tick < tick; });
  const bool fresh = place == pending_.end() || place->tick != part.tick;
  if (fresh && pending_.size() >= kMaxPending) {
    counts_.late += 1;  // nobody takes them, or the host sends the future: not worth more memory
    return;
  }
  Pending& pending = fresh ? *pending_.insert(place, Pending{}) : *place;
  if (fresh) {
    pending.run = part.run;
    pending.tick = part.tick;
    pending.time = part.time;
    pending.stamp_ns = part.stamp_ns;
    pending.rate = part.rate;
    pending.status = part.status;
    pending.heard_pose_ns = part.pose_number == 0 ? 0 : part.pose_stamp_ns;
    pending.parts = part.parts;
  }
  if (pending.received.test(part.part)) {
    counts_.late += 1;
    return;
  }
  pending.received.set(part.part);
  pending.bodies.insert(pending.bodies.end(), part.bodies.begin(), part.bodies.end());
  pending.grips.insert(pending.grips.end(), part.grips.begin(), part.grips.end());
  counts_.parts += 1;
  const bool newest = !moment_.known || part.run > moment_.run ||
                      (part.run == moment_.run && part.stamp_ns >= moment_.stamp_ns);
  if (newest) moment_ = {part.run, part.time, part.stamp_ns, part.rate, true};
  if (pending.complete() && (part.run > newest_.run || part.tick > newest_tick_)) {
    newest_tick_ = part.tick;
    newest_.time_step = time_step_;
    newest_.stamp_ns = clock.to_peer(part.stamp_ns);
    lay_out(pending, newest_);
    newest_.fluid_models = state_.fluid_models;
    newest_fresh_ = true;
  }
}

const BodyMessage* BodyInbox::newest() {
  if (!std::exchange(newest_fresh_, false)) return nullptr;
  if (paused_) newest_.rate = 0.0;
  return &newest_;
}

void BodyInbox::take(const wire::FluidWrench& message) {
  if (message.body >= scene_.bodies.size()) {
    counts_.wrong += 1;
    return;
  }
  std::vector<FluidWrenchModel>& models = state_.fluid_models;
  if (message.run < models_run_) return;
  if (message.run > models_run_) models.clear();
  models_run_ = message.run;
  const auto same = std::find_if(models.begin(), models.end(),
                                 [&](const FluidWrenchModel& known) { return known.body == message.body; });
  if (same != models.end() && same->tick >= message.tick) return;
  counts_.models += 1;
  if (same == models.end())
    models.push_back(wire::to_model(message));
  else
    *same = wire::to_model(message);
}

void BodyInbox::take(const wire::Cuts& message) {
  // States are given out by the delay and a jump of it later: more cuts than this are not in that time.
  if (cuts_.size() >= kKeptCuts) cuts_.erase(cuts_.begin());
  cuts_.push_back({message.run, std::make_shared<BodyCuts>(wire::to_cuts(message, scene_.bodies.size()))});
}

std::int64_t BodyInbox::due_ns(const Pending& pending, const ClockSync& clock) const {
  return clock.to_peer(pending.stamp_ns) + to_nanoseconds(delay_.value());
}

const BodyMessage* BodyInbox::next(std::int64_t now_ns, const ClockSync& clock) {
  delay_.advance(std::clamp(to_seconds(now_ns - advanced_ns_), 0.0, 1.0));
  advanced_ns_ = now_ns;
  std::size_t due = 0;
  // A tick early is in time: the device loop carries states back as well as on.
  const std::int64_t reach_ns = now_ns + to_nanoseconds(time_step_);
  while (due < pending_.size() && due_ns(pending_[due], clock) <= reach_ns) due += 1;
  if (due > 0) {
    // All of them, oldest first: a part that is missing in the newest may be in the one before.
    for (std::size_t i = 0; i < due; ++i) apply(pending_[i], clock);
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(due));
    pause_told_ = false;
  } else if (stands_on_) {
    state_.rate = 0.0;
  } else if (!paused_ || pause_told_) {
    return nullptr;
  }
  stands_on_ = false;
  if (paused_) {
    state_.rate = 0.0;
    pause_told_ = true;
  }
  return &state_;
}

std::int64_t BodyInbox::next_due_ns(const ClockSync& clock) const {
  if (pending_.empty()) return kNever_ns;
  return due_ns(pending_.front(), clock) - to_nanoseconds(time_step_);
}

void BodyInbox::apply(const Pending& pending, const ClockSync& clock) {
  const double interval = pending.time - state_.bodies.time;
  if (given_ && interval > 0.0 && interval < kLongestInterval) {
    interval_ += kIntervalShare * (interval - interval_);
  }
  if (pending.run > models_run_) {
    state_.fluid_models.clear();
    models_run_ = pending.run;
  }
  // What a device loop takes for a tick is how often states come.
  state_.time_step = std::max(time_step_, interval_);
  state_.carry_on = kHoldAnew;
  state_.stamp_ns = due_ns(pending, clock);
  lay_out(pending, state_);
  given_ = true;
  given_tick_ = pending.tick;
  started_ = started_ || pending.complete();
  counts_.states += 1;
  if (!pending.complete()) counts_.incomplete += 1;
}

void BodyInbox::lay_out(const Pending& pending, BodyMessage& state) const {
  BodySnapshot& bodies = state.bodies;
  state.run = pending.run;
  state.rate = pending.rate;
  state.heard_pose_ns = pending.heard_pose_ns;
  bodies.tick = pending.tick;
  bodies.time = pending.time;
  bodies.status = pending.status;
  bodies.cuts = nullptr;
  for (const RunCuts& known : cuts_)
    if (known.run == pending.run && known.cuts->since <= pending.tick) bodies.cuts = known.cuts;
  for (const wire::BodyEntry& entry : pending.bodies) {
    bodies.bodies[entry.body] = {entry.pose, entry.twist, entry.center_of_mass, entry.fluid};
  }
  for (const wire::GripEntry& entry : pending.grips) {
    bodies.grips[entry.grip].handle = entry.handle;
    bodies.grips[entry.grip].on_hand = entry.on_hand;
    bodies.grips[entry.grip].stiffness = entry.stiffness;
    state.hands[entry.grip] = {entry.pose_number, 0, 0.0, entry.counted, entry.energy, entry.stand};
  }
  place_grips(bodies);
}

void BodyInbox::place_grips(BodySnapshot& bodies) const {
  for (std::size_t g = 0; g < bodies.grips.size(); ++g) {
    const Grip& grip = scene_.grips[g];
    const BodyState& body = bodies.bodies[static_cast<std::size_t>(grip.body)];
    GripState& state = bodies.grips[g];
    state.pose = compose(body.pose, grip.pose);
    state.twist.angular = body.twist.angular;
    state.twist.linear =
        body.twist.linear + glm::cross(body.twist.angular, state.pose.position - body.center_of_mass);
  }
}

}  // namespace slosh
