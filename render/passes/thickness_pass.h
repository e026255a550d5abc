// How much fluid lies along each line of sight, summed particle by particle: two layers with air between
// count as two. Beyond the paper, whose thickness is back less front.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "render/frame.h"
#include "render/gl/pixel_program.h"
#include "render/passes/particles_on_gpu.h"
#include "render/passes/targets.h"
#include "render/renderer.h"

namespace slosh {

class ThicknessPass {
 public:
  /// `compute`: by compute shaders.
  static Result<ThicknessPass> create(bool compute);

  /// By fragments. Reads S_d and `spheres` (eye position m, fluid; all of them, hidden ones too); writes
  /// targets.chord.
  void draw(const Frame& frame, const Targets& targets, std::span<const glm::vec4> spheres);
  /// Where compute shaders add up.
  struct Sums {
    gl::StreamBuffer texels;  ///< a whole number each (shaders/sums.glsl); zeros from picture to picture
    glm::ivec2 size{0};
  };
  /// The same by compute shaders, of particles on the GPU, as the view whose uniform block is bound sees them
  /// (`reach`: m, of what is drawn of one): the sums, and then the chords of them. Nobody reads either before
  /// gl::finish_compute().
  void start_sums(const Frame& frame, const Targets& targets, const ParticlesOnGpu& particles, float reach,
                  Sums& sums) const;
  void start_chords(const Targets& targets, const Sums& sums) const;

 private:
  static void set_up(const gl::Program& program, const Frame& frame, const Targets& targets);

  gl::Program program_;
  gl::RowProgram rows_;   ///< for compute
  gl::PixelProgram sum_;  ///< for compute
  gl::VertexArray array_;
  gl::StreamBuffer buffer_;
};

/// Some fluid of the frame lets light through a layer of a few particles: else nobody sees how thick it is.
bool any_fluid_is_clear(const Frame& frame);

}  // namespace slosh
