#include "net/engagement.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

constexpr double kMaxStrain = 2.5;   // rad: beyond half a turn the spring of turns would turn round
constexpr double kMaxElapsed = 0.1;  // s: a world that took a leap does not drag the body after it
constexpr double kNothing = 1e-6;    // m, rad
constexpr glm::dquat kAligned{1.0, 0.0, 0.0, 0.0};

/// J in a spring that gives `force`.
double stored_in(const glm::dvec3& force, double stiffness) {
  return stiffness > 0.0 ? 0.5 * glm::dot(force, force) / stiffness : 0.0;
}

/// J that a spring which gives `force` takes up when its end is moved by `way`.
double work_of(const glm::dvec3& force, const glm::dvec3& way, double stiffness) {
  return glm::dot(force, way) + 0.5 * stiffness * glm::dot(way, way);
}

/// The part of `left` that is given up in `elapsed` s, at `most` a s.
glm::dvec3 give_up(const glm::dvec3& left, double most, double elapsed) {
  const double length = glm::length(left);
  if (length == 0.0) return glm::dvec3(0.0);
  const double step = std::min(most * elapsed, length * (1.0 - std::exp(-elapsed / kRampEnd)));
  return left * (length - step < kNothing ? 1.0 : step / length);
}

/// One of the coupling's two springs, held so that its force on the hand differs from `centre` by no more
/// than `most`.
struct Slipping {
  glm::dvec3 stretch;   // grip less where it holds
  glm::dvec3 velocity;  // of where it holds

  void bound(double stiffness, double damping, const glm::dvec3& grip_velocity, const glm::dvec3& centre,
             double most) {
    if (stiffness <= 0.0) return;
    const glm::dvec3 pull = stiffness * stretch + damping * (grip_velocity - velocity) - centre;
    const double length = glm::length(pull);
    if (length <= most) return;
    const double share = most / length;
    velocity = grip_velocity + share * (velocity - grip_velocity);
    stretch = (centre + share * pull - damping * (grip_velocity - velocity)) / stiffness;
  }
};

}  // namespace

struct Engagement::Work {
  double elapsed;
  const CouplingGains& gains;
  const GripState& grip;
  Pose before;                                // where it held, carried along by the hand,
  Pose now;                                   // and where it holds
  glm::dvec3 velocity, turning;               // of that
  glm::dvec3 ramp_work{0.0}, ramp_turn{0.0};  // what it was moved towards the hand by, m and rad
};

double Engagement::slip_pace() const {
  return std::clamp((last_ - since_) / kSlipRise, 0.0, 1.0);
}

/// Nothing is to be given up any more: it holds as the hand does.
bool Engagement::firm() const {
  return quiet_ || (offset_ == glm::dvec3(0.0) && turn_ == kAligned && slip_pace() >= 1.0);
}

double Engagement::pace() const {
  return std::clamp((last_ - since_) / kRampRise, 0.0, 1.0);
}

double Engagement::most_pull() const {
  return company_ == Company::kSilent ? kYieldForce : kHoldForce * std::exp2((last_ - since_) / kHoldDoubles);
}

double Engagement::most_twist() const {
  return company_ == Company::kSilent ? kYieldTorque
                                      : kHoldTorque * std::exp2((last_ - since_) / kHoldDoubles);
}

double Engagement::allowance() const {
  return kHoldWay * (glm::length(began_.force) + kHoldForce);
}

double Engagement::turning_allowance() const {
  return kHoldAngle * (glm::length(began_.torque) + kHoldTorque);
}

Pose Engagement::place(const Pose& hand) const {
  return {hand.position - offset_,
          turn_ == kAligned ? hand.orientation : glm::normalize(hand.orientation * turn_)};
}

void Engagement::take_hold_anew() {
  Engagement fresh;
  fresh.share_ = share_;
  fresh.turning_share_ = turning_share_;
  fresh.last_ = last_;
  fresh.stored_ = stored_;
  fresh.turning_stored_ = turning_stored_;
  fresh.carried_ = carried_;
  fresh.anew_ = engaged_ || anew_;
  *this = fresh;
}

Engagement::Held Engagement::update(bool engaged, double time, const Pose& hand, const Twist& twist,
                                    const CouplingGains& gains, const GripState& grip, Company company) {
  given_ = 0.0;
  const double elapsed = std::clamp(time - last_, 0.0, kMaxElapsed);
  share_ = std::min(share_ + elapsed / kHoldRecovers, 1.0);
  turning_share_ = std::min(turning_share_ + elapsed / kHoldRecovers, 1.0);
  if (!engaged) {
    take_hold_anew();
    anew_ = false;
    last_ = time;
    return {hand, twist};
  }
  took_hold_ = !engaged_;
  if (took_hold_) {
    take_hold(time, hand, twist, gains, grip);
    if (!engaged_) return {hand, twist};
  } else {
    keep_force(hand, gains, grip);
  }
  gains_ = gains;
  // Whoever joins finds a hand that carries what acts by then, not what it began with.
  if (company == Company::kShared && company_ == Company::kAlone && !took_hold_) began_ = grip.on_hand;
  meet(company, time);

  const Pose before = place(hand);
  Work work{took_hold_ ? 0.0 : elapsed, gains, grip, before, before, twist.linear, twist.angular};
  slip(work, time);
  ramp_work(work, hand);
  bound_pull(work, twist);
  return settle(work, hand, twist);
}

void Engagement::take_hold(double time, const Pose& hand, const Twist& twist, const CouplingGains& gains,
                           const GripState& grip) {
  engaged_ = quiet_ = true;
  company_ = Company::kAlone;
  began_ = grip.on_hand;
  since_ = last_ = time;
  offset_ = slip_ = slip_turn_ = speed_ = turning_ = glm::dvec3(0.0);
  turn_ = kAligned;
  const Wrench full = coupling_wrench_on_hand(gains, hand, twist, grip.pose, grip.twist);
  const glm::dvec3 jolt = full.force - grip.on_hand.force;
  const glm::dvec3 jerk = full.torque - grip.on_hand.torque;
  if (!std::isfinite(glm::length(jolt) + glm::length(jerk))) {
    engaged_ = false;  // a body that is out of this world: tried again with its next state
    return;
  }
  if (glm::length(jolt) <= kQuietForce && glm::length(jerk) <= kQuietTorque) return;
  quiet_ = false;
  // The springs take over what the dampers gave as well, as far as the allowances bear it.
  const auto strained = [&](const glm::dvec3& force, double stiffness, double stored, double& share,
                            double whole) {
    const double wanted = stored_in(force, stiffness);
    if (!anew_ || wanted <= stored) return 1.0;
    const double more = std::min(wanted - stored, share * whole);
    share -= more / whole;
    return std::sqrt((stored + more) / wanted);
  };
  const double pull = strained(began_.force, gains.stiffness, stored_, share_, allowance());
  const double twisting = strained(began_.torque, gains.rotational_stiffness, turning_stored_, turning_share_,
                                   turning_allowance());
  anew_ = false;
  // From here on the dampers see the grip's own velocity, and the springs alone give what acts already.
  if (gains.stiffness > 0.0) {
    offset_ = hand.position - grip.pose.position + pull * grip.on_hand.force / gains.stiffness;
    slip_ = twist.linear - grip.twist.linear;
  }
  if (gains.rotational_stiffness <= 0.0) return;
  slip_turn_ = twist.angular - grip.twist.angular;
  glm::dvec3 strain = twisting * grip.on_hand.torque / gains.rotational_stiffness;
  const double angle = glm::length(strain);
  if (angle > kMaxStrain) strain *= kMaxStrain / angle;
  turn_ = glm::conjugate(hand.orientation) * rotate_by(grip.pose.orientation, -strain);
}

/// A spring that gets stiffer while it is stretched would put energy in: it keeps its force, and where the
/// hand holds moves up to the grip for it. One that gets softer keeps its stretch.
void Engagement::keep_force(const Pose& hand, const CouplingGains& gains, const GripState& grip) {
  const Pose held = place(hand);
  if (gains.stiffness > gains_.stiffness && gains_.stiffness > 0.0) {
    const double less = 1.0 - gains_.stiffness / gains.stiffness;
    const glm::dvec3 stretch = held.position - grip.pose.position;
    offset_ += less * stretch;
    given_ -= less * 0.5 * gains_.stiffness * glm::dot(stretch, stretch);
  }
  if (gains.rotational_stiffness > gains_.rotational_stiffness && gains_.rotational_stiffness > 0.0) {
    const double less = 1.0 - gains_.rotational_stiffness / gains.rotational_stiffness;
    const glm::dvec3 strain = rotation_between(grip.pose.orientation, held.orientation);
    turn_ = glm::conjugate(hand.orientation) * rotate_by(held.orientation, -less * strain);
    given_ -= less * 0.5 * gains_.rotational_stiffness * glm::dot(strain, strain);
  }
}

/// A hand that falls silent keeps what it carried; one whose updates resume after it gave way re-engages from
/// where it holds.
void Engagement::meet(Company company, double time) {
  const bool was_silent = company_ == Company::kSilent;
  if (company == Company::kSilent && !was_silent) began_ = carried_;
  if (company != Company::kSilent && was_silent && (offset_ != glm::dvec3(0.0) || turn_ != kAligned)) {
    quiet_ = false;
    since_ = time;
    slip_ = slip_turn_ = glm::dvec3(0.0);
  }
  company_ = company;
}

/// What is left of the grip's motion when the hand engaged.
void Engagement::slip(Work& work, double time) {
  const double before = slip_pace();
  last_ = std::max(last_, time);
  if (quiet_) return;
  const double slipped = (1.0 - 0.5 * (before + slip_pace())) * work.elapsed;
  work.now.position -= slipped * slip_;
  if (slip_turn_ != glm::dvec3(0.0))
    work.now.orientation = rotate_by(work.now.orientation, -slipped * slip_turn_);
  work.velocity -= (1.0 - slip_pace()) * slip_;
  work.turning -= (1.0 - slip_pace()) * slip_turn_;
}

void Engagement::ramp_work(Work& work, const Pose& hand) {
  if (company_ == Company::kSilent) {
    speed_ = turning_ = glm::dvec3(0.0);
    return;
  }
  if (work.elapsed > 0.0) {
    work.ramp_work = give_up(hand.position - work.now.position, pace() * kRampSpeed, work.elapsed);
    work.now.position += work.ramp_work;
    speed_ = work.ramp_work / work.elapsed;
    if (work.now.orientation != hand.orientation) {
      const glm::dvec3 left = rotation_between(work.now.orientation, hand.orientation);
      work.ramp_turn = give_up(left, pace() * kRampTurn, work.elapsed);
      work.now.orientation = rotate_by(work.now.orientation, work.ramp_turn);
    }
    turning_ = work.ramp_turn / work.elapsed;
  }
  work.velocity += speed_;
  work.turning += turning_;
}

/// Slips until what the hold changes of the force that it began with is in bounds. What that puts into the
/// spring comes out of the allowance; the less there is, the more it holds where it is in place of that, and
/// slips as friction does.
void Engagement::bound_pull(Work& work, const Twist& hand) {
  const Pose& grip = work.grip.pose;
  const auto slip = [&](double& share, double whole, double stiffness, double damping,
                        const glm::dvec3& grip_velocity, const glm::dvec3& began, double most, Slipping& law,
                        const Slipping& before, const glm::dvec3& ramp_work, const glm::dvec3& still) {
    if (company_ == Company::kSilent || (company_ == Company::kShared && !firm()))
      law.bound(stiffness, damping, grip_velocity, began, most);
    const double ease = std::min(share / kHoldEases, 1.0);
    const double free = ease * ease * (3.0 - 2.0 * ease);
    if (free < 1.0) {
      Slipping friction{before.stretch - ramp_work, still};
      friction.bound(stiffness, damping, grip_velocity, {}, glm::length(began) + most);
      law.stretch = free * law.stretch + (1.0 - free) * friction.stretch;
      law.velocity = free * law.velocity + (1.0 - free) * friction.velocity;
    }
    const glm::dvec3 force = -stiffness * before.stretch;  // on the body
    const glm::dvec3 in_all = before.stretch - law.stretch, slipped = in_all - ramp_work;
    const double work_in_all = work_of(force, in_all, stiffness),
                 work_slipped = work_of(force, slipped, stiffness);
    // What the spring gives back as the hold returns to the hand restores the allowance.
    const double spent = work_slipped + std::min(work_in_all - work_slipped, 0.0);
    share = std::clamp(share - spent / whole, 0.0, 1.0);
    given_ += work_in_all;
  };
  if (work.gains.stiffness > 0.0) {
    Slipping law{grip.position - work.now.position, work.velocity};
    const glm::dvec3 found = law.stretch;
    slip(share_, allowance(), work.gains.stiffness, work.gains.damping, work.grip.twist.linear, began_.force,
         most_pull(), law, {grip.position - work.before.position, {}}, work.ramp_work, hand.linear + speed_);
    if (law.stretch != found) work.now.position = grip.position - law.stretch;
    work.velocity = law.velocity;
  }
  if (work.gains.rotational_stiffness > 0.0) {
    Slipping law{rotation_between(work.now.orientation, grip.orientation), work.turning};
    const glm::dvec3 found = law.stretch;
    slip(turning_share_, turning_allowance(), work.gains.rotational_stiffness, work.gains.rotational_damping,
         work.grip.twist.angular, began_.torque, most_twist(), law,
         {rotation_between(work.before.orientation, grip.orientation), {}}, work.ramp_turn,
         hand.angular + turning_);
    if (law.stretch != found) work.now.orientation = rotate_by(grip.orientation, -law.stretch);
    work.turning = law.velocity;
  }
}

Engagement::Held Engagement::settle(const Work& work, const Pose& hand, const Twist& twist) {
  const glm::dvec3 stretch = work.now.position - work.grip.pose.position;
  const glm::dvec3 strain = rotation_between(work.grip.pose.orientation, work.now.orientation);
  stored_ = 0.5 * work.gains.stiffness * glm::dot(stretch, stretch);
  turning_stored_ = 0.5 * work.gains.rotational_stiffness * glm::dot(strain, strain);
  if (work.now.position != work.before.position) offset_ = hand.position - work.now.position;
  if (glm::length(offset_) < kNothing) offset_ = glm::dvec3(0.0);
  if (work.now.orientation != work.before.orientation)
    turn_ = glm::conjugate(hand.orientation) * work.now.orientation;
  if (angle() < kNothing) turn_ = kAligned;
  const bool moving = company_ == Company::kSilent || (!quiet_ && slip_pace() < 1.0);
  if (offset_ == glm::dvec3(0.0) && turn_ == kAligned && !moving) return {hand, twist};
  return {place(hand), {work.velocity, work.turning}};
}

}  // namespace slosh
