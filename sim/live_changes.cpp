#include "sim/live_changes.h"

#include <algorithm>

#include "sim/math/format.h"
#include "sim/step_limits.h"
#include "sim/viscosity/stability.h"
#include "sim/world.h"

namespace slosh {

namespace {

Error too_much(const std::string& where, double value, double most, const char* unit) {
  return {where, format("%.4g %s is too much for the time step of this run", value, unit),
          format("Up to %.4g %s will do", most, unit)};
}

}  // namespace

Result<bool> allow_grip_stiffness(const Scene& scene, std::size_t grip, double scale) {
  // What a scene may have (scenes/FIELDS.md).
  constexpr double kMaxSpring = 1e6;   // N/m
  constexpr double kMaxTurning = 1e4;  // N·m/rad
  if (grip >= scene.grips.size())
    return Error{"grip stiffness", "there is no grip " + std::to_string(grip) + " in this world", ""};
  const Grip& of = scene.grips[grip];
  const std::string where = "stiffness of " + of.name;
  if (!(scale >= kMinGripStiffness && scale <= kMaxGripStiffness))
    return Error{where, format("it can be %g to %g times the scene's", kMinGripStiffness, kMaxGripStiffness),
                 ""};
  // The scene's own is let be, whatever it has.
  if (scale > 1.0 && (scale * of.stiffness > kMaxSpring || scale * of.rotational_stiffness > kMaxTurning))
    return Error{where,
                 format("%.4g N/m and %.4g N·m/rad are too much", scale * of.stiffness,
                        scale * of.rotational_stiffness),
                 "At most a million N/m and ten thousand N·m/rad"};
  return true;
}

LiveChanges::LiveChanges(const Scene& scene, const Plan& plan) : layer_(drag_layer(scene, plan)) {
  for (const Fluid& fluid : scene.fluids) first_viscosities_.push_back(fluid.dynamic_viscosity);
}

Result<bool> LiveChanges::allow_viscosity(const Scene& scene, const Plan& plan, std::size_t fluid,
                                          double value) const {
  const bool there = std::any_of(scene.fluid_volumes.begin(), scene.fluid_volumes.end(), [&](const auto& v) {
    return v.fluid >= 0 && static_cast<std::size_t>(v.fluid) == fluid;
  });
  if (!there || fluid >= scene.fluids.size())
    return Error{"viscosity", "there is no fluid " + std::to_string(fluid) + " in this world", ""};
  const std::string where = "viscosity of " + scene.fluids[fluid].name;
  if (!(value >= 0.0)) return Error{where, "it cannot be below 0", ""};
  // The scene's own value is what the step was chosen for, whatever rounding says.
  const double most = std::max(max_viscosity_allowed(scene, plan, layer_), first_viscosities_[fluid]);
  if (value <= most) return true;
  return too_much(where, value, most, "Pa·s");
}

Result<bool> LiveChanges::allow_gravity(const Scene& scene, const Plan& plan, double scale) const {
  if (!(scale >= 0.0 && scale <= kMaxGravityScale))
    return Error{"gravity", "it can be 0 to 2 times the scene's", ""};
  const double most = std::max(most_gravity_allowed(scene, plan), 1.0);
  if (scale <= most) return true;
  return too_much("gravity", scale, most, "times the scene's");
}

}  // namespace slosh
