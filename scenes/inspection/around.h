// What stands around a fluid: of places inside a volume, the share that sees a body in a direction.
#pragma once

#include <vector>

#include "scenes/mesh/tree.h"
#include "scenes/scene.h"

namespace slosh::inspection {

/// `scene` must outlive it.
class Around {
 public:
  explicit Around(const Scene& scene);
  /// 0–1; `way` is a unit vector of the world.
  double closed(const FluidVolume& volume, const glm::dvec3& way) const;

 private:
  bool meets(const glm::dvec3& from, const glm::dvec3& way) const;
  const Scene& scene_;
  std::vector<mesh::MeshTree> trees_;
};

}  // namespace slosh::inspection
