// The light's view of the opaque meshes: a depth map, and how far its depths reach, for shadow.glsl.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "render/frame.h"
#include "render/gl/objects.h"
#include "render/passes/frame_block.h"
#include "render/passes/meshes.h"

namespace slosh {

class ShadowPass {
 public:
  /// size: texels a side, > 0.
  static Result<ShadowPass> create(int size);

  /// Reads the opaque meshes, and where the fluid is; writes the depth map that serves all `views` (one at
  /// least) and binds it. A map that would come out the same is kept. Returns no shadow (size 0) for an empty
  /// scene.
  ShadowView draw(const Frame& frame, const MeshStore& meshes, std::span<const View> views);

  int size() const { return size_; }

 private:
  /// A mesh in the map.
  struct Shown {
    MeshHandle mesh;
    glm::mat4 clip_from_model;
    bool operator==(const Shown&) const = default;
  };
  void draw_map(const MeshStore& meshes, std::span<const Shown> shown);
  void find_reach(int tiles_beside);

  std::optional<std::vector<Shown>> kept_;  ///< what the map shows
  gl::Program program_;
  gl::Program tiles_program_;
  gl::Program reach_program_;
  gl::VertexArray no_vertices_;
  gl::Texture map_;
  gl::Framebuffer target_;
  gl::Texture tiles_;  ///< nearest and farthest depth of 8 × 8 texels
  gl::Framebuffer tiles_target_;
  gl::Texture reach_;  ///< of them and some beside them
  gl::Framebuffer reach_target_;
  int size_ = 0;
};

}  // namespace slosh
