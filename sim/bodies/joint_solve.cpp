// What joints hold, in one solve. Velocities are those of SHAKE (Ryckaert et al. 1977): the impulses act
// along the rows at the sub-step's beginning and are such that the joints hold at its end, which keeps energy
// as the leap-frog does. What a joint was off when the sub-step began stays in the velocities' solve; it is
// undone along the way of the poses alone, so that it leaves no velocity.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sim/bodies/joints.h"

namespace slosh {
namespace {

// Iterations that find the impulses for the end of the sub-step, and what is exact, m or rad.
constexpr int kMaxJointIterations = 20;
constexpr double kExactJoint = 1e-13;
// m or rad that a joint may be off before that is undone: rounding is less.
constexpr double kJointDrift = 1e-10;
// m or rad to which impulses for the end of the sub-step must come, else there are none.
constexpr double kHoldsJoint = 1e-8;
// Share of the energy that is in the bend of the way where bodies turn by some 0.2 rad in a sub-step: up to
// there SHAKE keeps energy by itself.
constexpr double kFarTurn = 0.01;
// A motor or stop that all of the rest leaves less than this share of its give is held already.
constexpr double kHeldAlready = 1e-9;

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

// m/s or rad/s by which every held row ends the sub-step off `left` of what it was off when that began; a
// damper's is 0. Returns the largest, as m or rad.
double JointSystem::find_wrong(const std::vector<RigidBody>& bodies, const DrivenBodies& driven, double dt,
                               Vector6 BodySolve::* way, double left, const std::vector<BodySolve>& solves) {
  ends_.resize(bodies.size());
  wrong_.assign(rows_.size(), 0.0);
  const auto end_of = [&](int body) {
    if (body < 0) return;
    const BodySolve& solve = solves[index(body)];
    RigidBody& end = ends_[index(body)];
    end = bodies[index(body)];
    if (solve.driven) end = driven.moved(end, body);
    if (!solve.moves) return;
    BodySolve going = solve;
    going.travel = solve.*way;
    advance_body(end, going, dt);
  };
  worst_.assign(groups_.size(), 0.0);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (first_row_[j] == first_row_[j + 1]) continue;
    end_of(joints_[j].first.body);
    end_of(joints_[j].second.body);
    const auto off = frames(joints_[j], ends_).off(joints_[j].kind, kept_[j].rest);
    for (std::size_t r = 0; r < held_rows(joints_[j].kind).size(); ++r) {
      const std::size_t row = first_row_[j] + r;
      const double beyond = off[r] - left * rows_[row].off;
      wrong_[row] = beyond / dt;
      double& worst = worst_[group(row)];
      worst =
          std::isfinite(beyond) ? std::max(worst, std::abs(beyond)) : std::numeric_limits<double>::infinity();
    }
  }
  return *std::max_element(worst_.begin(), worst_.end());
}

std::size_t JointSystem::group(std::size_t row) const {
  const Linked& joint = joints_[index(rows_[row].joint)];
  const int first = groups_[index(joint.first.body)];
  return index(first >= 0 ? first : groups_[index(joint.second.body)]);
}

// J of the motion of each group's bodies, as the solve counts it; what hands hold counts as heavier.
std::vector<double> JointSystem::kinetic_energies(const std::vector<BodySolve>& solves) const {
  std::vector<double> energies(groups_.size(), 0.0);
  for (std::size_t b = 0; b < solves.size(); ++b) {
    if (rows_of_body_[b].empty()) continue;
    for (int i = 0; i < 6; ++i) {
      double sum = 0.0;
      for (int k = i; k < 6; ++k) sum += solves[b].factor[k][i] * solves[b].velocity[k];
      energies[index(groups_[b])] += 0.5 * sum * sum;
    }
  }
  return energies;
}

void JointSystem::give(const std::vector<double>& impulses, double sign, std::vector<BodySolve>& solves) {
  std::vector<double> given = impulses;
  for (double& impulse : given) impulse *= sign;
  apply(given, &BodySolve::velocity, solves);
  for (std::size_t r = 0; r < rows_.size(); ++r) rows_[r].impulse += given[r];
}

// No row's speed, but for a damper's, which is what it lets pass.
void JointSystem::hold_speeds(std::vector<BodySolve>& solves) {
  wrong_.resize(rows_.size());
  for (std::size_t r = 0; r < rows_.size(); ++r) wrong_[r] = speed_of(rows_[r], solves, &BodySolve::velocity);
  std::vector<double> impulses = wrong_;
  matrix_.solve(impulses);
  lost_.assign(groups_.size(), 0.0);
  for (std::size_t r = 0; r < rows_.size(); ++r) lost_[group(r)] += 0.5 * impulses[r] * wrong_[r];
  give(impulses, -1.0, solves);
}

// What the rows have to give beyond that for the joints to hold at the sub-step's end, by Newton's
// iterations. Its energy is what the next sub-step's hold_speeds() takes: that must not be less, where bodies
// turn so far in a sub-step that one follows badly from the other. Each group by itself.
void JointSystem::bend(const std::vector<RigidBody>& bodies, const DrivenBodies& driven, double dt,
                       std::vector<BodySolve>& solves) {
  const std::size_t count = groups_.size();
  bent_.assign(rows_.size(), 0.0);
  std::vector<double> sum(rows_.size(), 0.0), before(count, std::numeric_limits<double>::infinity());
  std::vector<char> done(count, 0);
  const std::vector<BodySolve> straight = solves;
  for (int turn = 0;; ++turn) {
    find_wrong(bodies, driven, dt, &BodySolve::velocity, 1.0, solves);
    bool all = true;
    for (std::size_t g = 0; g < count; ++g) {
      done[g] = done[g] || !(worst_[g] > kExactJoint) || !(worst_[g] < 0.5 * before[g]);
      before[g] = worst_[g];
      all = all && done[g];
    }
    if (all || turn == kMaxJointIterations) break;
    std::vector<double> impulses = wrong_;
    for (std::size_t r = 0; r < rows_.size(); ++r)
      if (done[group(r)]) impulses[r] = 0.0;
    matrix_.solve(impulses);
    for (double& impulse : impulses) impulse = -impulse;
    for (std::size_t r = 0; r < rows_.size(); ++r) sum[r] += impulses[r];
    apply(impulses, &BodySolve::velocity, solves);
  }
  std::vector<double> added(count, 0.0), share(count, 1.0);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    added[group(r)] += 0.5 * sum[r] *
                       (speed_of(rows_[r], solves, &BodySolve::velocity) -
                        speed_of(rows_[r], straight, &BodySolve::velocity));
  }
  const std::vector<double> kinetic = kinetic_energies(solves);
  holds_ = true;
  for (std::size_t g = 0; g < count; ++g) {
    if (!(worst_[g] < kHoldsJoint))
      share[g] = 0.0;
    else if (added[g] > lost_[g] && added[g] > kFarTurn * kinetic[g])
      share[g] = std::sqrt(std::max(lost_[g], 0.0) / added[g]);
    holds_ = holds_ && share[g] == 1.0;
  }
  solves = straight;
  for (std::size_t r = 0; r < rows_.size(); ++r)
    bent_[r] = share[group(r)] > 0.0 ? share[group(r)] * sum[r] : 0.0;
  give(bent_, 1.0, solves);
}

// The poses' way, with the rows where they end: it leaves no velocity.
void JointSystem::correct_travel(const std::vector<RigidBody>& bodies, const DrivenBodies& driven, double dt,
                                 std::vector<BodySolve>& solves) {
  std::vector<BodySolve> best = solves;
  double least = std::numeric_limits<double>::infinity();
  for (int turn = 0; turn < kMaxJointIterations; ++turn) {
    const double worst = find_wrong(bodies, driven, dt, &BodySolve::travel, 1.0 - kOverlapRate, solves);
    if (worst < least) {
      least = worst;
      best = solves;
    }
    if (!(worst > kExactJoint) || !(worst < 2.0 * least)) break;
    const std::vector<double> wrong = wrong_;
    turn_rows(ends_, solves);
    if (rows_.empty()) break;
    std::vector<double> impulses = wrong;
    matrix_.solve(impulses);
    for (double& impulse : impulses) impulse = -impulse;
    apply(impulses, &BodySolve::travel, solves);
  }
  for (std::size_t b = 0; b < solves.size(); ++b) solves[b].travel = best[b].travel;
}

void JointSystem::begin(const std::vector<RigidBody>& bodies, const DrivenBodies& driven, double dt,
                        std::vector<BodySolve>& solves) {
  make_rows(bodies, dt, solves);
  factor();
  hold_speeds(solves);
  bend(bodies, driven, dt, solves);
  for (BodySolve& solve : solves) solve.travel = solve.velocity;
  opened_.assign(rows_.size(), 0.0);
  make_axes(bodies, solves, dt);
}

void JointSystem::keep_joints(int a, int b, rows::Constraint& row, JointSpread& spread) const {
  std::vector<double> opened(rows_.size(), 0.0);
  const auto open = [&](int body, const rows::Row& by) {
    if (body < 0) return;
    for (const int r : rows_of_body_[index(body)]) {
      const Held& held = rows_[index(r)];
      const Linked& joint = joints_[index(held.joint)];
      if (joint.first.body == body) opened[index(r)] += rows::dot(held.on_first.force, by.response);
      if (joint.second.body == body) opened[index(r)] += rows::dot(held.on_second.force, by.response);
    }
  };
  open(a, row.on_a);
  open(b, row.on_b);
  for (std::size_t r = 0; r < opened.size(); ++r)
    if (opened[r] != 0.0) spread.on_rows.emplace_back(static_cast<int>(r), opened[r]);
  if (spread.on_rows.empty()) return;
  matrix_.solve(opened);
  std::map<int, Vector6> responses;
  for (std::size_t r = 0; r < opened.size(); ++r) {
    if (opened[r] == 0.0) continue;
    const Linked& joint = joints_[index(rows_[r].joint)];
    rows::add_scaled(responses[joint.first.body], -opened[r], rows_[r].on_first.response);
    if (joint.second.body >= 0)
      rows::add_scaled(responses[joint.second.body], -opened[r], rows_[r].on_second.response);
  }
  const double alone =
      rows::dot(row.on_a.force, row.on_a.response) + rows::dot(row.on_b.force, row.on_b.response);
  for (const auto& [body, response] : responses) {
    if (body == a)
      rows::add_scaled(row.on_a.response, 1.0, response);
    else if (body == b)
      rows::add_scaled(row.on_b.response, 1.0, response);
    else
      spread.responses.emplace_back(body, response);
  }
  const double give =
      rows::dot(row.on_a.force, row.on_a.response) + rows::dot(row.on_b.force, row.on_b.response);
  row.effective_mass = give > kHeldAlready * alone ? 1.0 / give : 0.0;
}

void JointSystem::make_axes(const std::vector<RigidBody>& bodies, const std::vector<BodySolve>& solves,
                            double dt) {
  axes_.clear();
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (first_row_[j] == first_row_[j + 1]) continue;
    const Linked& joint = joints_[j];
    const JointFrames f = frames(joint, bodies);
    const auto add = [&](double sign, bool motor, double least, double most, double begin,
                         const rows::Targets& target) {
      AxisRow axis{static_cast<int>(j),
                   joint.first.body,
                   joint.second.body,
                   motor,
                   sign,
                   {},
                   {},
                   least,
                   most,
                   std::clamp(begin, least, most),
                   target};
      const JointRow row = free_row(joint.kind);
      axis.row.on_a = row_on(axis.a, bodies, solves, f, row, sign);
      axis.row.on_b = row_on(axis.b, bodies, solves, f, row, -sign);
      const double give = rows::dot(axis.row.on_a.force, axis.row.on_a.response) +
                          rows::dot(axis.row.on_b.force, axis.row.on_b.response);
      axis.row.effective_mass = give > 0.0 ? 1.0 / give : 0.0;
      keep_joints(axis.a, axis.b, axis.row, axis.spread);
      axes_.push_back(std::move(axis));
    };
    const auto stop = [&](double sign, double gap) {
      const double undo = std::min(std::max(-gap, 0.0) * kOverlapRate / dt, kOverlapSpeed);
      const rows::Targets target{std::min(-gap / dt, 0.0), gap > 0.0 ? -gap / dt : undo};
      add(sign, false, 0.0, std::numeric_limits<double>::infinity(), sign * kept_[j].stop, target);
    };
    if (joint.motor_limit > 0.0)
      add(1.0, true, -joint.motor_limit * dt, joint.motor_limit * dt, kept_[j].motor,
          {joint.motor_speed, joint.motor_speed});
    if (joint.lower > -kNoStop) stop(1.0, kept_[j].position - joint.lower);
    if (joint.upper < kNoStop) stop(-1.0, joint.upper - kept_[j].position);
  }
}

void JointSystem::count(const JointSpread& spread, double impulse) {
  for (const auto& [row, opens] : spread.on_rows) opened_[index(row)] += impulse * opens;
}

void JointSystem::finish(const std::vector<RigidBody>& bodies, const DrivenBodies& driven, double dt,
                         double share, std::vector<BodySolve>& solves) {
  bool same = true, drifted = !holds_, pushed = false;
  for (const AxisRow& axis : axes_) count(axis.spread, axis.row.impulse);
  for (const double opened : opened_) pushed = pushed || opened != 0.0;
  for (std::size_t b = 0; b < solves.size(); ++b)
    same = same && (rows_of_body_[b].empty() || solves[b].travel == solves[b].velocity);
  for (const Held& held : rows_) drifted = drifted || std::abs(held.off) > kJointDrift;
  if (pushed) {
    matrix_.solve(opened_);
    for (std::size_t r = 0; r < rows_.size(); ++r) rows_[r].impulse -= opened_[r];
    give(bent_, -1.0, solves);
    bend(bodies, driven, dt, solves);
    drifted = drifted || !holds_;
    for (std::size_t b = 0; same && b < solves.size(); ++b)
      if (!rows_of_body_[b].empty()) solves[b].travel = solves[b].velocity;
  }
  report(bodies, dt, share);
  if (!same || drifted) correct_travel(bodies, driven, dt, solves);
}

}  // namespace slosh
