// Light that the fluid's surface focuses on what lies below it. Beyond the paper.
#pragma once

#include "render/frame.h"
#include "render/gl/objects.h"
#include "render/passes/targets.h"

namespace slosh {

class CausticsPass {
 public:
  /// Errors: a shader that the driver refuses.
  static Result<CausticsPass> create();

  /// Reads the smoothed depths and S_d; writes the sums and binds them (fluid_look.frag, CAUSTICS).
  void draw(const Frame& frame, const Targets& targets, const gl::Texture& smoothed);
  /// RG32F, Targets::half_size: light that arrives, and through a level surface.
  const gl::Texture& sums() const { return sums_; }

 private:
  gl::Program program_;
  gl::Texture sums_;
  gl::Framebuffer target_;
  gl::VertexArray no_vertices_;
  glm::ivec2 size_{0};
};

}  // namespace slosh
