// What happens to one particle once its sums are known: pressure from density, and the leap-frog.
#pragma once

#include <glm/glm.hpp>

#include "sim/math/sph.h"

namespace slosh {

/// What a particle has after the density pass.
struct PressureState {
  float pressure;     ///< Pa; kConsistent: V²P, N·m⁴
  float volume;       ///< m³
  float compression;  ///< ρ/ρ⁰ − 1
};

/// Bulk damping of the consistent model: this times the compression gained since the last step is felt on top
/// of the compression itself. It takes the ring out of sound and the bounce out of a drop that meets a wall,
/// which without it comes back with up to twice its speed (a contact lasts about three steps); shear does not
/// feel it. Explicit, so with ω the stiffest mode (1 + 2 · this) ω²Δt² must stay below 4.
inline constexpr float kBulkDamping = 0.25f;

/// Eq 7 from the density kernel's sum over neighbours (itself included), measured against the rest lattice's
/// sum. `last_volume` (> 0) is the particle's volume one step ago, the rest volume at the start.
SLOSH_HD inline PressureState pressure_state(float sum, float rest_sum, float rest_volume, float rest_density,
                                             float stiffness, float tension, float last_volume,
                                             bool consistent) {
  const float compression = sum / rest_sum - 1.0f;
  const float effective = effective_compression(compression, tension);
  float felt = effective;
  if (consistent && effective > 0.0f) {
    const float gained = effective - (rest_volume / last_volume - 1.0f);
    felt = RealOps<float>::positive_part(effective + kBulkDamping * gained);
  }
  const float pressure = stiffness * rest_density * felt;
  const float volume = rest_volume / (1.0f + effective);
  return {consistent ? volume * volume * pressure : pressure, volume, compression};
}

/// A rigid body's motion as its particles need it (Eq 14).
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
