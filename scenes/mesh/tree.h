// A tree of boxes over triangles: nearest point, ray hits, inside or out.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "scenes/scene.h"

namespace slosh::mesh {

struct NearestPoint {
  glm::vec3 point{0.0f};
  float distance = std::numeric_limits<float>::infinity();  ///< m
  int triangle = -1;                                        ///< −1: nothing within the bound
};

/// Immutable once built; queries are const and safe from several threads. Copies the mesh's triangles.
class MeshTree {
 public:
  explicit MeshTree(const TriangleMesh& mesh);

  /// Exact nearest point nearer than `bound` (m). `hint` is a triangle that is likely near, or −1.
  NearestPoint nearest(const glm::vec3& point, float bound = std::numeric_limits<float>::infinity(),
                       int hint = -1) const;

  /// Calls `hit(distance, triangle)` for every triangle that the ray from `origin` along the unit vector
  /// `direction` meets, in no particular order.
  void each_hit(const glm::vec3& origin, const glm::vec3& direction,
                const std::function<void(float, int)>& hit) const;

  /// True inside the union of the mesh's closed parts: the signed crossings of a ray, by the majority of
  /// three rays in skew directions, since one may graze an edge.
  bool inside(const glm::vec3& point) const;

  std::size_t triangle_count() const { return corners_.size(); }
  glm::vec3 face_normal(int triangle) const;  ///< unit, outward
  glm::vec3 low() const { return nodes_.empty() ? glm::vec3(0.0f) : nodes_[0].low; }
  glm::vec3 high() const { return nodes_.empty() ? glm::vec3(0.0f) : nodes_[0].high; }

 private:
  struct Corners {
    glm::vec3 a, b, c;
  };
  struct Node {
    glm::vec3 low;
    glm::vec3 high;
    std::int32_t first;  ///< leaf: first slot of order_; inner: index of the right child (the left is next)
    std::int32_t count;  ///< leaf: triangles; inner: 0
  };
  void build(std::int32_t begin, std::int32_t end, const std::vector<glm::vec3>& centers);

  std::vector<Corners> corners_;
  std::vector<std::int32_t> order_;
  std::vector<Node> nodes_;
};

/// Nearest point of a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
glm::vec3 nearest_on_triangle(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

}  // namespace slosh::mesh
