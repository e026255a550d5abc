// The work of fluid, weight and contacts on a held body at the host, from the host's updates alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "peer/replica/body_replica.h"
#include "peer/replica/host_update.h"

namespace slosh {

/// The balance of each interval between two updates: what acts besides couplings gave what the body's motion
/// gained and what its couplings were given. Of steps that were missed the coupling's forces are taken to
/// have gone over evenly, and velocities with them. Allocates when made; one thread.
class LoadWork {
 public:
  LoadWork(const ReplicaBody& body, const std::vector<ReplicaGrip>& grips) : body_(body) {
    for (const ReplicaGrip& grip : grips) arms_.push_back(grip.pose.position - body.center);
    before_.resize(grips.size());
  }

  /// Another mass; restart() follows.
  void become(const ReplicaBody& body) noexcept {
    for (glm::dvec3& arm : arms_) arm += body_.center - body.center;
    body_ = body;
  }

  /// The next update restarts at 0.
  void restart() noexcept {
    known_ = false;
    work_ = 0.0;
  }
  void receive(const HostUpdate& word) noexcept {
    const RigidMotion& now = word.motion;
    const double elapsed = word.time - time_;
    const double kinetic = kinetic_energy(now);
    if (known_ && elapsed > 0.0) {
      // A step's forces act over the way of that step: of n steps with forces that rise evenly the mean is
      // this much on the newest one's side.
      const double steps = word.time_step > 0.0 ? std::max(std::round(elapsed / word.time_step), 1.0) : 1.0;
      const double newer = 0.5 * (steps + 1.0) / steps;
      // And where both rise together, more is given than mean times mean.
      const double together = elapsed * (steps * steps - 1.0) / (12.0 * steps * steps);
      const glm::dvec3 spun = now.twist.angular - last_.twist.angular;
      const glm::dvec3 turn = rotation_between(last_.orientation, now.orientation);
      double given = kinetic - kinetic_;
      for (std::size_t g = 0; g < before_.size() && g < word.hands.size(); ++g) {
        const Wrench& is = word.hands[g].on_hand;
        const Wrench& was = before_[g];
        const glm::dvec3 gained =
            now.twist.linear + glm::cross(now.twist.angular, now.orientation * arms_[g]) -
            last_.twist.linear - glm::cross(last_.twist.angular, last_.orientation * arms_[g]);
        const glm::dvec3 way =
            now.position + now.orientation * arms_[g] - last_.position - last_.orientation * arms_[g];
        given += glm::dot(newer * is.force + (1.0 - newer) * was.force, way) +
                 glm::dot(newer * is.torque + (1.0 - newer) * was.torque, turn) +
                 together * (glm::dot(is.force - was.force, gained) + glm::dot(is.torque - was.torque, spun));
      }
      if (std::isfinite(given)) work_ += given;
    }
    if (known_ && elapsed <= 0.0) return;
    for (std::size_t g = 0; g < before_.size() && g < word.hands.size(); ++g)
      before_[g] = word.hands[g].on_hand;
    last_ = now;
    time_ = word.time;
    kinetic_ = kinetic;
    known_ = true;
  }
  double work() const noexcept { return work_; }        ///< J since restart()
  double kinetic() const noexcept { return kinetic_; }  ///< J of the newest update's motion

 private:
  double kinetic_energy(const RigidMotion& m) const noexcept {
    double energy = 0.5 * body_.mass * glm::dot(m.twist.linear, m.twist.linear);
    if (body_.point) return energy;
    const glm::dmat3 r = glm::mat3_cast(m.orientation);
    const glm::dvec3 turning = glm::transpose(r) * m.twist.angular;
    return energy + 0.5 * glm::dot(turning, body_.inertia * turning);
  }

  ReplicaBody body_;
  std::vector<glm::dvec3> arms_;  // centre of mass to grip, body axes
  std::vector<Wrench> before_;
  RigidMotion last_;
  double time_ = 0.0;
  double kinetic_ = 0.0;
  double work_ = 0.0;
  bool known_ = false;
};

}  // namespace slosh
