// A rigid body's state.
#pragma once

#include "scenes/scene.h"
#include "sim/math/pose.h"

namespace slosh {

/// A body's state. Angular momentum, not angular velocity, is what is integrated: a free body keeps it
/// exactly.
struct RigidBody {
  bool free = false;
  bool point = false;   ///< translation only (a probe)
  bool driven = false;  ///< it goes by its keys (driven_bodies.h), and nothing acts on it
  bool gone = false;    ///< it left for good (body_room.h) and stands where it was then, or is away (kAway);
                        ///< nothing touches or holds it
  double mass = 0.0;    ///< kg
  glm::dmat3 inertia{1.0};  ///< kg·m², about the centre of mass, body axes
  glm::dmat3 inverse_inertia{1.0};
  glm::dvec3 local_center{0.0};  ///< centre of mass in the mesh frame, m

  glm::dvec3 position{0.0};                    ///< of the centre of mass, world
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  ///< mesh axes to world
  glm::dvec3 velocity{
      0.0};  ///< m/s, half a step behind position (leap-frog); of a driven one the next half step's
  glm::dvec3 angular_momentum{0.0};  ///< kg·m²/s, world
  glm::dvec3 angular_velocity{0.0};  ///< rad/s, world, from the momentum

  bool moves() const { return free && !gone; }
  bool is_fixed() const { return !free && !driven; }
  SLOSH_HD Pose mesh_pose() const { return {position - orientation * local_center, orientation}; }
  // Out of line: what the compiler fuses in it must not depend on its callers, or a run's hash would.
  SLOSH_HD __attribute__((noinline)) glm::dmat3 world_inertia() const {
    const glm::dmat3 r = glm::mat3_cast(orientation);
    return r * inertia * glm::transpose(r);
  }
  SLOSH_HD glm::dvec3 velocity_at(const glm::dvec3& where) const {
    return velocity + glm::cross(angular_velocity, where - position);
  }
};

/// As the scene has it, there or away.
RigidBody make_rigid_body(const Body& body);
/// Another mass, wherever its centre of mass now lies in it; position and momenta stay the numbers that they
/// are.
void take_mass(RigidBody& body, const MassProperties& mass);
/// What is left of a body, of that mass: each of its points is where it was and moves as it did.
RigidBody part_of(const RigidBody& body, const MassProperties& mass);
/// `body` where what is away is kept, at rest.
void put_away(RigidBody& body);

}  // namespace slosh
