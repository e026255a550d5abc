// Arrows in the world, as lit cones on shafts, dim where something hides them.
#pragma once

#include <string>
#include <vector>

#include "render/frame.h"
#include "render/gl/objects.h"
#include "render/passes/targets.h"
#include "render/renderer.h"

namespace slosh {

struct ArrowVertex {
  glm::vec3 position;  ///< m, world
  glm::vec3 normal;
  glm::vec3 color;
};

/// Triangles of one arrow, appended; nothing for an arrow without length or with a non-finite end. Its width
/// follows its length, within 2 to 12 mm a metre from the eye to `eye_distance`.
void append_arrow(const Arrow& arrow, float eye_distance, std::vector<ArrowVertex>& out);

class ArrowPass {
 public:
  static Result<ArrowPass> create(const std::vector<std::string>& defines);
  /// Reads S_d and the fluid's depth (null: none); blends into color. The depth buffer is used up.
  void draw(const Frame& frame, const Targets& targets, const gl::Texture* fluid);

 private:
  gl::Program program_;
  gl::VertexArray array_;
  gl::StreamBuffer buffer_;
  std::vector<ArrowVertex> vertices_;
};

}  // namespace slosh
