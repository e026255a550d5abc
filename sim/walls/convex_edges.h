// Where a layer lies behind convex edges.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "scenes/scene.h"
#include "sim/walls/point_buckets.h"

namespace slosh {

/// The faces that meet in convex edges, as samples of them show. A distance field, which is coarse, is round
/// along edges: it moves a layer there by up to an eighth of a spacing, as its nodes happen to lie, and leads
/// some samples nowhere.
class ConvexEdges {
 public:
  /// `surface` must outlive it. `spacing`: of particles, m.
  ConvexEdges(const SurfaceSamples& surface, float spacing);

  /// Where sample `i` lies once it is `depth` m (> 0) behind the faces near it, m, mesh frame: on the edge of
  /// a body that is smaller by so much all round. None where its own is the only face near, or another meets
  /// it in a concave edge, or the faces leave no such place.
  std::optional<glm::vec3> behind(std::size_t i, float depth) const;

 private:
  struct Face {
    glm::vec3 at, normal;
  };

  const SurfaceSamples& surface_;
  float reach_;  // m
  PointBuckets samples_;
};

}  // namespace slosh
