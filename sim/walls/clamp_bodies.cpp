#include "sim/walls/clamp_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/walls/joined_fields.h"

namespace slosh {

std::vector<DistanceField> clamp_fields(const Scene& scene, const SampledScene& sampled, const Plan& plan) {
  if (!plan.clamps_penetration()) return std::vector<DistanceField>(sampled.distance_fields.size());
  std::vector<DistanceField> fields = sampled.distance_fields;
  const FixedSolids fixed = fixed_solids(scene, sampled);
  std::vector<DistanceField*> of_fixed;
  for (const std::size_t b : fixed.body_of) of_fixed.push_back(&fields[b]);
  close_joints(fixed.solids, static_cast<float>(plan.spacing), of_fixed);
  return fields;
}

ClampSolid clamp_solid(const DistanceField& field, const DistanceFieldView& view) {
  if (field.distance.empty()) return {};
  // A piece of a body has the whole body's grid, and is in a part of it.
  glm::vec3 lower(std::numeric_limits<float>::max()), upper(-lower);
  for_each_node(field.view(), [&](float d, const glm::vec3& p, int) {
    if (!(d < 0.0f)) return;
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  });
  if (lower.x > upper.x) lower = upper = field.origin + 0.5f * field.cell * glm::vec3(field.size - 1);
  const glm::vec3 middle = 0.5f * (lower + upper);
  float farthest = 0.0f;
  for_each_node(field.view(), [&](float d, const glm::vec3& p, int) {
    if (d < 0.0f) farthest = std::max(farthest, glm::distance(p, middle));
  });
  // Between nodes the field is below 0 only within a cell of one that is.
  return {view, middle, farthest + std::sqrt(3.0f) * field.cell};
}

void place_clamp_bodies(std::span<const ClampSolid> solids, const Plan& plan,
                        std::span<const RigidBody> before, std::span<const RigidBody> after,
                        ClampBodies& out) {
  out.bodies.clear();
  out.spheres.clear();
  out.numbers.clear();
  // Whoever has no particle of a body within the cells around it is this far from its surface at least, less
  // what it goes itself at the speed limit.
  const double near = std::max(0.0, 0.5 * plan.support_radius - (1.0 - kClampDepth) * plan.spacing);
  for (std::size_t b = 0; b < before.size(); ++b) {
    if (b >= solids.size() || solids[b].field.distance == nullptr) continue;
    if (is_away(before[b].mesh_pose()) && is_away(after[b].mesh_pose())) continue;
    ClampBody& g = out.bodies.emplace_back();
    g.field = solids[b].field;
    g.before = surface_motion(before[b]);
    g.after = surface_motion(after[b]);
    const glm::vec3 half = 0.5f * g.field.cell * glm::vec3(g.field.size - 1);
    const float radius = glm::length(half);
    const glm::vec3 middle = g.after.place(g.field.origin + half);
    const glm::vec3 came = g.before.place(g.field.origin + half);
    const glm::dquat turned = after[b].orientation * glm::conjugate(before[b].orientation);
    const double angle = 2.0 * glm::length(glm::dvec3(turned.x, turned.y, turned.z));
    const float travel = glm::distance(middle, came) + static_cast<float>(angle) * radius;
    // Seen from the body, a particle at the edge of all this goes as far again as the turn takes it there.
    out.spheres.push_back(
        {g.after.place(solids[b].middle), solids[b].radius + (1.0f + static_cast<float>(angle)) * travel});
    out.numbers.push_back(static_cast<std::uint32_t>(b));
    // Where a large body's field is coarse, so is the wall that it knows; but behind the wall's own particles
    // a drop would stay for good.
    const float spacing = static_cast<float>(plan.spacing);
    g.depth =
        std::clamp(static_cast<float>(kClampDepth) * 2.0f * g.field.cell,
                   static_cast<float>(kClampDepth) * spacing, static_cast<float>(kMaxClampDepth) * spacing);
    g.fast = travel > static_cast<float>(near);
  }
}

}  // namespace slosh
