// Triangles and the nearest of them along a ray, by Embree. No Embree type leaves ray_scene.cpp and
// embree_library.h.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "render/frame.h"
#include "sim/math/result.h"

namespace slosh::reference {

struct Triangles {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< one a position
  std::vector<glm::uvec3> triangles;
  std::vector<glm::vec2> texcoords;  ///< one a position, or empty
};

struct Hit {
  float distance = std::numeric_limits<float>::infinity();  ///< m
  glm::vec3 face{0.0f};                                     ///< unit: the triangle's own normal, outward
  glm::vec3 normal{0.0f};                                   ///< unit: as the vertices have it, outward
  const MeshLook* look = nullptr;                           ///< of a mesh
  int fluid = -1;  ///< of a fluid's surface: index into Frame::fluids
  // Of a mesh with texture coordinates: where, and two edges of its triangle, world and texture.
  glm::vec2 texcoord{0.0f};
  glm::vec3 edges[2]{};
  glm::vec2 texture_edges[2]{};
  bool there() const { return distance < std::numeric_limits<float>::infinity(); }
};

class RayScene {
 public:
  /// Errors: built without Embree, none installed, or it cannot start.
  static Result<bool> available();

  RayScene();
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// `look` must outlive the scene; null and `fluid` >= 0 for a fluid's surface.
  void add(const Triangles& mesh, const glm::mat4& model, const MeshLook* look, int fluid);
  /// After the last add, before the first ray.
  void finish();
  /// way: unit. By any thread.
  Hit nearest(const glm::vec3& from, const glm::vec3& way) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace slosh::reference
