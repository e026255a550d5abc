// A body's mesh as cuts left it.
#pragma once

#include <span>

#include "scenes/scene.h"
#include "sim/math/body_cuts.h"

namespace slosh {

/// What of a convex mesh is within all planes, closed by a flat face on each; normals and texture places go
/// on over the edges. A cut face shows the corner of its textures. Of any other mesh something is left that
/// can be drawn, of one with more than kMaxCutTriangles all of it.
TriangleMesh cut_mesh(const TriangleMesh& mesh, std::span<const CutPlane> planes);

}  // namespace slosh
