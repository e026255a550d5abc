#include "peer/haptics/held_bodies.h"

#include <algorithm>
#include <cmath>

#include "net/clock.h"
#include "net/engagement.h"
#include "peer/haptics/freshness.h"

namespace slosh {
namespace {

constexpr double kShareRise = 0.5;  // s over which the replica comes in, or goes
/// N·s/m: more would shake a hand of 1 kg that is felt each ms, whatever its device holds.
constexpr double kMaxDamping = 100.0;
constexpr double kLongestTick = 0.02;  // s: a loop that was stopped goes on from where it was
/// s of missed ticks that are caught up with, at most: after a longer gap hands re-engage, as after any
/// silence. A quick host's updates would be stale by then; one of few steps is waited for longer than this
/// (freshness()).
constexpr double kMaxCaughtUp = kHoldAnew;
/// s of simulated time by which a host carries a pose on at most (host/input_gate.h).
constexpr double kMaxCarried = 0.02;

FluidLoad load_of(const FluidWrenchModel& model) {
  FluidLoad load;
  load.d_pose = model.d_pose;
  load.d_velocity = model.d_velocity;
  load.added_mass = model.added_mass;
  load.trust_distance = model.trust_radius;
  load.trust_angle = model.trust_angle;
  return load;
}

ReplicaBody replica_of(const Scene& scene, const Body& body, const MassProperties& mass) {
  return {mass.mass, body.point_probe ? glm::dmat3(1.0) : mass.inertia, mass.center_of_mass, body.point_probe,
          scene.gravity};
}

}  // namespace

HeldBodies::HeldBodies(const Scene& scene, Coupling coupling)
    : scene_(scene), coupling_(coupling), places_(scene.grips.size()) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& source = scene.bodies[b];
    std::vector<ReplicaGrip> grips;
    std::vector<std::size_t> places;
    for (std::size_t g = 0; g < scene.grips.size(); ++g) {
      const Grip& grip = scene.grips[g];
      if (grip.body != static_cast<int>(b)) continue;
      grips.push_back(
          {grip.pose, {grip.stiffness, grip.damping, grip.rotational_stiffness, grip.rotational_damping}});
      places.push_back(g);
    }
    if (grips.empty() || source.motion != BodyMotion::kFree || !(source.mass.mass > 0.0)) continue;
    const ReplicaBody body = replica_of(scene, source, source.mass);
    for (std::size_t i = 0; i < places.size(); ++i)
      places_[places[i]] = {static_cast<int>(bodies_.size()), i};
    const std::size_t count = grips.size();
    // The first update comes before the first tick has said which hands are here.
    bodies_.push_back({b, std::move(places), HeldBody(body, std::move(grips)),
                       std::vector<OwnHand>(count, {.here = true, .feels = true}),
                       std::vector<MotionError>(count), std::vector<HostHand>(count), 0.0, false, false,
                       source.mass});
  }
}

void HeldBodies::update(const BodyMessage& newest, bool fresh, std::int64_t now_ns) noexcept {
  began_ = false;
  for (Entry& entry : bodies_) entry.anew = false;
  const bool stands = newest.rate <= 0.0;
  const bool gone = advanced_ns_ != 0 && to_seconds(now_ns - advanced_ns_) > kMaxCaughtUp;
  if (!fresh || stands) {
    if (stands || gone) rate_ = 0.0;
    if (gone) {
      for (Entry& entry : bodies_) restart(entry);
    }
    return;
  }
  here_ = newest.heard_pose_ns == kPoseNotTold;
  // After a pause, a silence or a reset the body is where the host says, whatever was here.
  const bool begin = gone || rate_ <= 0.0 || newest.run != run_ ||
                     freshness(to_seconds(now_ns - received_ns_), interval_) < 1.0;
  began_ = begin;
  rate_ = newest.rate;
  interval_ = newest.time_step / newest.rate;
  run_ = newest.run;
  received_ns_ = now_ns;
  for (Entry& entry : bodies_) {
    const bool nobody = std::ranges::none_of(entry.own, &OwnHand::here);
    if (begin || (nobody && entry.held.started())) restart(entry);
    follow_cuts(entry, newest.bodies.cuts.get());
    if (nobody)
      entry.share = 0.0;  // what nobody here holds is not worked out: whoever takes it up begins anew
    else
      tell(entry, newest, now_ns);
  }
}

void HeldBodies::restart(Entry& entry) noexcept {
  // Whoever holds the host's body as it is goes on with that.
  entry.anew = entry.share > 0.0 && entry.held.started();
  entry.held.restart();
  entry.model_tick = 0;
}

void HeldBodies::follow_cuts(Entry& entry, const BodyCuts* cuts) noexcept {
  const Body& body = scene_.bodies[entry.body];
  const BodyCut* const cut = cuts ? cuts->of(entry.body) : nullptr;
  const MassProperties& mass = cut ? cut->mass : body.mass;
  if (mass == entry.mass) return;
  entry.mass = mass;
  entry.held.become(replica_of(scene_, body, mass));
  restart(entry);
}

void HeldBodies::tell(Entry& entry, const BodyMessage& newest, std::int64_t now_ns) noexcept {
  const BodySnapshot& bodies = newest.bodies;
  if (entry.body >= bodies.bodies.size()) return;
  for (const FluidWrenchModel& model : newest.fluid_models) {
    if (model.body == entry.body && model.tick > entry.model_tick) {
      entry.held.set_fluid(load_of(model));
      entry.model_tick = model.tick;
    }
  }
  for (std::size_t i = 0; i < entry.grips.size(); ++i) {
    const std::size_t g = entry.grips[i];
    HostHand& said = entry.said[i];
    said = HostHand{};
    if (g >= bodies.grips.size()) continue;
    const GripState& grip = bodies.grips[g];
    said.handle = grip.handle;
    said.on_hand = grip.on_hand;
    said.engaged = grip.on_hand.force != glm::dvec3(0.0) || grip.on_hand.torque != glm::dvec3(0.0);
    if (g >= newest.hands.size()) continue;
    const HandWord& word = newest.hands[g];
    said.counted = word.counted;
    said.energy = word.energy;
    if (word.read_ns == 0) continue;
    // The step began with the reading carried on to its beginning, and goes on to its end.
    const double late = std::clamp(bodies.time - newest.time_step - word.time, -kMaxCarried, kMaxCarried);
    said.ack_ns = word.read_ns + to_nanoseconds((newest.time_step + late) / std::max(newest.rate, 0.1));
  }
  const BodyState& body = bodies.bodies[entry.body];
  HostUpdate word;
  word.now_ns = now_ns;
  word.time = bodies.time;
  word.time_step = newest.time_step;
  word.pace = std::clamp(newest.rate, 0.0, 1.0);
  word.motion = {body.center_of_mass, body.pose.orientation, body.twist};
  word.hands = entry.said;
  word.tells_fluid = true;
  word.fluid = body.fluid;
  word.felt = std::ranges::any_of(entry.own, &OwnHand::feels);
  entry.held.receive(word);
}

bool HeldBodies::anew(std::size_t i) const noexcept {
  const int body = places_[i].body;
  return body >= 0 && bodies_[static_cast<std::size_t>(body)].anew;
}

double HeldBodies::share(std::size_t i) const noexcept {
  const int body = places_[i].body;
  return body < 0 ? 0.0 : bodies_[static_cast<std::size_t>(body)].share;
}

LoopDelay HeldBodies::delay(std::size_t i) const noexcept {
  const int body = places_[i].body;
  return body < 0 ? LoopDelay{} : bodies_[static_cast<std::size_t>(body)].held.delay();
}

double HeldBodies::energy(std::size_t i) const noexcept {
  const Place& place = places_[i];
  return place.body < 0 ? 0.0 : bodies_[static_cast<std::size_t>(place.body)].held.energy(place.grip);
}

GripState HeldBodies::grip(std::size_t i, const GripState& at_host) const noexcept {
  const Place& place = places_[i];
  if (place.body < 0) return at_host;
  const Entry& entry = bodies_[static_cast<std::size_t>(place.body)];
  if (entry.share <= 0.0 || !entry.held.started()) return at_host;
  return between(at_host, entry.held.grip(place.grip), entry.share);
}

Wrench HeldBodies::guard(std::size_t i, const Wrench& wanted, const Pose& hand, const Twist& twist, double dt,
                         double most_damping, double pace) noexcept {
  const Place& place = places_[i];
  if (place.body < 0) return wanted;
  Entry& entry = bodies_[static_cast<std::size_t>(place.body)];
  const Wrench limited =
      entry.held.limit(place.grip, wanted, hand, twist, dt, std::min(most_damping, kMaxDamping), pace);
  if (entry.share <= 0.0) return wanted;
  return {wanted.force + entry.share * (limited.force - wanted.force),
          wanted.torque + entry.share * (limited.torque - wanted.torque)};
}

void HeldBodies::read(std::size_t i, const Pose& before, const Pose& now) noexcept {
  const Place& place = places_[i];
  if (place.body < 0) return;
  MotionError& way = bodies_[static_cast<std::size_t>(place.body)].way[place.grip];
  way.position = now.position - before.position;
  way.turn = rotation_between(before.orientation, now.orientation);
}

void HeldBodies::catch_up(std::int64_t now_ns, double period, double pace, double elapsed) noexcept {
  caught_up_ = 0.0;
  const double missed = advanced_ns_ == 0 ? 0.0 : to_seconds(now_ns - advanced_ns_);
  // A replica that began with the newest update is where it should be.
  const bool late = missed > 0.5 * period && missed <= kMaxCaughtUp && !began_;
  if (late) {
    caught_up_ = std::clamp(elapsed - pace * period, 0.0, pace * missed);
    for (Entry& entry : bodies_) {
      const double whole = entry.on_the_wall ? (rate_ > 0.0 ? pace * missed : 0.0) : caught_up_;
      const int steps = static_cast<int>(std::ceil(missed / period));
      if (!(whole > 0.0)) continue;
      // The tick after the last reading is gone already.
      const double since = whole + pace * period;
      for (std::size_t g = 0; g < entry.own.size(); ++g) {
        OwnHand& hand = entry.own[g];
        hand.twist = {entry.way[g].position / since, entry.way[g].turn / since};
        hand.handle = extrapolate(hand.handle, hand.twist, pace * period);
      }
      for (int k = 0; k < steps; ++k) {
        const std::int64_t then_ns = now_ns - to_nanoseconds(missed * (steps - 1 - k) / steps);
        entry.held.advance(entry.own, whole / steps, then_ns);
        for (OwnHand& hand : entry.own) hand.handle = extrapolate(hand.handle, hand.twist, whole / steps);
      }
    }
    advanced_ns_ = now_ns;
  }
  for (Entry& entry : bodies_) {
    std::fill(entry.way.begin(), entry.way.end(), MotionError{});
    entry.on_the_wall = false;
  }
}

void HeldBodies::sent(std::size_t i, const Wrench& wrench, const OwnHand& hand, double ramp_work,
                      bool with_world) noexcept {
  const Place& place = places_[i];
  if (place.body < 0) return;
  Entry& entry = bodies_[static_cast<std::size_t>(place.body)];
  entry.held.sent(place.grip, wrench, ramp_work);
  entry.own[place.grip] = hand;
  entry.on_the_wall = entry.on_the_wall || !with_world;
}

void HeldBodies::set_gains(std::size_t i, const CouplingGains& gains) noexcept {
  const Place& place = places_[i];
  if (place.body >= 0) bodies_[static_cast<std::size_t>(place.body)].held.set_gains(place.grip, gains);
}

void HeldBodies::not_here(std::size_t i) noexcept {
  const Place& place = places_[i];
  if (place.body >= 0) bodies_[static_cast<std::size_t>(place.body)].own[place.grip] = OwnHand{};
}

void HeldBodies::advance(std::int64_t now_ns, double pace, double elapsed) noexcept {
  const double passed = advanced_ns_ == 0 ? 0.0 : to_seconds(now_ns - advanced_ns_);
  advanced_ns_ = now_ns;
  const double tick = std::clamp(passed, 0.0, kLongestTick);
  for (Entry& entry : bodies_) {
    const LoopDelay delay = entry.held.delay();
    const double far = (delay.round_trip + delay.jitter - kNear) / (kFar - kNear);
    const bool modelled = entry.model_tick != 0;
    double goal = here_ ? (modelled ? 1.0 : 0.0) : std::clamp(far, 0.0, 1.0);
    if (coupling_ == Coupling::kSpring) goal = 0.0;
    entry.share += std::clamp(goal - entry.share, -tick / kShareRise, tick / kShareRise);
    if (here_ && !modelled) entry.share = 0.0;
    const double wall = rate_ > 0.0 ? tick * pace : 0.0;
    const double step = entry.on_the_wall ? wall : std::clamp(elapsed - caught_up_, 0.0, kLongestTick);
    entry.held.advance(entry.own, step, now_ns);
  }
}

}  // namespace slosh
