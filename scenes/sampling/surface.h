// Even particles on a surface.
#pragma once

#include <functional>

#include "scenes/mesh/tree.h"
#include "scenes/scene.h"

namespace slosh::sampling {

/// Blue noise on a closed mesh, about one sample a spacing²: dense candidates, the most crowded of which are
/// taken away (Yuksel 2015, "Sample Elimination for Generating Poisson Disk Sample Sets"), then relaxed along
/// the surface. Surfaces that face away from each other, as the two of a thin wall, do not feel each other.
/// Where `parts` (closed parts of the mesh) overlap, the buried surface gets no samples. The same input gives
/// the same samples. `tree` is of the same mesh. Samples are at most about 5 million. `tell`, where there is
/// one, is told the share that is done, between the stages.
SurfaceSamples sample_surface(const TriangleMesh& mesh, const mesh::MeshTree& tree, int parts, double spacing,
                              const std::function<void(double)>& tell = {});

}  // namespace slosh::sampling
