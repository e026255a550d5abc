#include "sim/walls/joined_fields.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

constexpr float kDeepest = 2.0f;  // spacings: the clamp keeps what is less deep than one
constexpr float kBefore = 2.0f;   // cells: whatever is within one of a face is read from nodes within this

// Whether a node at p of the solid's mesh, where its field is d, m, lies between it and one of those that it
// touches.
bool in_joint(std::span<const FixedSolid> solids, const FixedSolid& solid,
              std::span<const std::size_t> touched, const glm::vec3& p, float d, float spacing) {
  if (d > 0.0f) return covered(solids, touched, to_world(solid.pose, p), spacing);
  const glm::vec3 out = sample_distance(solid.field, p).gradient;
  const float slope = glm::length(out);
  if (slope < 0.5f) return false;
  const glm::vec3 before_face = p + (kTouching * spacing - d) / slope * out;
  return covered(solids, touched, to_world(solid.pose, before_face), spacing);
}

void close_joints_of(std::span<const FixedSolid> solids, std::size_t own, const TouchingSolids& touch,
                     float spacing, DistanceField& field) {
  const float deepest = kDeepest * spacing;
  const FixedSolid& solid = solids[own];
  for_each_node(field.view(), [&](float d, const glm::vec3& p, int n) {
    if (d < -deepest || d > kBefore * field.cell) return;
    if (!in_joint(solids, solid, touch.touched[own], p, d, spacing)) return;
    const float depth = touch.surface.depth_at(to_world(solid.pose, p)).depth;
    field.distance[static_cast<std::size_t>(n)] = std::min(d, -std::min(depth, deepest));
  });
}

}  // namespace

void close_joints(std::span<const FixedSolid> solids, float spacing, std::span<DistanceField* const> fields) {
  const TouchingSolids touch = touching(solids, spacing);
  for (std::size_t b = 0; b < solids.size(); ++b)
    if (!touch.touched[b].empty()) close_joints_of(solids, b, touch, spacing, *fields[b]);
}

}  // namespace slosh
