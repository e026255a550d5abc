#include "peer/replica/held_body.h"

#include <algorithm>
#include <cmath>

#include "net/clock.h"

namespace slosh {
namespace {

/// s for which another site's hand, and the host's body for a spring to it, are carried on by their twists.
constexpr double kCarriedOn = 0.02;
constexpr double kTwistForesees = 0.01;  // s for which a hand goes about as it went
/// s for which the fluid's model holds without an update, and over which it then goes.
constexpr double kLoadHolds = 0.1;
constexpr double kLoadFades = 0.3;
/// N and N·m by which the damped spring may be stretched by the delay alone, whatever the host has in it.
constexpr double kMinStretch = 1.0;
constexpr double kMinTwist = 0.1;
/// J: where nobody counts for another hand, nothing that comes out is too much.
constexpr double kUncounted = 1e9;
std::vector<Pose> poses_of(const std::vector<ReplicaGrip>& grips) {
  std::vector<Pose> poses;
  for (const ReplicaGrip& grip : grips) poses.push_back(grip.pose);
  return poses;
}

}  // namespace

HeldBody::HeldBody(const ReplicaBody& body, std::vector<ReplicaGrip> grips, const ReplicaTuning& tuning)
    : body_(body),
      replica_(body, grips, tuning),
      grips_(poses_of(grips)),
      hands_(grips.size()),
      speeds_(grips.size()),
      controllers_(grips.size()),
      load_work_(body, grips),
      load_(body_, grips_, tuning.follows_slosh),
      used_(grips.size()) {
  for (const ReplicaGrip& grip : grips) gains_.push_back(grip.gains);
}

void HeldBody::become(const ReplicaBody& body) noexcept {
  body_ = body;
  replica_.become(body);
  load_work_.become(body);
  load_.become(body);
}

void HeldBody::restart() noexcept {
  started_ = false;
  delay_.restart();
  load_work_.restart();
  load_.restart();
  for (ReplicaHand& hand : hands_) hand.engaged = false;
  for (VelocityWindow& speed : speeds_) speed.forget();
  fallback_.restart();
}

void HeldBody::receive(const HostUpdate& word) noexcept {
  const double elapsed = started_ ? to_seconds(word.now_ns - received_ns_) : 0.0;
  const FluidLoad load = load_.load_of(word, {started_, received_time_, received_, replica_.shared() > 0.0,
                                              pace_ * delay_.delay().round_trip});
  load_work_.receive(word);
  received_time_ = word.time;
  received_ = word.motion;
  received_ns_ = word.now_ns;
  pace_ = word.pace;
  step_ = std::min(word.time_step, LoadEstimator::kLongestStep);
  since_received_ = 0.0;
  std::int64_t ack_ns = 0;
  counted_ = true;
  for (std::size_t g = 0; g < hands_.size() && g < word.hands.size(); ++g) {
    const HostHand& said = word.hands[g];
    ReplicaHand& hand = hands_[g];
    used_[g] = said.handle;
    if (!said.engaged)
      used_[g] = {received_.position + received_.orientation * (grips_[g].position - body_.center),
                  received_.orientation * grips_[g].orientation};
    if (hand.own) {
      if (said.engaged && said.ack_ns != 0)
        ack_ns = ack_ns == 0 ? said.ack_ns : std::min(ack_ns, said.ack_ns);
      continue;
    }
    if (!said.engaged) speeds_[g].forget();
    // Another person's count begins elsewhere.
    if (said.engaged && !hand.engaged) energy_.stored += hand.energy - said.energy;
    hand.engaged = said.engaged;
    hand.handle = said.handle;
    hand.twist = said.engaged ? speeds_[g].add(said.handle, to_nanoseconds(word.time)) : Twist{};
    if (said.engaged) hand.energy = said.energy;
    counted_ = counted_ && (said.counted || !said.engaged);
  }
  if (!started_) {
    replica_.restart(word.motion);
    replica_.set_load(load);
    load_.met_late = load_.met;
    started_ = true;
    begin_count(word);
    return;
  }
  const LoopDelay usual = delay_.delay();
  replica_.trust_load(load_.note_disturbance(load, replica_.load(), replica_.shared() > 0.0,
                                             pace_ * (usual.round_trip + usual.jitter), elapsed));
  replica_.set_load(load);
  if (ack_ns == 0) return;
  delay_.note(to_seconds(word.now_ns - ack_ns), elapsed);
  ahead_ = pace_ * std::max(to_seconds(ack_ns - word.now_ns), 0.0);
  const LoopDelay delay = delay_.delay();
  // What a hand does within a long step that its twist did not foresee acts at the host in the next.
  const double unforeseen = std::max(word.time_step - kTwistForesees, 0.0);
  replica_.set_delay({pace_ * delay.round_trip + unforeseen, pace_ * delay.jitter});
  replica_.receive({word.motion, ack_ns, load_work_.work(), load_.carried.states()});
}

/// A body that moves and springs that are stretched already when this begins have energy to give.
void HeldBody::begin_count(const HostUpdate& word) noexcept {
  energy_.stored = load_work_.kinetic();
  energy_.forgotten = energy_.lent = 0.0;
  energy_.work_received = replica_.work_received();
  for (std::size_t g = 0; g < hands_.size(); ++g) {
    energy_.stored -= hands_[g].own ? controllers_[g].energy() : hands_[g].energy;
    if (g >= word.hands.size()) continue;
    const Wrench& on_hand = word.hands[g].on_hand;
    const CouplingGains& k = gains_[g];
    if (k.stiffness > 0.0) energy_.stored += 0.5 * glm::dot(on_hand.force, on_hand.force) / k.stiffness;
    if (k.rotational_stiffness > 0.0)
      energy_.stored += 0.5 * glm::dot(on_hand.torque, on_hand.torque) / k.rotational_stiffness;
  }
}

GripState HeldBody::grip(std::size_t g) const noexcept {
  const GripState here = replica_.grip(g);
  return fallback_.spring > 0.0 ? between(here, late_grip(g), fallback_.spring) : here;
}

/// The host's body goes with its hand, so that a spring to where it was is stretched by the delay: 142 N at
/// most where 10 were right (2000 N/m, a quarter of a metre a second, 400 ms). What the hand did since the
/// host used it counts only up to what the host itself has in the coupling: so a body that rests on something
/// still holds it, and one that follows does not drag it back.
GripState HeldBody::late_grip(std::size_t g) const noexcept {
  const double on = std::min(since_received_ - ahead_, std::max(kCarriedOn, step_));
  const Pose body{received_.position + on * received_.twist.linear,
                  rotate_by(received_.orientation, on * received_.twist.angular)};
  const glm::dvec3 arm = body.orientation * (grips_[g].position - body_.center);
  GripState state;
  state.pose = {body.position + arm, body.orientation * grips_[g].orientation};
  state.twist = {received_.twist.linear + glm::cross(received_.twist.angular, arm), received_.twist.angular};
  const ReplicaHand& hand = hands_[g];
  if (!hand.own || !hand.engaged) return state;
  // The hand as it was used, carried on with the grip.
  const glm::dvec3 old_arm = received_.orientation * (grips_[g].position - body_.center);
  const glm::dvec3 used = state.pose.position + used_[g].position - received_.position - old_arm;
  const glm::dquat used_turn =
      rotate_by(state.pose.orientation,
                rotation_between(received_.orientation * grips_[g].orientation, used_[g].orientation));
  const glm::dvec3 since = hand.handle.position - used;
  const glm::dvec3 turned = rotation_between(used_turn, hand.handle.orientation);
  const auto left_out = [](double stretched, double most) {
    return stretched > most ? 1.0 - most / stretched : 0.0;
  };
  const CouplingGains& k = gains_[g];
  const double goes_along =
      left_out(k.stiffness * glm::length(since), std::max(glm::length(load_.on_hands[g].force), kMinStretch));
  const double turns_along = left_out(k.rotational_stiffness * glm::length(turned),
                                      std::max(glm::length(load_.on_hands[g].torque), kMinTwist));
  state.pose.position += goes_along * since;
  state.pose.orientation = rotate_by(state.pose.orientation, turns_along * turned);
  state.twist.linear += goes_along * (hand.twist.linear - state.twist.linear);
  state.twist.angular += turns_along * (hand.twist.angular - state.twist.angular);
  return state;
}

Wrench HeldBody::limit(std::size_t g, const Wrench& wanted, const Pose& hand, const Twist& twist, double dt,
                       double most_damping, double pace) noexcept {
  const double credit = balance() - controllers_[g].energy() + (counted_ ? 0.0 : kUncounted);
  // What others hold is felt across the delay; alone on the body nothing is.
  const double share = std::max({replica_.shared(), load_.disturbance, fallback_.spring});
  const double damping = std::min(share / pace * replica_.damping(g), most_damping);
  const double turning = share / pace * replica_.rotational_damping(g);
  const Wrench damped{wanted.force - damping * twist.linear, wanted.torque - turning * twist.angular};
  const Wrench safe = controllers_[g].limit(damped, hand, twist, dt, credit, most_damping);
  fallback_.note(controllers_[g].fires());
  return safe;
}

double HeldBody::balance() const noexcept {
  double sum = energy_.without_persons(replica_.work_trusted());
  for (std::size_t j = 0; j < hands_.size(); ++j)
    sum += hands_[j].own ? controllers_[j].energy() : hands_[j].energy;
  return sum;
}

void HeldBody::advance(std::span<const OwnHand> own, double dt, std::int64_t now_ns) noexcept {
  if (!started_) return;
  for (std::size_t g = 0; g < hands_.size(); ++g) {
    ReplicaHand& hand = hands_[g];
    if (g < own.size() && own[g].here) {
      if (!hand.own) {
        controllers_[g].restart(own[g].handle);
        energy_.stored += hand.energy - controllers_[g].energy();
      }
      hand.own = true;
      hand.engaged = own[g].engaged;
      hand.handle = own[g].handle;
      hand.twist = own[g].twist;
    } else if (hand.own) {
      hand = ReplicaHand{};
      hand.energy = controllers_[g].energy();
      speeds_[g].forget();
    } else if (since_received_ < kCarriedOn) {
      hand.handle = extrapolate(hand.handle, hand.twist, dt);
    }
  }
  since_received_ += dt;
  const double trust = std::clamp(1.0 - (since_received_ - kLoadHolds) / kLoadFades, 0.0, 1.0);
  replica_.advance(hands_, dt, now_ns, trust);
  energy_.lend(replica_.work_received(), [&] { return balance(); });
  energy_.forget_surplus(balance(), replica_.stored(), pace_ * delay_.delay().round_trip, dt);
  fallback_.advance(dt);
}

}  // namespace slosh
