// Particles' centres drawn towards those of their neighbours (Yu & Turk 2013, Eq 6): the noise of where
// particles happen to lie goes, the fluid's shape stays. On the CPU; no GL here.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/frame.h"

namespace slosh {

class SmoothCenters {
 public:
  /// Sorts the frame's particles into cells; those that are not finite or of no fluid of the frame are left
  /// out.
  void sort(const Frame& frame);
  /// Moves eye-space `spheres` (w is kept), whose frame was sorted, each to a mean over its neighbours within
  /// kReach particle radii. A particle alone stays where it is.
  void move(const Frame& frame, std::span<glm::vec4> spheres) const;

 private:
  std::size_t bucket_of(const glm::ivec3& cell) const;

  float reach_ = 1.0f;
  std::vector<std::uint32_t> begin_;  // a bucket each, and the end
  std::vector<glm::vec3> sorted_;
  std::vector<std::uint32_t> bucket_;  // scratch
};

}  // namespace slosh
