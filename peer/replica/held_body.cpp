#include "peer/replica/held_body.h"

#include <algorithm>
#include <cmath>

#include "net/clock.h"

namespace slosh {
namespace {

/// s for which another site's hand, and the host's body for a spring to it, are carried on by their twists.
constexpr double kCarriedOn = 0.02;
constexpr double kTwistForesees = 0.01;  // s for which a hand goes about as it went
/// s over which the share of ticks with a passivity controller firing is averaged, the share that is too
/// much, and s of quiet time after which the replica is tried again.
constexpr double kFiringMemory = 0.5;
constexpr double kFiresTooOften = 0.5;
constexpr double kQuietTime = 3.0;
constexpr double kChange = 0.5;  // s over which one goes over into the other
/// s for which the fluid's model holds without an update, and over which it then goes.
constexpr double kLoadHolds = 0.1;
constexpr double kLoadFades = 0.3;
/// s of the body's time between two updates beyond which they say nothing of its acceleration.
constexpr double kLongestStep = 0.1;
/// N of a change that is not foreseen at which the whole damping acts, and s for which that is remembered.
constexpr double kDisturbance = 15.0;
constexpr double kDisturbanceMemory = 5.0;
/// N and N·m by which the damped spring may be stretched by the delay alone, whatever the host has in it.
constexpr double kMinStretch = 1.0;
constexpr double kMinTwist = 0.1;
/// J: where nobody counts for another hand, nothing that comes out is too much.
constexpr double kUncounted = 1e9;
/// J by which the balance may be more than the replica holds, and s, or round trips if that is longer, over
/// which what is beyond is forgotten: dampers used it up. Until then it may be on its way to another hand.
constexpr double kKept = 2e-3;
constexpr double kLoadRoundTrips = 2.0;  // after which a table that is met counts as told of
constexpr double kForesees = 2.0;
constexpr double kFullUncertainty = 3.0;
/// N that updates' forces may be off by as they are rounded: no contact. Model uncertainty acts as friction,
/// however small it is (tests/notebook/2026-11-27-rounding-is-no-contact.md).
constexpr double kRounding = 0.1;
constexpr double kForgets = 1.0;
constexpr double kForgetsRoundTrips = 4.0;
constexpr double kForgives = 1.0;  // s, in which a debt that others made is forgiven

/// What of `load` acts whatever the body does; `damped`: but for what its damper answers.
glm::dvec3 still_force(const FluidLoad& load, bool damped) {
  const double share = damped ? 0.0 : 1.0;
  const Vector6 v{load.twist.linear.x,  load.twist.linear.y,  load.twist.linear.z,
                  load.twist.angular.x, load.twist.angular.y, load.twist.angular.z};
  glm::dvec3 force;
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    force[i] = load.wrench[row];
    for (std::size_t j = 0; j < 6; ++j) force[i] -= share * load.d_velocity[row][j] * v[j];
  }
  return force;
}

}  // namespace

HeldBody::HeldBody(const ReplicaBody& body, std::vector<ReplicaGrip> grips, const ReplicaTuning& tuning)
    : body_(body),
      replica_(body, grips, tuning),
      hands_(grips.size()),
      speeds_(grips.size()),
      guards_(grips.size()),
      load_work_(body, grips),
      follows_slosh_(tuning.follows_slosh),
      carried_(body),
      on_hands_(grips.size()),
      used_(grips.size()) {
  for (const ReplicaGrip& grip : grips) {
    grips_.push_back(grip.pose);
    gains_.push_back(grip.gains);
  }
}

void HeldBody::restart() noexcept {
  started_ = false;
  delay_.restart();
  load_work_.restart();
  fluid_ = FluidLoad{};
  carried_.restart();
  slosh_share_ = 0.0;
  std::fill(on_hands_.begin(), on_hands_.end(), Wrench{});
  for (ReplicaHand& hand : hands_) hand.engaged = false;
  for (VelocityWindow& speed : speeds_) speed.forget();
  firing_ = quiet_ = disturbance_ = model_uncertainty_ = quiet_load_ = 0.0;
  fallen_back_ = false;
  spring_ = 0.0;
}

/// What acts on the body besides couplings and the fluid's answer to its acceleration: fluid, weight,
/// contacts.
FluidLoad HeldBody::load_of(const HostUpdate& word) noexcept {
  const RigidMotion& now = word.motion;
  const double elapsed = word.time - heard_time_;
  Vector6 pace{};  // linear and angular acceleration
  const bool known = started_ && elapsed > 0.0 && elapsed < kLongestStep;
  if (known) {
    const glm::dvec3 a = (now.twist.linear - heard_.twist.linear) / elapsed;
    const glm::dvec3 b = (now.twist.angular - heard_.twist.angular) / elapsed;
    pace = {a.x, a.y, a.z, b.x, b.y, b.z};
  }
  const glm::dmat3 r = glm::mat3_cast(now.orientation);
  const glm::dmat3 inertia = r * body_.inertia * glm::transpose(r);
  const glm::dvec3 turning{pace[3], pace[4], pace[5]};
  glm::dvec3 force = body_.mass * glm::dvec3(pace[0], pace[1], pace[2]);
  glm::dvec3 torque = inertia * turning + glm::cross(now.twist.angular, inertia * now.twist.angular);
  // Of steps that were missed the couplings' forces are taken to have gone over evenly.
  const double steps = word.time_step > 0.0 ? std::max(std::round(elapsed / word.time_step), 1.0) : 1.0;
  const double older = known ? 0.5 * (steps - 1.0) / steps : 0.0;
  Acting acting{known ? elapsed : 0.0, heard_.twist.linear,
                now.twist.linear,      force,
                word.tells_fluid,      word.fluid.force + older * (fluid_force_ - word.fluid.force)};
  for (std::size_t g = 0; g < grips_.size() && g < word.hands.size(); ++g) {
    const Wrench& on_hand = word.hands[g].on_hand;
    const glm::dvec3 arm = now.orientation * (grips_[g].position - body_.center);
    force += on_hand.force;
    torque += glm::cross(arm, on_hand.force) + on_hand.torque;
    acting.force += on_hand.force + older * (on_hands_[g].force - on_hand.force);
    on_hands_[g] = on_hand;
  }
  if (body_.point) torque = glm::dvec3(0.0);
  tells_fluid_ = word.tells_fluid;
  fluid_force_ = word.fluid.force;
  met_ = acting.force - acting.fluid;
  FluidLoad load = fluid_;
  load.reference = {now.position, now.orientation};
  load.twist = now.twist;
  load.wrench = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    acting.told_mass[i] = fluid_.added_mass[row][row];
    acting.told_drag[i] = -fluid_.d_velocity[row][row];
  }
  if (follows_slosh_) carried_.hear(acting);
  // What others do within the delay is not known, and a mode that went by it would be driven by it.
  const double alone = follows_slosh_ && !(replica_.shared() > 0.0) ? 1.0 : 0.0;
  const double most = std::clamp(elapsed, 0.0, kLongestStep) / kChange;
  slosh_share_ += std::clamp(alone - slosh_share_, -most, most);
  carried_.put_into(load, load.wrench, pace, acting, slosh_share_, pace_ * delay_.delay().round_trip);
  return load;
}

void HeldBody::hear(const HostUpdate& word) noexcept {
  const double elapsed = started_ ? to_seconds(word.now_ns - heard_ns_) : 0.0;
  const FluidLoad load = load_of(word);
  load_work_.hear(word);
  heard_time_ = word.time;
  heard_ = word.motion;
  heard_ns_ = word.now_ns;
  pace_ = word.pace;
  step_ = std::min(word.time_step, kLongestStep);
  since_heard_ = 0.0;
  std::int64_t ack_ns = 0;
  counted_ = true;
  for (std::size_t g = 0; g < hands_.size() && g < word.hands.size(); ++g) {
    const HostHand& said = word.hands[g];
    ReplicaHand& hand = hands_[g];
    used_[g] = said.handle;
    if (!said.engaged)
      used_[g] = {heard_.position + heard_.orientation * (grips_[g].position - body_.center),
                  heard_.orientation * grips_[g].orientation};
    if (hand.own) {
      if (said.engaged && said.ack_ns != 0)
        ack_ns = ack_ns == 0 ? said.ack_ns : std::min(ack_ns, said.ack_ns);
      continue;
    }
    if (!said.engaged) speeds_[g].forget();
    // Another person's count begins elsewhere.
    if (said.engaged && !hand.engaged) stored_ += hand.energy - said.energy;
    hand.engaged = said.engaged;
    hand.handle = said.handle;
    hand.twist = said.engaged ? speeds_[g].add(said.handle, to_nanoseconds(word.time)) : Twist{};
    if (said.engaged) hand.energy = said.energy;
    counted_ = counted_ && (said.counted || !said.engaged);
  }
  if (!started_) {
    replica_.restart(word.motion);
    replica_.set_load(load);
    met_late_ = met_;
    started_ = true;
    begin_count(word);
    return;
  }
  note_disturbance(load, elapsed);
  replica_.set_load(load);
  if (ack_ns == 0) return;
  delay_.note(to_seconds(word.now_ns - ack_ns), elapsed);
  ahead_ = pace_ * std::max(to_seconds(ack_ns - word.now_ns), 0.0);
  const LoopDelay delay = delay_.delay();
  // What a hand does within a long step that its twist did not foresee acts at the host in the next.
  const double unforeseen = std::max(word.time_step - kTwistForesees, 0.0);
  replica_.set_delay({pace_ * delay.round_trip + unforeseen, pace_ * delay.jitter});
  replica_.hear({word.motion, ack_ns, load_work_.work(), carried_.states()});
}

/// What acts changes by more than is told of it: a table that is met, a fluid that nobody models. That
/// answers to this hand a round trip late, as another hand would.
void HeldBody::note_disturbance(const FluidLoad& load, double elapsed) noexcept {
  // Alone, what a damper answers to the body's own speed is foreseen.
  const bool damped = replica_.shared() > 0.0;
  const glm::dvec3 off = still_force(load, damped) - still_force(replica_.load(), damped);
  // Fluid that the replica does not follow late drives nothing, and what it gives is no gift of a table's.
  double unforeseen = glm::length(off), doubtful = unforeseen;
  if (tells_fluid_) {
    const LoopDelay delay = delay_.delay();
    const double late = kLoadRoundTrips * pace_ * (delay.round_trip + delay.jitter);
    const glm::dvec3 met = met_ - met_late_;
    met_late_ += (late > elapsed ? 1.0 - std::exp(-elapsed / late) : 1.0) * met;
    unforeseen = glm::length(met) + (1.0 - carried_.foreseen()) * glm::length(off - met);
    doubtful = glm::length(met);
  }
  const double now = std::min(unforeseen / kDisturbance, 1.0);
  const double forget = 1.0 - std::exp(-std::clamp(elapsed, 0.0, 1.0) / kDisturbanceMemory);
  disturbance_ = now > disturbance_ ? now : disturbance_ + forget * (now - disturbance_);
  const double doubt = std::clamp((doubtful - kRounding) / (kFullUncertainty - kRounding), 0.0, 1.0);
  model_uncertainty_ =
      doubt > model_uncertainty_ ? doubt : model_uncertainty_ + forget * (doubt - model_uncertainty_);
  quiet_load_ += elapsed;
  // A weight that is carried down gives; one that rests on something does not.
  replica_.believe_load(std::clamp(quiet_load_ / kForesees, 0.0, 1.0) * (1.0 - model_uncertainty_));
}

/// A body that moves and springs that are stretched already when this begins have energy to give.
void HeldBody::begin_count(const HostUpdate& word) noexcept {
  stored_ = load_work_.kinetic();
  forgotten_ = lent_ = 0.0;
  work_heard_ = replica_.work_heard();
  for (std::size_t g = 0; g < hands_.size(); ++g) {
    stored_ -= hands_[g].own ? guards_[g].energy() : hands_[g].energy;
    if (g >= word.hands.size()) continue;
    const Wrench& on_hand = word.hands[g].on_hand;
    const CouplingGains& k = gains_[g];
    if (k.stiffness > 0.0) stored_ += 0.5 * glm::dot(on_hand.force, on_hand.force) / k.stiffness;
    if (k.rotational_stiffness > 0.0)
      stored_ += 0.5 * glm::dot(on_hand.torque, on_hand.torque) / k.rotational_stiffness;
  }
}

GripState HeldBody::grip(std::size_t g) const noexcept {
  const GripState here = replica_.grip(g);
  return spring_ > 0.0 ? between(here, late_grip(g), spring_) : here;
}

/// The host's body goes with its hand, so that a spring to where it was is stretched by the delay: 142 N at
/// most where 10 were right (2000 N/m, a quarter of a metre a second, 400 ms). What the hand did since the
/// host used it counts only up to what the host itself has in the coupling: so a body that rests on something
/// still holds it, and one that follows does not drag it back.
GripState HeldBody::late_grip(std::size_t g) const noexcept {
  const double on = std::min(since_heard_ - ahead_, std::max(kCarriedOn, step_));
  const Pose body{heard_.position + on * heard_.twist.linear,
                  rotate_by(heard_.orientation, on * heard_.twist.angular)};
  const glm::dvec3 arm = body.orientation * (grips_[g].position - body_.center);
  GripState state;
  state.pose = {body.position + arm, body.orientation * grips_[g].orientation};
  state.twist = {heard_.twist.linear + glm::cross(heard_.twist.angular, arm), heard_.twist.angular};
  const ReplicaHand& hand = hands_[g];
  if (!hand.own || !hand.engaged) return state;
  // The hand as it was used, carried on with the grip.
  const glm::dvec3 old_arm = heard_.orientation * (grips_[g].position - body_.center);
  const glm::dvec3 used = state.pose.position + used_[g].position - heard_.position - old_arm;
  const glm::dquat used_turn =
      rotate_by(state.pose.orientation,
                rotation_between(heard_.orientation * grips_[g].orientation, used_[g].orientation));
  const glm::dvec3 since = hand.handle.position - used;
  const glm::dvec3 turned = rotation_between(used_turn, hand.handle.orientation);
  const auto left_out = [](double stretched, double most) {
    return stretched > most ? 1.0 - most / stretched : 0.0;
  };
  const CouplingGains& k = gains_[g];
  const double goes_along =
      left_out(k.stiffness * glm::length(since), std::max(glm::length(on_hands_[g].force), kMinStretch));
  const double turns_along = left_out(k.rotational_stiffness * glm::length(turned),
                                      std::max(glm::length(on_hands_[g].torque), kMinTwist));
  state.pose.position += goes_along * since;
  state.pose.orientation = rotate_by(state.pose.orientation, turns_along * turned);
  state.twist.linear += goes_along * (hand.twist.linear - state.twist.linear);
  state.twist.angular += turns_along * (hand.twist.angular - state.twist.angular);
  return state;
}

Wrench HeldBody::guard(std::size_t g, const Wrench& wanted, const Pose& hand, const Twist& twist, double dt,
                       double most_damping, double pace) noexcept {
  const double credit = balance() - guards_[g].energy() + (counted_ ? 0.0 : kUncounted);
  // What others hold is felt across the delay; alone on the body nothing is.
  const double share = std::max({replica_.shared(), disturbance_, spring_});
  const double damping = std::min(share / pace * replica_.damping(g), most_damping);
  const double turning = share / pace * replica_.rotational_damping(g);
  const Wrench damped{wanted.force - damping * twist.linear, wanted.torque - turning * twist.angular};
  const Wrench safe = guards_[g].guard(damped, hand, twist, dt, credit, most_damping);
  fires_ = fires_ || guards_[g].fires();
  return safe;
}

double HeldBody::balance() const noexcept {
  double sum = stored_ + replica_.work_believed() - forgotten_ + lent_;
  for (std::size_t j = 0; j < hands_.size(); ++j)
    sum += hands_[j].own ? guards_[j].energy() : hands_[j].energy;
  return sum;
}

/// What was put in and is held nowhere went into dampers: it does not come out again, or a body that bounces
/// would live for long on what it took to bring it there.
void HeldBody::forget_surplus(double dt) noexcept {
  const double balance_now = balance();
  const double surplus = balance_now - replica_.stored() - kKept;
  if (surplus > 0.0) {
    const double time = std::max(kForgets, kForgetsRoundTrips * pace_ * delay_.delay().round_trip);
    forgotten_ += surplus * (1.0 - std::exp(-dt / time));
  }
  // Others took what was forgotten too early: no hand is to carry on without force for that.
  const double debt = -balance_now - PassivityController::kSlack;
  if (debt > 0.0) forgotten_ -= debt * (1.0 - std::exp(-dt / kForgives));
}

/// What the host's step took for the load beyond all that there was it made itself: it carries hands on, and
/// what it gives their couplings by that nobody put in. No hand is to pay for it; but what comes back of it
/// is no gift.
void HeldBody::lend() noexcept {
  const double gave = replica_.work_heard() - work_heard_;
  work_heard_ += gave;
  if (gave > 0.0) lent_ -= std::min(lent_, gave);
  if (gave >= 0.0) return;
  // What was thought used up and was on its way comes first: a load that sank and is lifted again.
  const double short_of = std::clamp(-balance(), 0.0, -gave);
  const double kept = std::clamp(forgotten_, 0.0, short_of);
  forgotten_ -= kept;
  lent_ += short_of - kept;
}

/// A passivity controller that fires all the time says that the replica is wrong about the body.
void HeldBody::watch(double dt) noexcept {
  firing_ += (1.0 - std::exp(-dt / kFiringMemory)) * ((fires_ ? 1.0 : 0.0) - firing_);
  quiet_ = fires_ ? 0.0 : quiet_ + dt;
  if (fires_) fired_ += 1;
  fires_ = false;
  if (!fallen_back_ && firing_ > kFiresTooOften) fallen_back_ = true;
  if (fallen_back_ && quiet_ > kQuietTime) fallen_back_ = false;
  spring_ = std::clamp(spring_ + (fallen_back_ ? dt : -dt) / kChange, 0.0, 1.0);
}

void HeldBody::advance(std::span<const OwnHand> own, double dt, std::int64_t now_ns) noexcept {
  if (!started_) return;
  for (std::size_t g = 0; g < hands_.size(); ++g) {
    ReplicaHand& hand = hands_[g];
    if (g < own.size() && own[g].here) {
      if (!hand.own) {
        guards_[g].restart(own[g].handle);
        stored_ += hand.energy - guards_[g].energy();
      }
      hand.own = true;
      hand.engaged = own[g].engaged;
      hand.handle = own[g].handle;
      hand.twist = own[g].twist;
    } else if (hand.own) {
      hand = ReplicaHand{};
      hand.energy = guards_[g].energy();
      speeds_[g].forget();
    } else if (since_heard_ < kCarriedOn) {
      hand.handle = extrapolate(hand.handle, hand.twist, dt);
    }
  }
  since_heard_ += dt;
  const double trust = std::clamp(1.0 - (since_heard_ - kLoadHolds) / kLoadFades, 0.0, 1.0);
  replica_.advance(hands_, dt, now_ns, trust);
  lend();
  forget_surplus(dt);
  watch(dt);
}

}  // namespace slosh
