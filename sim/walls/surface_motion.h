// A rigid body's motion as its particles need it (Eq 14).
#pragma once

#include <glm/glm.hpp>

#include "sim/bodies/rigid_body.h"
#include "sim/math/host_device.h"

namespace slosh {

struct SurfaceMotion {
  glm::mat3 turn{1.0f};              ///< mesh axes to world
  glm::vec3 shift{0.0f};             ///< origin of the mesh frame, m, world
  glm::vec3 center{0.0f};            ///< centre of mass, m, world
  glm::vec3 velocity{0.0f};          ///< m/s
  glm::vec3 angular_velocity{0.0f};  ///< rad/s

  SLOSH_HD glm::vec3 place(const glm::vec3& local) const { return turn * local + shift; }
  SLOSH_HD glm::vec3 velocity_at(const glm::vec3& placed) const {
    return velocity + glm::cross(angular_velocity, placed - center);
  }
};

SurfaceMotion surface_motion(const RigidBody& body);
/// The same with another twist about its centre of mass.
SurfaceMotion surface_motion(const RigidBody& body, const Twist& twist);

}  // namespace slosh
