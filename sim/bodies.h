// Rigid bodies: state, couplings integrated implicitly, leap-frog (paper, section 4.2 and 4.3).
#pragma once

#include <span>
#include <vector>

#include "scenes/scene.h"
#include "sim/math/coupling.h"
#include "sim/math/dense.h"
#include "sim/math/pose.h"

namespace slosh {

struct HandleInput;

/// A body's state. Angular momentum, not angular velocity, is what is integrated: a free body keeps it
/// exactly.
struct RigidBody {
  bool free = false;
  bool point = false;       ///< translation only (a probe)
  double mass = 0.0;        ///< kg
  glm::dmat3 inertia{1.0};  ///< kg·m², about the centre of mass, body axes
  glm::dmat3 inverse_inertia{1.0};
  glm::dvec3 local_center{0.0};  ///< centre of mass in the mesh frame, m

  glm::dvec3 position{0.0};                    ///< of the centre of mass, world
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  ///< mesh axes to world
  glm::dvec3 velocity{0.0};                    ///< m/s, half a step behind position (leap-frog)
  glm::dvec3 angular_momentum{0.0};            ///< kg·m²/s, world
  glm::dvec3 angular_velocity{0.0};            ///< rad/s, world, from the momentum

  Pose mesh_pose() const { return {position - orientation * local_center, orientation}; }
  glm::dmat3 world_inertia() const;
  glm::dvec3 velocity_at(const glm::dvec3& where) const {
    return velocity + glm::cross(angular_velocity, where - position);
  }
};

RigidBody make_rigid_body(const Body& body);

/// A coupling for one step, with its lever arm on the body.
struct ActiveCoupling {
  int grip = 0;
  int body = 0;
  CouplingGains gains;  ///< ramped
  Pose handle;
  Twist handle_twist;
  glm::dvec3 arm{0.0};  ///< grip − centre of mass, world
  Pose grip_pose;       ///< world, at the start of the step
};

/// One body's velocity solve: M v⁺ = rhs with the couplings' stiffness and damping implicit in M, so that no
/// stiffness can blow the step up. Contacts then act on v⁺ through M⁻¹.
struct BodySolve {
  bool moves = false;  ///< false: the body stands still this step, whatever touches it
  Matrix6 factor{};    ///< Cholesky of M (linear first, angular after)
  Vector6 velocity{};  ///< v⁺, ω⁺
};

/// Sets up and solves the implicit step of a free body under `external` (fluid + gravity, about the centre of
/// mass) and its couplings, all solved together. False when the system is not finite.
bool solve_body(const RigidBody& body, const Wrench& external, std::span<const ActiveCoupling> couplings,
                double time_step, BodySolve& solve);

/// Takes over the solved velocity and moves the body on by one step.
void advance_body(RigidBody& body, const BodySolve& solve, double time_step);

/// The wrench that the coupling put on the body during the step, at the grip, from the solved velocity.
Wrench coupling_wrench(const ActiveCoupling& coupling, const BodySolve& solve, double time_step);

}  // namespace slosh
