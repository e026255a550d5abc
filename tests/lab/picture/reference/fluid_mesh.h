// A fluid's surface as triangles, for pictures that take their time. Plain maths.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/frame.h"

namespace slosh::reference {

struct FluidMesh {
  std::uint32_t fluid = 0;            ///< index into Frame::fluids
  std::vector<glm::vec3> positions;   ///< m, world
  std::vector<glm::vec3> normals;     ///< unit, outward
  std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from outside
};

/// Where the distance to the weighted mean of the particles around is a particle's radius (Zhu & Bridson
/// 2005, Eq 4), within four radii; by surface nets (Gibson 1998) on cells of `cell` particle radii, > 0,
/// coarser where the fluid would take more than 50 million of them. One mesh a fluid that has particles;
/// those that are not finite or are farther from the eye than the far plane are left out. The flat surface of
/// a volume filled evenly lies where the volume ends; a particle alone is a ball of its own volume.
std::vector<FluidMesh> mesh_fluids(const Frame& frame, float cell = 0.6f);

}  // namespace slosh::reference
