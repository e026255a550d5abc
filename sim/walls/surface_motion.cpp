#include "sim/walls/surface_motion.h"

namespace slosh {

SurfaceMotion surface_motion(const RigidBody& body) {
  return surface_motion(body, {body.velocity, body.angular_velocity});
}

SurfaceMotion surface_motion(const RigidBody& body, const Twist& twist) {
  return {glm::mat3(glm::mat3_cast(body.orientation)), glm::vec3(body.mesh_pose().position),
          glm::vec3(body.position), glm::vec3(twist.linear), glm::vec3(twist.angular)};
}

}  // namespace slosh
