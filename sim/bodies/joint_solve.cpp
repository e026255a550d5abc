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
// N·m·s/rad or N·s/m: less is no damper.
constexpr double kMinDamping = 1e-9;
// Added to the diagonal, as a share: loops of joints hold some things twice.
constexpr double kTwiceHeld = 1e-10;
// A motor or stop that all of the rest leaves less than this share of its give is held already.
constexpr double kHeldAlready = 1e-9;

void add_scaled(Vector6& to, double by, const Vector6& v) {
  for (int i = 0; i < 6; ++i) to[i] += by * v[i];
}

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

rows::Row JointSystem::row_on(int body, const std::vector<RigidBody>& bodies,
                              const std::vector<BodySolve>& solves, const JointFrames& frames, JointRow row,
                              double sign) const {
  rows::Row out;
  if (body < 0) return out;
  const BodySolve& solve = solves[index(body)];
  if (!solve.moves && !solve.driven) return out;
  const glm::dvec3 along = sign * frames.axis(row.axis);
  const glm::dvec3 moment =
      row.turning ? along : glm::cross(frames.point() - bodies[index(body)].position, along);
  const glm::dvec3 force = row.turning ? glm::dvec3(0.0) : along;
  out.force = {force.x, force.y, force.z, moment.x, moment.y, moment.z};
  if (solve.moves) out.response = cholesky_solve(solve.factor, out.force);
  return out;
}

double JointSystem::speed_of(const Held& held, const std::vector<BodySolve>& solves,
                             Vector6 BodySolve::* speed) const {
  const Linked& joint = joints_[index(held.joint)];
  double sum = rows::dot(held.on_first.force, solves[index(joint.first.body)].*speed);
  if (joint.second.body >= 0) sum += rows::dot(held.on_second.force, solves[index(joint.second.body)].*speed);
  return sum;
}

void JointSystem::make_rows(const std::vector<RigidBody>& bodies, double dt,
                            const std::vector<BodySolve>& solves) {
  rows_.clear();
  first_row_.clear();
  for (std::vector<int>& rows : rows_of_body_) rows.clear();
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    first_row_.push_back(rows_.size());
    const Linked& joint = joints_[j];
    const int a = joint.first.body, b = joint.second.body;
    const auto moves = [&](int body) { return body >= 0 && solves[index(body)].moves; };
    const auto gone = [&](int body) { return body >= 0 && bodies[index(body)].gone; };
    const JointFrames f = frames(joint, bodies);
    kept_[j].position = unwrapped(j, f);
    if ((!moves(a) && !moves(b)) || gone(a) || gone(b)) continue;
    const std::array<double, kRowsPerJoint> off = f.off(joint.kind);
    const auto add = [&](JointRow row, double by, bool damper) {
      for (const int body : {a, b})
        if (moves(body)) rows_of_body_[index(body)].push_back(static_cast<int>(rows_.size()));
      rows_.push_back({static_cast<int>(j), row, row_on(a, bodies, solves, f, row, 1.0),
                       row_on(b, bodies, solves, f, row, -1.0), damper ? 1.0 / (joint.damping * dt) : 0.0, by,
                       0.0, damper});
    };
    const auto held = held_rows(joint.kind);
    for (int r = 0; r < kRowsPerJoint; ++r) add(held[r], off[r], false);
    if (joint.damping > kMinDamping) add(free_row(joint.kind), 0.0, true);
  }
  first_row_.push_back(rows_.size());
}

void JointSystem::factor() {
  matrix_.clear(rows_.size());
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const int a = joints_[j].first.body, b = joints_[j].second.body;
    for (const int neighbour : joints_[j].neighbours) {
      const Linked& other = joints_[index(neighbour)];
      for (std::size_t r = first_row_[j]; r < first_row_[j + 1]; ++r) {
        const std::size_t end = std::min(first_row_[index(neighbour) + 1], r + 1);
        for (std::size_t s = first_row_[index(neighbour)]; s < end; ++s) {
          double sum = 0.0;
          const auto meet = [&](int mine, const rows::Row& row, int theirs, const rows::Row& by) {
            if (mine >= 0 && mine == theirs) sum += rows::dot(row.force, by.response);
          };
          meet(a, rows_[r].on_first, other.first.body, rows_[s].on_first);
          meet(a, rows_[r].on_first, other.second.body, rows_[s].on_second);
          meet(b, rows_[r].on_second, other.first.body, rows_[s].on_first);
          meet(b, rows_[r].on_second, other.second.body, rows_[s].on_second);
          if (r == s) sum = sum * (1.0 + kTwiceHeld) + rows_[r].give;
          if (sum != 0.0) matrix_.add(r, s, sum);
        }
      }
    }
  }
  if (matrix_.factor()) return;
  rows_.clear();
  std::fill(first_row_.begin(), first_row_.end(), 0);
  for (std::vector<int>& rows : rows_of_body_) rows.clear();
}

void JointSystem::apply(const std::vector<double>& impulses, Vector6 BodySolve::* speed,
                        std::vector<BodySolve>& solves) const {
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const Linked& joint = joints_[index(rows_[r].joint)];
    add_scaled(solves[index(joint.first.body)].*speed, impulses[r], rows_[r].on_first.response);
    if (joint.second.body >= 0)
      add_scaled(solves[index(joint.second.body)].*speed, impulses[r], rows_[r].on_second.response);
  }
}

// The rows where `poses` have the bodies.
void JointSystem::turn_rows(const std::vector<RigidBody>& poses, const std::vector<BodySolve>& solves) {
  for (Held& held : rows_) {
    const Linked& joint = joints_[index(held.joint)];
    const JointFrames f = frames(joint, poses);
    held.on_first = row_on(joint.first.body, poses, solves, f, held.row, 1.0);
    held.on_second = row_on(joint.second.body, poses, solves, f, held.row, -1.0);
  }
  factor();
}

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
  double worst = 0.0;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (first_row_[j] == first_row_[j + 1]) continue;
    end_of(joints_[j].first.body);
    end_of(joints_[j].second.body);
    const auto off = frames(joints_[j], ends_).off(joints_[j].kind);
    for (std::size_t r = 0; r < kRowsPerJoint; ++r) {
      const std::size_t row = first_row_[j] + r;
      const double beyond = off[r] - left * rows_[row].off;
      wrong_[row] = beyond / dt;
      worst = std::max(worst, std::abs(beyond));
    }
  }
  return std::isfinite(worst) ? worst : std::numeric_limits<double>::infinity();
}

// J of the bodies' motion, as the solve counts it; what hands hold counts as heavier.
double JointSystem::kinetic_energy(const std::vector<BodySolve>& solves) const {
  double energy = 0.0;
  for (std::size_t b = 0; b < solves.size(); ++b) {
    if (rows_of_body_[b].empty()) continue;
    for (int i = 0; i < 6; ++i) {
      double sum = 0.0;
      for (int k = i; k < 6; ++k) sum += solves[b].factor[k][i] * solves[b].velocity[k];
      energy += 0.5 * sum * sum;
    }
  }
  return energy;
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
  lost_ = 0.0;
  for (std::size_t r = 0; r < rows_.size(); ++r) lost_ += 0.5 * impulses[r] * wrong_[r];
  give(impulses, -1.0, solves);
}

// What the rows have to give beyond that for the joints to hold at the sub-step's end, by Newton's
// iterations. Its energy is what the next sub-step's hold_speeds() takes: that must not be less, where bodies
// turn so far in a sub-step that one follows badly from the other.
void JointSystem::bend(const std::vector<RigidBody>& bodies, const DrivenBodies& driven, double dt,
                       std::vector<BodySolve>& solves) {
  bent_.assign(rows_.size(), 0.0);
  std::vector<double> sum(rows_.size(), 0.0);
  const std::vector<BodySolve> straight = solves;
  double worst = find_wrong(bodies, driven, dt, &BodySolve::velocity, 1.0, solves);
  for (int turn = 0; turn < kMaxJointIterations && worst > kExactJoint; ++turn) {
    std::vector<double> impulses = wrong_;
    matrix_.solve(impulses);
    for (std::size_t r = 0; r < rows_.size(); ++r) sum[r] -= impulses[r];
    for (double& impulse : impulses) impulse = -impulse;
    apply(impulses, &BodySolve::velocity, solves);
    const double before = worst;
    worst = find_wrong(bodies, driven, dt, &BodySolve::velocity, 1.0, solves);
    if (!(worst < 0.5 * before)) break;
  }
  double share = worst < kHoldsJoint ? 1.0 : 0.0;
  double added = 0.0;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    added += 0.5 * sum[r] *
             (speed_of(rows_[r], solves, &BodySolve::velocity) -
              speed_of(rows_[r], straight, &BodySolve::velocity));
  }
  if (share > 0.0 && added > lost_ && added > kFarTurn * kinetic_energy(solves))
    share = std::sqrt(std::max(lost_, 0.0) / added);
  holds_ = share == 1.0;
  solves = straight;
  for (std::size_t r = 0; r < rows_.size(); ++r) bent_[r] = share * sum[r];
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
    add_scaled(responses[joint.first.body], -opened[r], rows_[r].on_first.response);
    if (joint.second.body >= 0)
      add_scaled(responses[joint.second.body], -opened[r], rows_[r].on_second.response);
  }
  const double alone =
      rows::dot(row.on_a.force, row.on_a.response) + rows::dot(row.on_b.force, row.on_b.response);
  for (const auto& [body, response] : responses) {
    if (body == a)
      add_scaled(row.on_a.response, 1.0, response);
    else if (body == b)
      add_scaled(row.on_b.response, 1.0, response);
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
