// The bodies of the penetration clamp, sub-step by sub-step.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.h"
#include "sim/bodies/rigid_body.h"
#include "sim/plan.h"
#include "sim/walls/penetration_clamp.h"

namespace slosh {

/// How far into a wall a particle may get, in spacings: the wall's own particles sit twice as deep, and fluid
/// at rest stays half a spacing outside.
inline constexpr double kClampDepth = 0.35;
/// At most, where a field is coarser than a spacing: before the wall's own particles (0.7), which still push
/// it out.
inline constexpr double kMaxClampDepth = 0.6;

/// The fields of the bodies of the penetration clamp, one a body; empty for those that have none, and for all
/// where the plan has no clamp. Fixed bodies that touch have them as one solid (close_joints).
std::vector<DistanceField> clamp_fields(const Scene& scene, const SampledScene& sampled, const Plan& plan);

/// A body's solid as long as a world runs.
struct ClampSolid {
  DistanceFieldView field;  ///< in the memory of whoever reads it; empty: nobody is clamped
  glm::vec3 middle{0.0f};   ///< m, mesh frame, of a ball that holds all of the solid
  float radius = 0.0f;      ///< m
};
/// `field` is here, `view` the same where it will be read.
ClampSolid clamp_solid(const DistanceField& field, const DistanceFieldView& view);

/// The bodies of a sub-step that particles may meet: those that have a solid and are not away. Every particle
/// near a wall looks at each.
struct ClampBodies {
  std::vector<ClampBody> bodies;
  std::vector<BoundingSphere> spheres;  ///< one a body of these
  std::vector<std::uint32_t> numbers;   ///< likewise, rising: index into Scene::bodies
};
/// On their way from `before` to `after` (one a body of the scene each).
void place_clamp_bodies(std::span<const ClampSolid> solids, const Plan& plan,
                        std::span<const RigidBody> before, std::span<const RigidBody> after,
                        ClampBodies& out);

}  // namespace slosh
