// More samples of fluid than there are particles, drawn and never simulated: where few particles make a
// stream, a string or a thin layer, gaps between them are bridged. On the CPU; no GL here.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/frame.h"
#include "render/passes/particle_cells.h"

namespace slosh {

class Bridges {
 public:
  /// Adds samples (FluidSample::between) to the frame's particles, which are this object's memory then: one
  /// in the middle between two particles of a fluid that are kMinGap to kMaxGap particle radii apart with
  /// nobody nearer to that middle (an edge of the Gabriel graph; Gabriel & Sokal 1969), where one of the two
  /// has 2 to kSurrounded neighbours within kMaxGap. So two drops by themselves part, and the surface of much
  /// fluid stays as it is. Nothing is added to more than kMaxParticles.
  void add(Frame& frame);

  static constexpr float kMinGap = 2.1f;  ///< particle radii; a spacing is 1.61
  static constexpr float kMaxGap = 3.5f;
  /// Of some 40 inside a fluid, 20 at a flat surface, 10 at an edge.
  static constexpr std::uint32_t kSurrounded = 12;
  /// Of more a gap is small in a picture, and looking for it takes longer than drawing.
  static constexpr std::size_t kMaxParticles = 40000;

 private:
  /// Fills near_; stops beyond kSurrounded.
  std::uint32_t find_near(std::uint32_t a, float reach);

  ParticleCells cells_;
  std::vector<glm::vec3> particles_;
  std::vector<std::uint8_t> fluids_;
  std::vector<std::uint32_t> neighbours_;  // of sorted particles
  std::vector<std::uint32_t> near_;        // scratch
};

}  // namespace slosh
