// Filling volumes with fluid.
#pragma once

#include <optional>

#include "scenes/sample.h"
#include "scenes/scene.h"
#include "sim/math/result.h"

namespace slosh::sampling {

/// Adds the particles of every fluid volume to `sampled`: a cubic lattice along the axes of the volume's
/// mesh, centred sideways and half a spacing above the mesh's lowest point, of which those points stay that
/// are inside the mesh and half a spacing clear of every body. What the walls kept out goes on top, against
/// gravity along the mesh's nearest axis, or around a shape that tapers, so that the mass is that of the
/// mesh's volume less what of it is inside bodies and earlier volumes. Where volumes overlap, the first one
/// wins. Needs sampled.distance_fields and sampled.spacing. Errors: a volume more than 5 % of which is inside
/// one body, a volume that holds no particle, more than 30 million lattice points.
std::optional<Error> fill_fluids(const Scene& scene, SampledScene& sampled, SampleReport* report);

}  // namespace slosh::sampling
