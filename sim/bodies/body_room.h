// The space that bodies move in, and which of them have left it for good.
#pragma once

#include "scenes/scene.h"

namespace slosh {

class BodyRoom {
 public:
  /// The box around the scene's domain and all of its bodies where they begin, and as much again on every
  /// side as it is across.
  BodyRoom(const Scene& scene, const SampledScene& sampled);

  /// Whether a body there is out of it and will not come back by itself: what is only above it, by `gravity`
  /// (m/s²), falls back, from less than kHighest. `position` in m, world; one that is not finite is out.
  bool lost(const glm::dvec3& position, const glm::dvec3& gravity) const;

 private:
  static constexpr double kHighest = 1.0e6;  // m; a saved world has numbers up to 1e9
  glm::dvec3 lower_, upper_;                 // m, of the box
  double margin_;                            // m
};

}  // namespace slosh
