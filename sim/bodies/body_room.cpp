#include "sim/bodies/body_room.h"

#include <limits>

namespace slosh {

BodyRoom::BodyRoom(const Scene& scene, const SampledScene& sampled)
    : lower_(std::numeric_limits<double>::infinity()), upper_(-std::numeric_limits<double>::infinity()) {
  const auto include = [&](const glm::dvec3& p) {
    lower_ = glm::min(lower_, p);
    upper_ = glm::max(upper_, p);
  };
  if (glm::all(glm::lessThan(scene.domain_min, scene.domain_max))) {
    include(scene.domain_min);
    include(scene.domain_max);
  }
  for (const glm::vec3& p : sampled.fluid_positions) include(glm::dvec3(p));
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Pose& pose = scene.bodies[b].pose;
    include(pose.position);
    for (const glm::vec3& p : sampled.surfaces[b].positions) include(transform_point(pose, glm::dvec3(p)));
  }
  if (scene.bodies.empty()) lower_ = upper_ = glm::dvec3(0.0);
  margin_ = glm::length(upper_ - lower_);
}

bool BodyRoom::lost(const glm::dvec3& position, const glm::dvec3& gravity) const {
  glm::dvec3 out = position - glm::clamp(position, lower_, upper_);
  if (!(glm::length(out) <= kHighest)) return true;
  const double g = glm::length(gravity);
  if (g > 0.0) {
    const glm::dvec3 down = gravity / g;
    out -= glm::min(0.0, glm::dot(out, down)) * down;
  }
  return glm::length(out) > margin_;
}

}  // namespace slosh
