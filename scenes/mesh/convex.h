// Is a closed mesh convex?
#pragma once

#include "scenes/mesh/weld.h"

namespace slosh::mesh {

/// Whether no point is before any triangle's plane, by more than rounding of the file's numbers (1e-5 of the
/// mesh's size). Triangles times points are looked at.
bool is_convex(const WeldedMesh& mesh);

}  // namespace slosh::mesh
