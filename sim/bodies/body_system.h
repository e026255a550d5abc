// All rigid bodies of a world: couplings, contacts and motion, sub-step by sub-step.
#pragma once

#include <span>
#include <vector>

#include "sim/bodies/blades.h"
#include "sim/bodies/body_room.h"
#include "sim/bodies/contacts.h"
#include "sim/bodies/cut_bodies.h"
#include "sim/bodies/driven_bodies.h"
#include "sim/bodies/hands.h"
#include "sim/bodies/joints.h"
#include "sim/passes/implicit_viscosity/implicit.h"
#include "sim/plan.h"
#include "sim/snapshot.h"

namespace slosh {

/// What acts on the bodies in one sub-step.
struct BodyForces {
  std::span<const Wrench> fluid;   ///< one a body, about its centre of mass
  std::span<const Matrix6> drags;  ///< one a body: what `fluid` loses for each unit of twist; or none at all
  glm::dvec3 gravity{0.0};         ///< m/s²
};

/// Who moves in a sub-step: all, or while a scene settles the fluid alone, then also the bodies that hands
/// hold.
enum class TakePart { kFluid, kHeld, kAll };

/// A sub-step of a step.
struct SubStep {
  double dt = 0.0;       ///< s
  double elapsed = 0.0;  ///< s since the step began
  double share = 1.0;    ///< dt over the step's length
  TakePart part = TakePart::kAll;
  double until = 0.0;  ///< s of the world's time at its end
};

class BodySystem {
 public:
  BodySystem(const Scene& scene, const SampledScene& sampled);

  /// Takes the handles' inputs of a step and forgets what the step before put on the hands. Returns
  /// StatusBits.
  /// `time_step` in s.
  std::uint32_t begin_step(std::span<const HandleInput> handles, double time_step);
  /// Gives driven bodies the twist of the sub-step, before all else of it; while a scene settles none.
  void drive(const SubStep& step);
  /// The velocities that the bodies end the sub-step with, by couplings, joints and contacts as far as the
  /// plan has them. Returns StatusBits.
  std::uint32_t solve(const Plan& plan, const BodyForces& forces, const SubStep& step);
  /// Every body as implicit viscosity needs it, one a body: as solve() will find it under the same forces,
  /// with what contacts and joints gave in the last sub-step for what they will give now.
  void predict(const Plan& plan, const BodyForces& forces, const SubStep& step, std::span<ViscousBody> out);
  /// By how much they differ from those that it began with, one a body.
  std::span<const Twist> changes() const { return changes_; }
  /// At a step's end: joints that were pulled too hard let go, open ones that come together close.
  void change_joints(double time_step) {
    if (joints_.change(bodies_, time_step)) finder_.leave_out(joints_.connected());
  }
  /// Moves the bodies on by the sub-step that was solved.
  void move(const SubStep& step);
  /// Takes what left for good (BodyRoom) and is held by nobody out of the motion: it stands still from then
  /// on. After move(). Returns StatusBits.
  std::uint32_t part_with_lost(const glm::dvec3& gravity);

  /// Between steps: puts a body, by its number, out of the world, or one that is away in.
  void take_away(int body) { put_away(bodies_[static_cast<std::size_t>(body)]); }
  void bring(int body, const RigidBody& as) { become(body, as); }
  /// Between steps: what of `body` is beyond `plane`, in its mesh frame, is `piece`, which was away, from now
  /// on. `rest` and `off` are what the two are within their planes.
  void part(int body, const PieceShape& rest, int piece, const PieceShape& off, const CutPlane& plane);
  /// Another surface of a body that may be cut; its mass is bring()'s or restore()'s.
  void reshape(int body, const PieceShape& shape);
  const CutBodies& cuts() const { return cuts_; }
  const Blades& blades() const { return blades_; }
  /// A blade went through: into two, or it was refused.
  void end_cut(const Incision& through, int piece) { blades_.part(through, through.body, piece); }
  void refuse(const Incision& incision) { blades_.refuse(incision); }
  void restore(std::vector<Incision> incisions) { blades_.restore(std::move(incisions)); }
  const ContactFinder& shapes() const { return finder_; }
  const DrivenBodies& driven() const { return driven_; }

  /// Multiplies the velocities of the bodies that a hand holds, itself or by joints, by `keep`.
  void damp_held(double keep);

  const std::vector<RigidBody>& bodies() const { return bodies_; }
  /// Handles and what was put on the hands, as means over the last step; poses and twists are not set.
  const std::vector<GripState>& grips() const { return grips_; }
  const std::vector<HandleInput>& last_inputs() const { return hands_.last(); }
  const Hands::Stiffness& grip_stiffness() const { return hands_.stiffness(); }
  void want_grip_stiffness(std::size_t grip, double scale) { hands_.want_stiffness(grip, scale); }
  const std::vector<KeptImpulse>& kept_impulses() const { return memory_.kept(); }
  const JointSystem& joints() const { return joints_; }
  void restore_joints(std::vector<KeptJoint> kept, std::vector<JointState> means) {
    joints_.restore(std::move(kept), std::move(means));
    finder_.leave_out(joints_.connected());
  }
  void restore(std::vector<RigidBody> bodies, std::vector<GripState> grips, std::vector<HandleInput> inputs,
               Hands::Stiffness stiffness, std::vector<KeptImpulse> impulses);

 private:
  std::span<const ActiveCoupling> couplings_of(int body) const;
  void become(int body, const RigidBody& as);
  void find_contacts(const Plan& plan, double dt);
  bool is_held(int body) const;
  const Matrix6* drag_on(int body, const BodyForces& forces, double dt, Matrix6& room,
                         Wrench& external) const;
  std::uint32_t solve_alone(const BodyForces& forces, const SubStep& step);
  void report(const SubStep& step);

  std::vector<ContactMaterial> materials_;
  std::vector<RigidBody> bodies_;
  DrivenBodies driven_;
  JointSystem joints_;
  BodyRoom room_;
  ContactFinder finder_;
  CutBodies cuts_;
  Blades blades_;
  Hands hands_;
  std::span<const ActiveCoupling> couplings_;  // of this sub-step
  std::vector<BodySolve> solves_;
  std::vector<Twist> changes_;
  std::vector<Contact> contacts_;
  ContactMemory memory_;
  std::vector<GripState> grips_;
};

}  // namespace slosh
