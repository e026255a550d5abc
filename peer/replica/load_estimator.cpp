#include "peer/replica/load_estimator.h"

#include <algorithm>
#include <cmath>

#include "peer/replica/fallback.h"

namespace slosh {
namespace {

/// N of a change that is not foreseen at which the whole damping acts, and s for which that is remembered.
constexpr double kDisturbance = 15.0;
constexpr double kDisturbanceMemory = 5.0;
constexpr double kLoadRoundTrips = 2.0;  // after which a table that is met counts as told of
constexpr double kForesees = 2.0;
constexpr double kFullUncertainty = 3.0;
/// N that updates' forces may be off by as they are rounded: no contact. Model uncertainty acts as friction,
/// however small it is (tests/notebook/2026-11-27-rounding-is-no-contact.md).
constexpr double kRounding = 0.1;

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

FluidLoad LoadEstimator::load_of(const HostUpdate& word, const Before& before) noexcept {
  const RigidMotion& now = word.motion;
  const double elapsed = word.time - before.time;
  Vector6 pace{};  // linear and angular acceleration
  const bool known = before.known && elapsed > 0.0 && elapsed < kLongestStep;
  if (known) {
    const glm::dvec3 a = (now.twist.linear - before.motion.twist.linear) / elapsed;
    const glm::dvec3 b = (now.twist.angular - before.motion.twist.angular) / elapsed;
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
  Acting acting{known ? elapsed : 0.0, before.motion.twist.linear,
                now.twist.linear,      force,
                word.tells_fluid,      word.fluid.force + older * (fluid_force - word.fluid.force)};
  for (std::size_t g = 0; g < grips_.size() && g < word.hands.size(); ++g) {
    const Wrench& on_hand = word.hands[g].on_hand;
    const glm::dvec3 arm = now.orientation * (grips_[g].position - body_.center);
    force += on_hand.force;
    torque += glm::cross(arm, on_hand.force) + on_hand.torque;
    acting.force += on_hand.force + older * (on_hands[g].force - on_hand.force);
    on_hands[g] = on_hand;
  }
  if (body_.point) torque = glm::dvec3(0.0);
  tells_fluid = word.tells_fluid;
  fluid_force = word.fluid.force;
  met = acting.force - acting.fluid;
  FluidLoad load = fluid;
  load.reference = {now.position, now.orientation};
  load.twist = now.twist;
  load.wrench = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    acting.told_mass[i] = fluid.added_mass[row][row];
    acting.told_drag[i] = -fluid.d_velocity[row][row];
  }
  const bool looks = follows_slosh && word.felt;
  if (looks) {
    carried.update(acting);
  } else if (looks_for_slosh) {
    carried.restart();
  }
  looks_for_slosh = looks;
  // What others do within the delay is not known, and a mode that went by it would be driven by it.
  const double alone = looks && !before.shared ? 1.0 : 0.0;
  const double most = std::clamp(elapsed, 0.0, kLongestStep) / Fallback::kChange;
  slosh_share += std::clamp(alone - slosh_share, -most, most);
  carried.put_into(load, load.wrench, pace, acting, slosh_share, before.round_trip);
  return load;
}

/// What acts changes by more than is told of it: a table that is met, a fluid that nobody models. That
/// answers to this hand a round trip late, as another hand would.
double LoadEstimator::note_disturbance(const FluidLoad& load, const FluidLoad& before, bool shared,
                                       double late, double elapsed) noexcept {
  // Alone, what a damper answers to the body's own speed is foreseen.
  const bool damped = shared;
  const glm::dvec3 off = still_force(load, damped) - still_force(before, damped);
  // Fluid that the replica does not follow late drives nothing, and what it gives is no gift of a table's.
  double unforeseen = glm::length(off), doubtful = unforeseen;
  if (tells_fluid) {
    const double told_late = kLoadRoundTrips * late;
    const glm::dvec3 newly = met - met_late;
    met_late += (told_late > elapsed ? 1.0 - std::exp(-elapsed / told_late) : 1.0) * newly;
    unforeseen = glm::length(newly) + (1.0 - carried.foreseen()) * glm::length(off - newly);
    doubtful = glm::length(newly);
  }
  const double now = std::min(unforeseen / kDisturbance, 1.0);
  const double forget = 1.0 - std::exp(-std::clamp(elapsed, 0.0, 1.0) / kDisturbanceMemory);
  disturbance = now > disturbance ? now : disturbance + forget * (now - disturbance);
  const double doubt = std::clamp((doubtful - kRounding) / (kFullUncertainty - kRounding), 0.0, 1.0);
  model_uncertainty =
      doubt > model_uncertainty ? doubt : model_uncertainty + forget * (doubt - model_uncertainty);
  quiet_load += elapsed;
  // A weight that is carried down gives; one that rests on something does not.
  return std::clamp(quiet_load / kForesees, 0.0, 1.0) * (1.0 - model_uncertainty);
}

}  // namespace slosh
