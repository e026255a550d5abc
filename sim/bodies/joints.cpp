#include "sim/bodies/joints.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace slosh {
namespace {

// A frame in the world as a body's side of a joint.
JointSide side_of(int body, const Pose& frame, const std::vector<RigidBody>& bodies) {
  if (body < 0) return {-1, frame.position, frame.orientation};
  const RigidBody& b = bodies[static_cast<std::size_t>(body)];
  const glm::dquat into = glm::conjugate(b.orientation);
  return {body, into * (frame.position - b.position), into * frame.orientation};
}

Pose pose_of(const JointSide& side, const std::vector<RigidBody>& bodies) {
  if (side.body < 0) return {side.point, side.turn};
  const RigidBody& b = bodies[static_cast<std::size_t>(side.body)];
  return {b.position + b.orientation * side.point, b.orientation * side.turn};
}

glm::dvec3 velocity_of(int body, const std::vector<RigidBody>& bodies, const glm::dvec3& where) {
  return body < 0 ? glm::dvec3(0.0) : bodies[static_cast<std::size_t>(body)].velocity_at(where);
}
glm::dvec3 turning_of(int body, const std::vector<RigidBody>& bodies) {
  return body < 0 ? glm::dvec3(0.0) : bodies[static_cast<std::size_t>(body)].angular_velocity;
}

bool is_free(int body, const std::vector<RigidBody>& bodies) {
  return body >= 0 && bodies[static_cast<std::size_t>(body)].free;
}

}  // namespace

JointSystem::JointSystem(const Scene& scene, const std::vector<RigidBody>& bodies)
    : kept_(scene.joints.size()), means_(scene.joints.size()) {
  if (scene.joints.empty()) return;
  groups_.resize(bodies.size());
  joints_of_body_.resize(bodies.size());
  for (const Joint& source : scene.joints) {
    const Pose frame = compose(bodies[static_cast<std::size_t>(source.body)].mesh_pose(), source.pose);
    const Pose other =
        !source.meets ? frame
        : source.other < 0
            ? *source.meets
            : compose(bodies[static_cast<std::size_t>(source.other)].mesh_pose(), *source.meets);
    Linked joint{source.kind,
                 side_of(source.body, frame, bodies),
                 side_of(source.other, other, bodies),
                 source.lower,
                 source.upper,
                 source.damping,
                 source.motor_speed,
                 source.motor_limit,
                 source.breaks_force,
                 source.breaks_torque,
                 source.joins_within,
                 source.joins_turn,
                 is_free(source.body, bodies),
                 is_free(source.other, bodies)};
    if (source.starts_apart) kept_[joints_.size()].hold = JointHold::kParted;
    const auto shared = [&](const Linked& other) {
      for (const int mine : {joint.first.body, joint.second.body}) {
        if (is_free(mine, bodies) && (mine == other.first.body || mine == other.second.body)) return true;
      }
      return false;
    };
    for (std::size_t i = 0; i < joints_.size(); ++i)
      if (shared(joints_[i])) joint.neighbours.push_back(static_cast<int>(i));
    joint.neighbours.push_back(static_cast<int>(joints_.size()));
    for (const int b : {source.body, source.other}) {
      if (is_free(b, bodies))
        joints_of_body_[static_cast<std::size_t>(b)].push_back(static_cast<int>(joints_.size()));
    }
    joints_.push_back(std::move(joint));
  }
  rows_of_body_.resize(bodies.size());
  regroup();
}

// By the joints that hold.
void JointSystem::regroup() {
  if (joints_.empty()) return;
  std::iota(groups_.begin(), groups_.end(), 0);
  std::vector<char> joined(groups_.size(), 0);
  connected_.clear();
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (!holds(kept_[j].hold)) continue;
    const Linked& joint = joints_[j];
    const int a = joint.first.body, b = joint.second.body;
    connected_.emplace(std::minmax(a, b));
    if (joint.first_free) joined[static_cast<std::size_t>(a)] = 1;
    if (joint.second_free) joined[static_cast<std::size_t>(b)] = 1;
    if (!joint.first_free || !joint.second_free) continue;
    const int from = groups_[static_cast<std::size_t>(a)];
    const int to = groups_[static_cast<std::size_t>(b)];
    std::replace(groups_.begin(), groups_.end(), from, to);
  }
  for (std::size_t b = 0; b < groups_.size(); ++b)
    if (!joined[b]) groups_[b] = -1;
}

bool JointSystem::change(const std::vector<RigidBody>& bodies, double time_step) {
  bool changed = false;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const Linked& joint = joints_[j];
    KeptJoint& kept = kept_[j];
    const Wrench& reaction = means_[j].reaction;
    const auto above = [](double limit, const glm::dvec3& is) {
      return limit > 0.0 && glm::length(is) > limit;
    };
    switch (kept.hold) {
      case JointHold::kJustJoined:
        kept.hold = JointHold::kJoined;
        break;
      case JointHold::kJoined:
        if (!above(joint.breaks_force, reaction.force) && !above(joint.breaks_torque, reaction.torque)) break;
        kept.hold = JointHold::kParted;
        kept.motor = kept.stop = 0.0;
        kept.impulse = Wrench{};
        changed = true;
        break;
      case JointHold::kParted:
        if (joint.joins_within > 0.0 && !near(joint, bodies, 0.0)) kept.hold = JointHold::kOpen;
        break;
      case JointHold::kOpen:
        if (!near(joint, bodies, time_step)) break;
        kept.hold = JointHold::kJustJoined;
        kept.rest = frames(joint, bodies).relative();
        changed = true;
        break;
    }
  }
  if (changed) regroup();
  return changed;
}

// Whether the two frames are as near each other as the joint closes from, or will be within `ahead` s: what
// is fast would pass between two steps.
bool JointSystem::near(const Linked& joint, const std::vector<RigidBody>& bodies, double ahead) const {
  const auto gone = [&](int body) { return body >= 0 && bodies[static_cast<std::size_t>(body)].gone; };
  const int a = joint.first.body, b = joint.second.body;
  if (gone(a) || gone(b)) return false;
  const JointFrames f = frames(joint, bodies);
  const glm::dvec3 apart = f.first.position - f.second.position;
  const glm::dvec3 speed =
      velocity_of(a, bodies, f.first.position) - velocity_of(b, bodies, f.second.position);
  const double square = glm::dot(speed, speed);
  const double nearest = square > 0.0 ? std::clamp(-glm::dot(apart, speed) / square, 0.0, ahead) : 0.0;
  const glm::dvec3 turned = rotation_between(f.second.orientation, f.first.orientation);
  return glm::length(apart + nearest * speed) <= joint.joins_within &&
         glm::length(turned) <= joint.joins_turn;
}

void JointSystem::recentre(int body, const glm::dvec3& off) {
  for (Linked& joint : joints_)
    for (JointSide* side : {&joint.first, &joint.second})
      if (side->body == body) side->point += off;
}

void JointSystem::begin_step() {
  std::fill(means_.begin(), means_.end(), JointState{});
}

// By its last impulses. A force F at an arm r turns the body back by (r·F)(1 − n nᵀ), n = F/|F|, about each
// axis (geometric stiffness; Tournier et al. 2015, Andrews et al. 2017). Leap-frog bears dt² K of four times
// the inertia; from twice on half of it is a damping, by the end velocity, which brings no energy in.
bool JointSystem::add_stiffness(int body, const std::vector<RigidBody>& bodies, double dt, Matrix6& drag,
                                Wrench& external) const {
  if (group_of(body) < 0) return false;
  const RigidBody& b = bodies[static_cast<std::size_t>(body)];
  glm::dmat3 stiffness(0.0);
  for (const int joint : joints_of_body_[static_cast<std::size_t>(body)]) {
    const auto j = static_cast<std::size_t>(joint);
    const double sign = joints_[j].first.body == body ? 1.0 : -1.0;
    const glm::dvec3 force = sign / dt * kept_[j].impulse.force;
    const double square = glm::dot(force, force);
    const double along = glm::dot(frames(joints_[j], bodies).point() - b.position, force);
    if (along > 0.0)
      stiffness += along * (glm::dmat3(1.0) - glm::outerProduct(force, force) * (1.0 / square));
  }
  const glm::dmat3 added = 0.5 * dt * dt * stiffness, left = b.world_inertia() - added;
  const double minor = left[0][0] * left[1][1] - left[0][1] * left[1][0];
  if (left[0][0] > 0.0 && minor > 0.0 && glm::determinant(left) > 0.0) return false;
  body_solve::add_block(drag, 3, 3, (1.0 / dt) * added);
  external.torque -= (1.0 / dt) * (added * b.angular_velocity);
  return true;
}

JointFrames JointSystem::frames(const Linked& joint, const std::vector<RigidBody>& bodies) const {
  return {pose_of(joint.first, bodies), pose_of(joint.second, bodies)};
}

double JointSystem::unwrapped(std::size_t joint, const JointFrames& frames) const {
  const JointKind kind = joints_[joint].kind;
  const double now = frames.coordinate(kind), before = kept_[joint].position;
  if (kind != JointKind::kHinge) return now;
  return before + std::remainder(now - before, 2.0 * std::numbers::pi);
}

void JointSystem::predict(const std::vector<RigidBody>& bodies, std::span<ViscousBody> out) const {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const Wrench& impulse = kept_[j].impulse;
    const glm::dvec3 point = frames(joints_[j], bodies).point();
    const auto give = [&](int b, double sign) {
      if (!is_free(b, bodies)) return;
      const auto index = static_cast<std::size_t>(b);
      const glm::dvec3 moment = impulse.torque + glm::cross(point - bodies[index].position, impulse.force);
      body_solve::add_vector(out[index].momentum, 0, sign * impulse.force);
      body_solve::add_vector(out[index].momentum, 3, sign * moment);
    };
    give(joints_[j].first.body, 1.0);
    give(joints_[j].second.body, -1.0);
  }
}

void JointSystem::report(const std::vector<RigidBody>& bodies, double dt, double share) {
  for (KeptJoint& kept : kept_) {
    kept.motor = kept.stop = 0.0;
    kept.impulse = Wrench{};
  }
  const auto add = [&](Wrench& to, std::size_t joint, const JointRow& row, double impulse) {
    const glm::dvec3 along = impulse * frames(joints_[joint], bodies).axis(row.axis);
    (row.turning ? to.torque : to.force) += along;
  };
  for (const Held& held : rows_) {
    const auto joint = static_cast<std::size_t>(held.joint);
    add(kept_[joint].impulse, joint, held.row, held.impulse);
    if (!held.damper) add(means_[joint].reaction, joint, held.row, share / dt * held.impulse);
  }
  for (const AxisRow& axis : axes_) {
    const auto joint = static_cast<std::size_t>(axis.joint);
    const double impulse = axis.sign * axis.row.impulse;
    const JointRow row = free_row(joints_[joint].kind);
    add(kept_[joint].impulse, joint, row, impulse);
    (axis.motor ? kept_[joint].motor : kept_[joint].stop) += impulse;
    if (axis.motor)
      means_[joint].motor += share / dt * impulse;
    else
      add(means_[joint].reaction, joint, row, share / dt * impulse);
  }
}

void JointSystem::fill(const std::vector<RigidBody>& bodies, std::vector<JointState>& out) const {
  out.resize(joints_.size());
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const Linked& joint = joints_[j];
    const JointFrames f = frames(joint, bodies);
    const int a = joint.first.body, b = joint.second.body;
    const glm::dvec3 moving = joint.kind == JointKind::kHinge
                                  ? turning_of(a, bodies) - turning_of(b, bodies)
                                  : velocity_of(a, bodies, f.point()) - velocity_of(b, bodies, f.point());
    out[j] = means_[j];
    out[j].joined = holds(kept_[j].hold);
    out[j].position = unwrapped(j, f);
    if (joint.kind == JointKind::kFixed) {
      const glm::dvec3 apart = f.first.position - f.second.position;
      const glm::dvec3 going =
          velocity_of(a, bodies, f.first.position) - velocity_of(b, bodies, f.second.position);
      out[j].speed = out[j].position > 0.0 ? glm::dot(going, apart) / out[j].position : 0.0;
      continue;
    }
    out[j].speed = glm::dot(f.axis(free_row(joint.kind).axis), moving);
  }
}

void JointSystem::restore(std::vector<KeptJoint> kept, std::vector<JointState> means) {
  kept_ = std::move(kept);
  means_ = std::move(means);
  regroup();
}

}  // namespace slosh
