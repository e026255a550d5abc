#include "sim/walls/surface_motion.h"

namespace slosh {

SurfaceMotion surface_motion(const RigidBody& body) {
  return {glm::mat3(glm::mat3_cast(body.orientation)), glm::vec3(body.mesh_pose().position),
          glm::vec3(body.position), glm::vec3(body.velocity), glm::vec3(body.angular_velocity)};
}

}  // namespace slosh
