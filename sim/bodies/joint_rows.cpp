// Where a joint's rows are in a sub-step, and the one matrix of all of them.
#include <algorithm>

#include "sim/bodies/joints.h"

namespace slosh {
namespace {

// N·m·s/rad or N·s/m: less is no damper.
constexpr double kMinDamping = 1e-9;
// Added to the diagonal, as a share: loops of joints hold some things twice.
constexpr double kTwiceHeld = 1e-10;

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
    if ((!moves(a) && !moves(b)) || gone(a) || gone(b) || !holds(kept_[j].hold)) continue;
    const auto off = f.off(joint.kind, kept_[j].rest);
    const auto add = [&](JointRow row, double by, bool damper) {
      for (const int body : {a, b})
        if (moves(body)) rows_of_body_[index(body)].push_back(static_cast<int>(rows_.size()));
      rows_.push_back({static_cast<int>(j), row, row_on(a, bodies, solves, f, row, 1.0),
                       row_on(b, bodies, solves, f, row, -1.0), damper ? 1.0 / (joint.damping * dt) : 0.0, by,
                       0.0, damper});
    };
    const auto held = held_rows(joint.kind);
    for (std::size_t r = 0; r < held.size(); ++r) add(held[r], off[r], false);
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
    rows::add_scaled(solves[index(joint.first.body)].*speed, impulses[r], rows_[r].on_first.response);
    if (joint.second.body >= 0)
      rows::add_scaled(solves[index(joint.second.body)].*speed, impulses[r], rows_[r].on_second.response);
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

}  // namespace slosh
