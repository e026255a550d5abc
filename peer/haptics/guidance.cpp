#include "peer/haptics/guidance.h"

#include <algorithm>

namespace slosh {
namespace {

constexpr double kThere = 1e-4;  // m: nearer than this nothing is off

glm::dvec3 no_more_than(const glm::dvec3& force, double most) {
  const double size = glm::length(force);
  return size > most ? force * (most / size) : force;
}

}  // namespace

glm::dvec3 Guidance::force(double time, const glm::dvec3& hand, const glm::dvec3& velocity, double dt,
                           double most_damping) noexcept {
  const double took = -glm::dot(last_, hand - place_);
  taken_ += took;
  stored_ = std::min(stored_ + took, kMaxStored);
  place_ = hand;

  const glm::dvec3 to_ghost = way_.at(time).pose.position - hand;
  const double off = glm::length(to_ghost);
  glm::dvec3 led(0.0);  // what of the velocity leads there
  if (off > kThere) {
    const glm::dvec3 there = to_ghost / off;
    led = std::max(0.0, glm::dot(velocity, there)) * there;
  }
  const glm::dvec3 brake = -std::min(kDamping, most_damping) * (velocity - led);
  glm::dvec3 draw = no_more_than(kStiffness * to_ghost, most_);
  // What the next tick may give is there before it is given.
  const double gives = std::max(0.0, glm::dot(draw, velocity) * dt);
  draw *= gives > 0.0 ? std::clamp(stored_ / gives, 0.0, 1.0) : (stored_ > 0.0 ? 1.0 : 0.0);
  last_ = no_more_than(brake + draw, most_);
  return last_;
}

}  // namespace slosh
