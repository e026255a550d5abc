// The parts of inspect_scene.
#pragma once

#include "scenes/gltf/document.h"
#include "scenes/inspect.h"

namespace slosh::inspection {

/// What the exporter left out or put elsewhere, from the file's JSON as it is: properties that nothing reads,
/// no camera.
void look_at_export(const nlohmann::json& file, const gltf::Document& document,
                    std::vector<Finding>& warnings);

/// Hands without a motion, or with too few keys.
void look_at_motion(const gltf::Document& document, std::vector<Finding>& warnings);

/// What loads and cannot have been meant: on its side, gravity that is not down, far too large or too small,
/// coarse meshes that are shaded as if they were round.
void look_at_scene(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings);

/// What is where nothing can act on it: hands out of reach or faster than the host accepts, fluid over
/// nothing, places that floats are too coarse for, sizes and weights that look like another unit's.
void look_at_reach(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings);

/// Blender's world, z up, of a place in ours.
glm::dvec3 in_blender(const glm::dvec3& place);

}  // namespace slosh::inspection
