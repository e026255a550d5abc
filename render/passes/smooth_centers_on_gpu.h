// SmoothCenters::move by a compute shader, over the cells that the CPU sorted.
#pragma once

#include <cstddef>
#include <vector>

#include "render/gl/objects.h"
#include "render/passes/smooth_centers.h"

namespace slosh {

class SmoothCentersOnGpu {
 public:
  /// Errors carry the driver's log.
  static Result<SmoothCentersOnGpu> create();

  /// After sort(): uploads its cells, once a frame.
  void upload(const SmoothCenters& centers);
  /// Moves `count` splats of `spheres` (eye position, fluid) and writes their shapes, as move() does. The
  /// frame's uniform block is the view's.
  void move(const SmoothCenters& centers, float particle_radius, const gl::StreamBuffer& spheres,
            gl::StreamBuffer& shapes, std::size_t count) const;

 private:
  gl::Program program_;
  gl::StreamBuffer places_;
  gl::StreamBuffer begins_;
  std::vector<float> columns_;
};

}  // namespace slosh
