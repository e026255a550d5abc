// How much of the light each channel loses on its way through the fluid: a map over the light's view. Beyond
// the paper.
#pragma once

#include <vector>

#include "render/frame.h"
#include "render/gl/pixel_program.h"
#include "render/passes/frame_block.h"
#include "render/passes/particles_on_gpu.h"
#include "render/renderer.h"

namespace slosh {

class FluidShadowPass {
 public:
  /// `compute`: by compute shaders.
  static Result<FluidShadowPass> create(bool fast, bool compute);

  /// By fragments. Reads all particles of the frame; writes the map and binds it. The map is empty without a
  /// shadow view.
  void draw(const Frame& frame, const RenderOptions& options, const ShadowView& shadow);
  /// The same by compute shaders, of particles that are on the GPU, in two steps of which nobody reads before
  /// gl::finish_compute(): sums, and the map of them. False: there is nothing to sum up, and the map is
  /// empty.
  bool start_sums(const Frame& frame, const RenderOptions& options, const ShadowView& shadow,
                  const ParticlesOnGpu& particles);
  void start_map();

 private:
  void clear() const;
  /// Clears and binds the map; whether there is something to draw into it.
  bool begin(const Frame& frame, const RenderOptions& options, const ShadowView& shadow, std::size_t count);
  /// Sets the program's uniforms, each particle drawn standing for `step`.
  void set_up(const gl::Program& program, const Frame& frame, const RenderOptions& options,
              const ShadowView& shadow, std::size_t step);

  gl::Program program_;
  gl::RowProgram rows_;    ///< for compute
  gl::PixelProgram sum_;   ///< for compute
  gl::StreamBuffer sums_;  ///< four whole numbers a texel (shaders/sums.glsl); zeros from picture to picture
  bool sums_ready_ = false;
  glm::vec3 alike_{0.0f};  ///< channels of what is summed once for all; 0: each by itself
  gl::Texture map_;
  gl::Framebuffer target_;
  gl::VertexArray array_;
  gl::StreamBuffer buffer_;
  std::vector<glm::vec4> particles_;
  bool compute_ = false;
  int size_ = 0;
  std::size_t most_ = 0;  ///< particles drawn at most; each then stands for several
};

}  // namespace slosh
