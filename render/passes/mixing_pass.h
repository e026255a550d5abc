// Where fluids meet: how much of each is in the surface, so that the boundary between them is soft. Beyond
// the paper, whose front-most particle brings its look.
#pragma once

#include <memory>
#include <vector>

#include "render/frame.h"
#include "render/gl/pixel_program.h"
#include "render/passes/splats.h"
#include "render/passes/targets.h"

namespace slosh {

class MixingPass {
 public:
  /// `compute`: by compute shaders. Errors: a shader that the driver refuses.
  static Result<MixingPass> create(bool compute);

  /// Reads the smoothed depths and `spheres` (`count` of Splats::spheres, as moved); writes the shares of
  /// fluids 0 to 4 · `layers` − 1, four a texture.
  void draw(const Frame& frame, const Targets& targets, const gl::Texture& smoothed,
            const gl::StreamBuffer& spheres, std::size_t count, int layers);
  /// Binds what draw() wrote, from unit 12 on.
  void bind() const;

 private:
  /// Makes the first `layers` textures, of `size`.
  void make_shares(glm::ivec2 size, int layers);

  gl::Program program_;
  gl::RowProgram rows_;    ///< for compute
  gl::PixelProgram sum_;   ///< for compute
  gl::StreamBuffer sums_;  ///< four whole numbers a texel (shaders/sums.glsl)
  gl::VertexArray no_vertices_;
  std::vector<gl::Texture> shares_;  ///< RGBA16F
  std::vector<gl::Framebuffer> share_targets_;
  glm::ivec2 size_{0};
  bool compute_ = false;
};

/// Textures that the shares of what is on screen take: 0 where it is all of one fluid.
int mixing_layers(const Frame& frame, const Splats& splats);
/// The same of all the frame's particles, where nobody knows which are on screen.
int mixing_layers(const Frame& frame);

}  // namespace slosh
