// The light's view of the opaque meshes: a depth map that mesh.frag and composite.frag read.
#pragma once

#include "render/frame.h"
#include "render/gl/objects.h"
#include "render/passes/frame_block.h"
#include "render/passes/meshes.h"

namespace slosh {

class ShadowPass {
 public:
  /// size: texels a side, > 0.
  static Result<ShadowPass> create(int size);

  /// Reads the opaque meshes, and how high the fluid stands; writes the depth map and binds it. Returns no
  /// shadow (size 0) for an empty scene.
  ShadowView draw(const Frame& frame, const MeshStore& meshes);

  int size() const { return size_; }

 private:
  gl::Program program_;
  gl::Texture map_;
  gl::Framebuffer target_;
  int size_ = 0;
};

/// World to the light's clip space, its orthographic box drawn round `box`. Its depth range holds all of the
/// box, and what is up to `highest` m along to_light.
glm::mat4 light_clip_from_world(const Bounds& box, const glm::vec3& to_light, float highest, int size);

/// The eight corners of a box, one by one.
glm::vec3 box_corner(const Bounds& box, int corner);

}  // namespace slosh
