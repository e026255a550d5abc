// How thick a body's walls are.
#pragma once

#include "scenes/mesh/tree.h"
#include "scenes/scene.h"

namespace slosh::sampling {

/// The thinnest wall of a closed mesh, m: from points spread over the surface, straight inward, the way to a
/// surface that faces the other way. The twentieth part with the shortest ways does not count, nor do ways
/// that end on a slanting surface: next to an edge every solid is thin. Infinity when no way counts.
double wall_thickness(const TriangleMesh& mesh, const mesh::MeshTree& tree);

}  // namespace slosh::sampling
