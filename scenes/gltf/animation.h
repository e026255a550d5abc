// glTF animation of a node as a list of poses.
#pragma once

#include "scenes/gltf/document.h"
#include "scenes/scene.h"

namespace slosh::gltf {

/// Keys lie no further apart than this. s
inline constexpr double kLongestKeyStep = 1.0 / 60.0;
/// And no later than this. s
inline constexpr double kLongestAnimation = 3600.0;

/// True when some channel moves `node`.
bool is_animated(const Document& document, int node);

/// The world poses of `node`, from time 0 on, with rising times at most kLongestKeyStep apart. LINEAR, STEP
/// and CUBICSPLINE channels of translation and rotation of all animations in the file are taken together; a
/// STEP becomes a ramp over one key step. A node without channels gets one key. Errors: times that do not
/// rise, counts that do not match, two channels for one path, an animated parent, scale or weights.
Result<std::vector<PoseKey>> read_motion(const Document& document, int node);

}  // namespace slosh::gltf
