#include "sim/fluid_models.h"

#include <algorithm>

namespace slosh {

FluidModels::FluidModels(const Scene& scene) {
  const double gravity = glm::length(scene.gravity);
  for (const Body& body : scene.bodies) {
    Watched& watched = bodies_.emplace_back();
    watched.free = body.motion == BodyMotion::kFree;
    if (!watched.free) continue;
    watched.point = body.point_probe;
    watched.bounds.up = gravity > 0.0 ? -scene.gravity / gravity : glm::dvec3(0.0);
  }
  for (const Fluid& fluid : scene.fluids) density_ = std::max(density_, fluid.rest_density);
}

void FluidModels::restart() {
  for (Watched& body : bodies_) body.watched = false;
}

void FluidModels::after_step(const World& world, const BodySnapshot& now, std::span<const char> wanted,
                             std::vector<FluidWrenchModel>& out) {
  out.clear();
  if (!world.plan().has_fluid()) return;
  const std::span<const Wrench> wrenches = world.fluid_wrenches();
  const std::span<const Matrix6> drags = world.drags();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Watched& body = bodies_[b];
    if (!body.free || b >= wanted.size() || !wanted[b]) {
      body.watched = false;
      continue;
    }
    const MassProperties mass = world.mass(b);
    // A viscosity that is set while it runs switches viscous forces on or off; a cut makes another body of
    // it.
    if (!body.watched || body.with_drag != !drags.empty() || body.bounds.body_mass != mass.mass) {
      const double spacing = world.plan().spacing;
      body.watched = true;
      body.with_drag = !drags.empty();
      const glm::dmat3& inertia = mass.inertia;
      body.bounds.body_mass = mass.mass;
      if (!body.point)
        body.bounds.gyration_squared =
            (inertia[0][0] + inertia[1][1] + inertia[2][2]) / (2.0 * std::max(mass.mass, 1e-9));
      body.bounds.fluid_mass =
          density_ * static_cast<double>(world.fluid_count()) * spacing * spacing * spacing;
      body.bounds.reach = world.plan().support_radius;
      body.identifier.restart(body.bounds);
    }
    const BodyState& state = now.bodies[b];
    body.identifier.add({now.time,
                         {state.center_of_mass, state.pose.orientation},
                         state.twist,
                         wrenches[b],
                         body.with_drag ? &drags[b] : nullptr,
                         world.plan().sub_steps});
    FluidWrenchModel& model = out.emplace_back();
    model.body = static_cast<std::uint32_t>(b);
    model.tick = now.tick;
    body.identifier.fill(model);
  }
}

}  // namespace slosh
