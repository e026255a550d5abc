// A frame's particles where compute shaders draw: given once, sorted into cells, moved and shaped by their
// neighbours (what smooth_centers does on a CPU), once for all views; then placed for each view. What comes
// out is the same each time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/frame.h"
#include "render/gl/objects.h"
#include "render/passes/given_particles.h"

namespace slosh {

/// Splats of a view: eye position m, index into Frame::fluids, or −1 where nothing is seen of it.
struct SplatBuffers {
  gl::StreamBuffer spheres;  ///< vec4
  gl::StreamBuffer shapes;   ///< SplatShape, of moved spheres
  std::size_t count = 0;     ///< of spheres, if `seen` is null
  bool shaped = false;
  /// Where the GPU has how many spheres there are, a uint; null: `count`.
  const gl::StreamBuffer* seen = nullptr;
  int seen_at = -1;  ///< which of its uints
};

class ParticlesOnGpu {
 public:
  /// Errors carry the driver's log.
  static Result<ParticlesOnGpu> create();

  /// Takes the frame's particles. `moves`: they are counted into cells, to be sorted and smoothed.
  void take(const Frame& frame, bool moves);
  /// How many steps are left until they are sorted and their neighbours' means and ellipsoids are found. Of
  /// many particles of one fluid those that are deep inside are not smoothed nor drawn since (but for their
  /// chords): nobody sees them.
  std::size_t steps_left() const { return steps_.size(); }
  /// Starts the next of them, if one is left; the one after it is for after gl::finish_compute().
  void start_next();
  /// As the view whose uniform block is bound sees them, once no step is left; likewise. Where the frame has
  /// walls, few lie on those that `scene_depth` shows (S_d).
  void start_placing(const Frame& frame, float splat_radius, const gl::Texture& scene_depth,
                     SplatBuffers& out) const;

  /// Of the frame, some of which may be of no fluid.
  std::size_t count() const { return count_; }
  /// vec4 each: world position m, index into Frame::fluids, or −1 where it is not drawn.
  const gl::StreamBuffer& particles() const { return particles_; }
  /// The same in another order, those of a cell beside each other, once no step is left.
  const gl::StreamBuffer& by_cell() const { return moves_ ? sorted_ : particles_; }
  /// Where they were read.
  const GivenParticles& given() const { return given_; }

 private:
  void start_taking(const Frame& frame);
  bool taken_are(const Frame& frame) const;
  enum class Step : std::uint8_t { kBegin, kFill, kSort, kSmooth };
  gl::Program take_;
  gl::Program take_into_cells_;
  gl::Program clear_;
  gl::Program begin_;
  gl::Program begin_lists_;  ///< where what is deep in the fluid is left out
  gl::Program fill_;
  gl::Program sort_;
  gl::Program find_seen_;
  gl::Program smooth_;
  gl::Program smooth_seen_;  ///< but for what is deep in the fluid
  gl::Program place_;
  gl::Program place_shaped_;
  gl::Program place_seen_;
  GivenParticles given_;
  gl::StreamBuffer particles_;
  gl::StreamBuffer counts_;  ///< an entry of the table each, and sums (shaders/particles.glsl)
  gl::StreamBuffer ranks_;
  gl::StreamBuffer begins_;
  gl::StreamBuffer listed_;
  gl::StreamBuffer owners_;      ///< an entry each: its cell, where there is but one
  gl::StreamBuffer used_;        ///< entries with particles
  gl::StreamBuffer sorted_;      ///< as particles_, by cell
  gl::StreamBuffer seen_;        ///< of the sorted, those that are not deep in the fluid
  gl::StreamBuffer centers_;     ///< of the sorted, or of those of them that are seen
  gl::StreamBuffer ellipsoids_;  ///< likewise
  std::size_t count_ = 0;
  std::size_t entries_ = 0;
  float radius_ = 0.0f;  ///< m
  bool moves_ = false;
  bool leaves_out_deep_ = false;
  std::vector<Step> steps_;  ///< left, the last of them first
};

}  // namespace slosh
