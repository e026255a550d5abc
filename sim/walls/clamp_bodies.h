// The bodies of the penetration clamp, sub-step by sub-step.
#pragma once

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

/// The bodies on their way from `before` to `after` (one a body each), with the views of `fields`. One entry
/// a body; those without a field have a reach of 0.
void place_clamp_bodies(std::span<const DistanceFieldView> fields, const Plan& plan,
                        std::span<const RigidBody> before, std::span<const RigidBody> after,
                        std::vector<ClampBody>& out);

}  // namespace slosh
