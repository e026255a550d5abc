// The plane in which a free-slip wall mirrors fluid, at each of its surface's samples.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "sim/math/symmetric.h"

namespace slosh {

/// In one frame with the samples. The surface's normal at the foot of a point x beside it is about
/// normal + bend · (x − sample).
struct MirrorPlane {
  glm::vec3 normal{0.0f};   ///< unit, out of the solid; 0: nothing is mirrored
  Symmetric<float> bend{};  ///< 1/m, across the normal: the normal's gradient along the surface
};

/// One a sample: the plane that its neighbours' normals fit best, those within `reach` m and kOneFace of its
/// own. So faces of a mesh that stand for a round wall do not show, and edges stay edges.
std::vector<MirrorPlane> mirror_planes(std::span<const glm::vec3> positions,
                                       std::span<const glm::vec3> normals, float reach);

/// Cosine of the angle (37°) up to which two normals are of one face.
inline constexpr float kOneFace = 0.8f;

}  // namespace slosh
