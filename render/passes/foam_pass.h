// Foam, spray and bubbles over the fluid.
#pragma once

#include "render/frame.h"
#include "render/gl/objects.h"
#include "render/passes/targets.h"

namespace slosh {

class FoamPass {
 public:
  static Result<FoamPass> create(const std::vector<std::string>& defines);
  /// Blends Frame::foam into color; what is not finite is left out. `fluid` is the smoothed F_fD, null
  /// without fluid.
  void draw(const Frame& frame, const Targets& targets, const gl::Texture* fluid);

 private:
  gl::Program program_;
  gl::VertexArray array_;
  gl::StreamBuffer buffer_;
  std::vector<FoamPoint> points_;
};

}  // namespace slosh
