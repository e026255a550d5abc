#include "sim/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/format.h"
#include "sim/step_limits.h"

namespace slosh {

namespace {

// Eq 7 is linear: under its own depth the fluid is denser by g·depth/k. This much is not seen and hardly
// felt.
constexpr double kCompressionAtDepth = 0.04;
// Body particles stand for fluid denser than rest by this much: enough pressure to hold a column back before
// the fluid itself is compressed, little enough not to push it far off the wall.
constexpr double kBodyCompression = 0.3;

bool any_free(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const Body& b) { return b.motion == BodyMotion::kFree; });
}

void decide_bodies(const Scene& scene, const FluidExtremes& fluids, Plan& plan) {
  int solid = 0;
  int free_solid = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const bool is_free = body.motion == BodyMotion::kFree;
    solid += !body.point_probe;
    free_solid += is_free && !body.point_probe;
    const double reference = plan.has_fluid ? fluids.heaviest : 1000.0;
    const double density =
        body.particle_density > 0.0 ? body.particle_density : reference * (1.0 + kBodyCompression);
    plan.body_density.push_back(density);
    plan.body_pressure.push_back(plan.stiffness * (density - reference));
    if (plan.has_fluid && (is_free || body.measured)) plan.wrench_bodies.push_back(static_cast<int>(i));
  }
  plan.boundary = plan.has_fluid && solid > 0;
  plan.rigid_dynamics = any_free(scene);
  plan.contacts = free_solid > 0 && solid > 1;
  plan.couplings = !scene.grips.empty();
  plan.body_wrench = !plan.wrench_bodies.empty();
}

void add_pass(Plan& plan, bool wanted, const char* name, const std::string& reason,
              const std::string& reason_not) {
  if (wanted) {
    plan.passes.push_back({name, reason});
  } else {
    plan.left_out.push_back({name, reason_not});
  }
}

void list_passes(const Scene& scene, const FluidExtremes& fluids, Plan& plan) {
  const std::size_t free_count = static_cast<std::size_t>(std::count_if(
      scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return b.motion == BodyMotion::kFree; }));
  const bool free_solid = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) {
    return b.motion == BodyMotion::kFree && !b.point_probe;
  });
  const bool pairs = plan.viscosity && !plan.one_viscosity;
  plan.passes.clear();
  plan.left_out.clear();
  add_pass(plan, plan.has_fluid, "sort fluid",
           "cells of the support radius, so that neighbour rows are contiguous", "no fluid");
  add_pass(plan, plan.boundary && free_solid, "place body particles",
           "free bodies carry their particles (Eq 14)", "no free body with a surface meets fluid");
  const bool paper = plan.model == ParticleModel::kPaper;
  add_pass(plan, plan.has_fluid, "density",
           paper ? "Eq 2 and 7, fluid particles only (section 4.1)" : "Eq 2 and 7, body particles counted",
           "no fluid");
  add_pass(plan, plan.has_fluid, "pressure force", paper ? "Eq 5" : "Eq 5 as the gradient of an energy",
           "no fluid");
  add_pass(plan, plan.viscosity && plan.one_viscosity, "viscous force, one viscosity",
           format("Eq 6: every fluid has %.3g Pa·s", fluids.most_viscous),
           pairs ? "fluids differ: Eq 9 takes its place" : "nothing is viscous");
  add_pass(plan, pairs, "viscous force, a viscosity a particle",
           format("Eq 9 between fluids of %.3g to %.3g Pa·s", fluids.least_viscous, fluids.most_viscous),
           plan.viscosity ? "one viscosity: Eq 6 is enough" : "nothing is viscous");
  add_pass(plan, plan.boundary, "body particles on fluid",
           format("Eq 5%s against the particles of %zu bodies", plan.viscosity ? " and 9" : "",
                  scene.bodies.size()),
           plan.has_fluid ? "no body with a surface" : "no fluid");
  add_pass(plan, plan.body_wrench, "wrench on bodies",
           format("Eq 10–12 for %zu bodies that are free or measured", plan.wrench_bodies.size()),
           plan.has_fluid ? "every body is fixed and none is measured" : "no fluid");
  add_pass(plan, plan.has_fluid, "integrate fluid", "leap-frog", "no fluid");
  add_pass(plan, plan.couplings, "virtual couplings",
           format("%zu grips, implicit, all of a body in one 6×6 solve (section 4.4)", scene.grips.size()),
           "no grip");
  add_pass(plan, plan.contacts, "contacts", "a free body can touch another body",
           free_solid ? "one body alone" : "no free body with a surface");
  add_pass(plan, plan.rigid_dynamics, "move bodies",
           format("Eq 13 and leap-frog for %zu free bodies", free_count), "every body is fixed");
}

void decide_viscosity(const Scene& scene, Plan& plan) {
  const FluidExtremes fluids = fluid_extremes(scene);
  bool viscous_body = false;
  bool probe_differs = false;
  for (const Body& body : scene.bodies) {
    viscous_body |= body.dynamic_viscosity > 0.0;
    probe_differs |=
        body.point_probe && body.dynamic_viscosity > 0.0 && body.dynamic_viscosity != fluids.most_viscous;
  }
  plan.viscosity = plan.has_fluid && (fluids.most_viscous > 0.0 || viscous_body);
  plan.one_viscosity = plan.viscosity && fluids.least_viscous == fluids.most_viscous && !probe_differs;
}

}  // namespace

Plan make_plan(const Scene& scene, double spacing) {
  Plan plan;
  plan.spacing = spacing;
  plan.support_radius = scene.support_ratio * spacing;
  plan.model = scene.model;
  plan.tension = scene.tension;
  plan.has_fluid = !scene.fluid_volumes.empty() || std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                                               [](const Body& b) { return b.point_probe; });
  plan.stiffness =
      scene.stiffness > 0.0
          ? scene.stiffness
          : std::max(glm::length(scene.gravity) * fluid_heights(scene).depth / kCompressionAtDepth, 1.0);
  decide_viscosity(scene, plan);
  decide_bodies(scene, fluid_extremes(scene), plan);
  const StepLimit limit = step_limit(scene, plan);
  plan.time_step = limit.step;
  plan.time_step_reason = limit.reason;
  plan.max_speed = 0.5 * plan.support_radius / plan.time_step;
  list_passes(scene, fluid_extremes(scene), plan);
  return plan;
}

void plan_viscosity(const Scene& scene, Plan& plan) {
  decide_viscosity(scene, plan);
  list_passes(scene, fluid_extremes(scene), plan);
}

std::string describe(const Plan& plan) {
  std::string text;
  text += format("model           %s\n", plan.model == ParticleModel::kPaper ? "paper" : "consistent");
  text += format("spacing         %.4g mm\n", plan.spacing * 1e3);
  text += format("support radius  %.4g mm\n", plan.support_radius * 1e3);
  text +=
      format("stiffness       %.4g m²/s² (sound at %.3g m/s)\n", plan.stiffness, std::sqrt(plan.stiffness));
  text +=
      format("time step       %.4g ms, limited by %s\n", plan.time_step * 1e3, plan.time_step_reason.c_str());
  text += format("speed limit     %.3g m/s\n", plan.max_speed);
  text += "\nEach step\n";
  for (const Pass& pass : plan.passes) text += format("  %-38s %s\n", pass.name.c_str(), pass.reason.c_str());
  if (!plan.left_out.empty()) text += "Left out\n";
  for (const Pass& pass : plan.left_out)
    text += format("  %-38s %s\n", pass.name.c_str(), pass.reason.c_str());
  return text;
}

}  // namespace slosh
