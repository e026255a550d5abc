// The signed distance field of a body.
#pragma once

#include "scenes/mesh/tree.h"
#include "scenes/scene.h"

namespace slosh::sampling {

/// Most nodes along one axis.
inline constexpr int kMaxNodes = 96;

/// Exact distances at the nodes of a grid that reaches three spacings beyond the mesh, its cell half a
/// spacing, or more where that would take over kMaxNodes along an axis. Negative inside the union of the
/// mesh's parts.
DistanceField make_distance_field(const TriangleMesh& mesh, const mesh::MeshTree& tree, double spacing);

}  // namespace slosh::sampling
