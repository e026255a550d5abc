// Particles' centres drawn towards those of their neighbours, and ellipsoids for spheres, flat where the
// fluid is (Yu & Turk 2013): the noise of where particles happen to lie goes, the fluid's shape stays. On the
// CPU; no GL here.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/frame.h"
#include "render/passes/particle_cells.h"
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

  /// How far off a particle's neighbours are, m.
  static float reach(float particle_radius) { return kReach * particle_radius; }

 private:
  /// Of a particle, in the world.
  struct Smoothed {
    glm::vec3 center{0.0f};
    glm::mat3 ellipsoid{0.0f};
  };
  Smoothed smooth(const glm::vec3& at, const Frame& frame) const;

  static constexpr float kReach =
      4.0f;  ///< particle radii, 2.5 spacings: some 60 neighbours inside the fluid

  ParticleCells cells_;
  std::vector<Smoothed> smoothed_;  // a particle each, where known_
  std::vector<std::uint8_t> known_;
};

}  // namespace slosh
