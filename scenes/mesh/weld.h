// One vertex a place: glTF splits vertices at normal and texture seams, a volume must not have seams.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scenes/scene.h"

namespace slosh::mesh {

/// Triangles that share vertices by position alone. Double precision, the frame of the source mesh.
struct WeldedMesh {
  std::vector<glm::dvec3> points;      ///< m
  std::vector<glm::uvec3> triangles;   ///< counter-clockwise seen from outside; none degenerate
  std::vector<std::uint32_t> sources;  ///< one a triangle: which of the source mesh's it is
};

/// Welds points closer than 1e-6 of the bounding box's diagonal. Triangles that collapse are left out.
WeldedMesh weld(const TriangleMesh& mesh);

}  // namespace slosh::mesh
