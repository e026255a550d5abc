// Bodies that go by their keys, whatever acts on them.
#pragma once

#include <span>
#include <vector>

#include "sim/bodies/rigid_body.h"
#include "sim/passes/implicit_viscosity/implicit.h"

namespace slosh {

/// Where keys have a body at `time` s: straight between two of them, turning about one axis. Before the first
/// and after the last it stands, or with `repeats` begins again. At least one key.
Pose pose_at(std::span<const PoseKey> keys, bool repeats, double time);

class DrivenBodies {
 public:
  DrivenBodies(const Scene& scene, const SampledScene& sampled);

  bool any() const { return !driven_.empty(); }
  /// Gives each the twist that takes it within `dt` s from where it is to where its keys have it at the time
  /// `until` s of the world.
  void drive(std::vector<RigidBody>& bodies, double until, double dt);
  /// Where the keys of a driven body have it at `time` s of the world.
  Pose pose_of(int body, double time) const;
  /// Each stands where it is in the next sub-step.
  void stand(std::vector<RigidBody>& bodies);
  /// Where the sub-step that was driven takes them.
  void move(std::vector<RigidBody>& bodies) const;
  /// A body like the one at the sub-step's end.
  RigidBody moved(const RigidBody& body, int index) const;

  /// A driven body for a solve with the fluid: so heavy that the fluid changes nothing of its twist, and what
  /// the fluid gives it can be read.
  ViscousBody as_heavy(const RigidBody& body, int index) const;

 private:
  struct Driven {
    int body = 0;
    std::vector<PoseKey> keys;
    bool repeats = false;
    double reach = 0.0;  // m of the surface from the mesh frame's origin
    Pose target;         // at the end of the sub-step
  };
  const Driven& of(int body) const;
  static void stand(RigidBody& body, Driven& driven);

  std::vector<Driven> driven_;
  double mass_ = 0.0;  // kg that they count as
};

}  // namespace slosh
