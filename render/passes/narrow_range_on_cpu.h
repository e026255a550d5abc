// narrow_range.frag on the CPU, for renderers that are one: a texture look-up is what their shaders are
// slowest at, and this filter is little else. Plain maths, no GL.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace slosh {

class NarrowRangeOnCpu {
 public:
  struct Kernel {
    float reach = 0.0f;             ///< m, to a side
    float range = 0.0f;             ///< m of depth
    int taps = 6;                   ///< to a side, more where the reach is many pixels (filter_stride)
    float pixels_per_metre = 0.0f;  ///< of a metre at one metre's depth
  };

  /// Smooths a picture of `size` of linear eye depths, m (kNoFluidDepth = none): along rows, along columns
  /// and over 5 × 5 pixels. Returns the surface, valid until the next call.
  std::span<const float> run(std::span<const float> depths, glm::ivec2 size, const Kernel& kernel);

 private:
  std::vector<float> rows_;
  std::vector<float> columns_;  ///< with a border of two pixels
  std::vector<float> surface_;
};

}  // namespace slosh
