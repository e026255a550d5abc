// Meshes kept on the GPU.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/frame.h"
#include "render/gl/objects.h"

namespace slosh {

/// An axis-aligned box; empty while low > high.
struct Bounds {
  glm::vec3 low{1e30f};
  glm::vec3 high{-1e30f};

  void add(const glm::vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void add(const Bounds& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  bool empty() const { return low.x > high.x; }
};

class MeshStore {
 public:
  MeshHandle add(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                 std::span<const glm::uvec3> triangles, std::span<const glm::vec2> texcoords = {});

  void remove(MeshHandle handle) {
    if (handle < meshes_.size()) meshes_[handle] = {};
  }

  bool has(MeshHandle handle) const { return handle < meshes_.size() && meshes_[handle].index_count > 0; }
  /// The mesh's box in its own frame.
  const Bounds& bounds(MeshHandle handle) const { return meshes_[handle].bounds; }
  /// All of it lies behind each of its triangles (of small meshes alone: a large one is taken not to be).
  bool convex(MeshHandle handle) const { return meshes_[handle].convex; }
  /// Every edge is of two triangles that go along it in opposite ways, and its volume is positive: from
  /// outside of its box nobody sees an inside (a large mesh is taken not to be).
  bool closed(MeshHandle handle) const { return meshes_[handle].closed; }
  std::size_t triangle_count(MeshHandle handle) const {
    return static_cast<std::size_t>(meshes_[handle].index_count) / 3;
  }
  /// GL names of its buffers: a position and a normal each, six floats; three corners a triangle.
  GLuint vertices(MeshHandle handle) const { return meshes_[handle].vertices.name(); }
  GLuint indices(MeshHandle handle) const { return meshes_[handle].indices.name(); }
  /// Issues the draw call; the program is the caller's.
  void draw(MeshHandle handle) const;

 private:
  struct Mesh {
    gl::Buffer vertices;
    gl::Buffer texcoords;
    gl::Buffer indices;
    gl::VertexArray array;
    GLsizei index_count = 0;
    Bounds bounds;
    bool convex = false;
    bool closed = false;
  };
  std::vector<Mesh> meshes_;
};

}  // namespace slosh
