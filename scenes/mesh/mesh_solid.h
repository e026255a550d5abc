// The solid inside a mesh, by the mesh itself.
#pragma once

#include <vector>

#include "scenes/mesh/closed.h"
#include "scenes/mesh/tree.h"
#include "scenes/mesh/weld.h"
#include "scenes/solid_shape.h"

namespace slosh::mesh {

/// Of a mesh without defects (find_defects).
class MeshSolid final : public SolidShape {
 public:
  /// `tree`, `parts`: the mesh's.
  MeshSolid(const WeldedMesh& mesh, MeshTree tree, const Components& parts);

  DistanceSample at(const glm::vec3& point) const override;
  float thickness(const glm::vec3& surface, const glm::vec3& inward) const override;

 private:
  DistanceSample at(const MeshTree& tree, const glm::vec3& point) const;

  MeshTree whole_;
  std::vector<MeshTree> parts_;  // if there are several and none is a cavity
  bool cavities_ = false;
  float hair_;  // m: nearer than that a place is on the surface
};

}  // namespace slosh::mesh
