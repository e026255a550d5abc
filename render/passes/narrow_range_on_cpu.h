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
    int taps_beside = 12;           ///< where a body hides something within reach
    float pixels_per_metre = 0.0f;  ///< of a metre at one metre's depth
    float radius = 0.0f;            ///< m, of a splat: so far behind a body fluid is hidden by it
  };

  /// Smooths a picture of `size` of linear eye depths, m (kNoFluidDepth = none), before and behind bodies at
  /// depths `bodies` (as many): along rows, along columns and over 5 × 5 pixels. What bodies hide stays as it
  /// is. Returns the surface, valid until the next call.
  std::span<const float> run(std::span<const float> depths, std::span<const float> bodies, glm::ivec2 size,
                             const Kernel& kernel);

 private:
  /// Fills seen_ and hidden_before_.
  void find_hidden(std::span<const float> depths, std::span<const float> bodies, glm::ivec2 size,
                   float radius);
  /// Whether anything is hidden in the runs of pixels that lie between these, both counted in.
  bool any_hidden(glm::ivec2 low, glm::ivec2 high, glm::ivec2 size) const;

  std::vector<float> seen_;  ///< as they came, what bodies hide negative: so in all that follow
  /// Of runs of pixels: how many above and to the left have something hidden. What is near none takes the
  /// short way.
  std::vector<int> hidden_before_;
  std::vector<float> rows_;
  std::vector<float> columns_;  ///< with a border of two pixels
  std::vector<float> surface_;
};

}  // namespace slosh
