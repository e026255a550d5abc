// The bodies' faces: drops of foam do not pass them, and what fluid is left on them lies flat.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "render/frame.h"
#include "scenes/mesh/tree.h"
#include "scenes/scene.h"
#include "sim/snapshot.h"

namespace slosh {

class BodyWalls {
 public:
  /// A tree a body that has a mesh. `scene` must outlive it. `clearance`: m that a drop keeps off a face.
  BodyWalls(const Scene& scene, float clearance);

  /// The bodies of a new snapshot, one a body of the scene; those before are kept for stop(). What was cut
  /// since has other faces.
  void move(const BodySnapshot& now);

  /// Where a drop that goes from `from`, among the bodies as they were, to `to`, among them as they are, is
  /// stopped by a face on its way: before it, and moved along with it. Nothing: it gets there. m, world.
  std::optional<glm::vec3> stop(const glm::vec3& from, const glm::vec3& to) const;
  /// The same among the bodies as they are.
  std::optional<glm::vec3> stop_now(const glm::vec3& from, const glm::vec3& to) const;

  /// The nearest face within `reach`, among the bodies as they are. m, world.
  std::optional<WallPoint> nearest(const glm::vec3& at, float reach) const;

 private:
  struct Wall {
    std::size_t body;
    std::vector<CutPlane> planes;
    mesh::MeshTree tree;
    Pose before;
    Pose now;
  };
  std::optional<glm::vec3> stop(const glm::vec3& from, const glm::vec3& to, bool moved) const;

  void follow_cuts(const BodyCuts* cuts);

  const Scene& scene_;
  std::shared_ptr<const BodyCuts> cuts_;
  std::vector<Wall> walls_;
  float clearance_;
  bool placed_ = false;
};

}  // namespace slosh
