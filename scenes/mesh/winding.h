// How often a closed mesh goes round each node of a regular grid.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scenes/scene.h"

namespace slosh::mesh {

/// Node (i, j, k) at origin + cell·(i, j, k), index i + size.x·(j + size.y·k).
struct Grid {
  glm::dvec3 origin{0.0};
  double cell = 0.0;  ///< m
  glm::ivec3 size{0};

  std::size_t count() const { return static_cast<std::size_t>(size.x) * size.y * size.z; }
};

/// Where a line of a grid along x passes a mesh's surface.
struct Crossing {
  std::int32_t row;  ///< j + size.y·k
  float x;           ///< cells from the origin
  std::int8_t sign;  ///< +1 entering along +x
};

/// Of all lines, sorted by row, then x. Lines are moved a little off the nodes.
std::vector<Crossing> line_crossings(const TriangleMesh& mesh, const Grid& grid);

/// The winding number at every node: 0 outside, 1 inside, 2 where two parts overlap, so "> 0" is inside the
/// union. Walks lines along x and sums signed crossings. The mesh must have no defects; then every line's
/// crossings cancel, since both triangles of an edge judge a line by the same arithmetic.
std::vector<std::int8_t> winding_numbers(const TriangleMesh& mesh, const Grid& grid);

}  // namespace slosh::mesh
