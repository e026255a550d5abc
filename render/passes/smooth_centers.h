// Particles' centres drawn towards those of their neighbours, and ellipsoids for spheres, flat where the
// fluid is (Yu & Turk 2013): the noise of where particles happen to lie goes, the fluid's shape stays. On the
// CPU; no GL here.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/frame.h"
#include "render/passes/splats.h"

namespace slosh {

class SmoothCenters {
 public:
  /// Sorts the frame's particles into cells; those that are not finite or of no fluid of the frame are left
  /// out.
  void sort(const Frame& frame);
  /// Moves eye-space `splats.spheres` (w is kept), whose frame was sorted, each to a mean over its neighbours
  /// within kReach particle radii, and gives each its shape. A particle alone stays where and what it is.
  /// What was found of a particle serves all views until the next sort().
  void move(const Frame& frame, Splats& splats);

 private:
  /// Of a particle, in the world.
  struct Smoothed {
    glm::vec3 center{0.0f};
    glm::mat3 ellipsoid{0.0f};
  };
  struct Sorted {
    glm::vec3 at{0.0f};
    glm::ivec3 cell{0};
  };
  std::size_t bucket_of(const glm::ivec3& cell) const;
  Smoothed smooth(const glm::vec3& at, float radius) const;

  float reach_ = 1.0f;
  std::vector<std::uint32_t> begin_;  // a bucket each, and the end
  std::vector<Sorted> sorted_;
  std::vector<Smoothed> smoothed_;  // a particle each, where known_
  std::vector<std::uint8_t> known_;
  std::vector<std::uint32_t> bucket_;  // scratch
};

}  // namespace slosh
