// How a particle moves once its force is known.
#pragma once

#include <glm/glm.hpp>

#include "sim/math/host_device.h"

namespace slosh {

/// Leap-frog (section 3.1): v(t+½) from the force and gravity, at most max_speed, then x(t+1). True when the
/// speed was limited. `per_mass` is the time step over the mass.
SLOSH_HD inline bool advance_particle(const glm::vec3& force, float per_mass, const glm::vec3& gravity,
                                      float time_step, float max_speed, glm::vec3& x, glm::vec3& v) {
  v = glm::vec3(v.x + per_mass * force.x, v.y + per_mass * force.y, v.z + per_mass * force.z);
  v += time_step * gravity;
  const float speed = glm::length(v);
  const bool limited = speed > max_speed;
  if (limited) v *= max_speed / speed;
  x.x += time_step * v.x;
  x.y += time_step * v.y;
  x.z += time_step * v.z;
  return limited;
}

}  // namespace slosh
