#include "sim/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/fluid_extremes.h"
#include "sim/math/format.h"
#include "sim/passes/heat/conduction.h"
#include "sim/passes/pass.h"
#include "sim/step_limits.h"
#include "sim/viscosity/artificial_viscosity.h"
#include "sim/viscosity/stability.h"

namespace slosh {

namespace {

// Those that a fluid's viscosity decides, which may change while a world runs.
constexpr PassSet kOfViscosity{PassId::kFluidStress,   PassId::kOneViscosity,      PassId::kPairViscosity,
                               PassId::kPredictBodies, PassId::kImplicitViscosity, PassId::kBodyDrag};

// Eq 7 is linear: under its own depth the fluid is denser by g·depth/k, and where it is met at a speed by
// half the square of that over k (Bernoulli). This much is not seen and hardly felt.
constexpr double kCompression = 0.04;

double stiffness_for(const Scene& scene) {
  const double speed = driven_speed(scene);
  const double head = glm::length(scene.gravity) * fluid_heights(scene).load + 0.5 * speed * speed;  // J/kg
  return std::max(head / kCompression, 1.0);
}

// Body particles stand for fluid denser than rest by this much: enough pressure to hold a column back before
// the fluid itself is compressed, little enough not to push it far off the wall.
constexpr double kBodyCompression = 0.3;

bool any_probe(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return b.point_probe; });
}

bool has_particles(const Scene& scene) {
  return !scene.fluid_volumes.empty() || any_probe(scene);
}

void weigh_bodies(const Scene& scene, Plan& plan) {
  const bool fluid = has_particles(scene);
  const double reference = fluid ? fluid_extremes(scene).heaviest : 1000.0;
  bool any_moving_solid = false;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const bool is_free = body.motion == BodyMotion::kFree;
    any_moving_solid |= body.motion != BodyMotion::kFixed && !body.point_probe;
    const double density =
        body.particle_density > 0.0 ? body.particle_density : reference * (1.0 + kBodyCompression);
    plan.body_density.push_back(density);
    plan.body_pressure.push_back(plan.stiffness * (density - reference));
    if (fluid && (is_free || body.measured)) plan.wrench_bodies.push_back(static_cast<int>(i));
  }
  // A probe's force is known when the fluid has moved only, and the body's solve would wait for it in vain.
  plan.waits_for_bodies = fluid && any_moving_solid && !any_probe(scene);
}

SceneFacts facts_of(const Scene& scene, const Plan& plan) {
  SceneFacts f{.scene = scene, .plan = plan, .fluids = fluid_extremes(scene), .fluid = has_particles(scene)};
  bool viscous_body = false, probe_differs = false;
  for (const Body& body : scene.bodies) {
    const bool is_free = body.motion == BodyMotion::kFree;
    f.solids += !body.point_probe;
    f.free_solids += is_free && !body.point_probe;
    f.probes += body.point_probe;
    f.free_bodies += is_free;
    f.driven += body.motion == BodyMotion::kDriven;
    viscous_body |= body.dynamic_viscosity > 0.0;
    probe_differs |=
        body.point_probe && body.dynamic_viscosity > 0.0 && body.dynamic_viscosity != f.fluids.most_viscous;
  }
  f.viscous = f.fluid && (f.fluids.most_viscous > 0.0 || viscous_body);
  f.heat = f.fluid && passes_heat(scene);
  f.one = f.fluids.least_viscous == f.fluids.most_viscous && !probe_differs;
  f.implicit = plan.implicit_viscosity && f.viscous;
  return f;
}

// Which of the passes in `which` run, by what their folders say.
void decide(const Scene& scene, Plan& plan, PassSet which) {
  const SceneFacts facts = facts_of(scene, plan);
  for (std::size_t i = 0; i < kPassCount; ++i) {
    const PassId id = static_cast<PassId>(i);
    if (which.has(id)) plan.runs.set(id, entry(id).need(facts).runs);
  }
}

// From this many times the explicit step on a solve is worth it: a step with one takes 1.05 to 1.8 times as
// long there, up to four times in honey (tests/notebook/2026-11-27-implicit-viscosity.md). At a wider support
// the implicit solve's Eq 9 gives 6 % too little shear stress in a lattice; the explicit particle stress does
// not.
constexpr double kWorthSolving = 2.0, kWorthSolvingWide = 4.0;
constexpr double kWide = 2.2;  // radius over spacing
double worth_solving(const Plan& plan) {
  return plan.support_radius > kWide * plan.spacing ? kWorthSolvingWide : kWorthSolving;
}

// A probe's velocity is its body's, which is known only later. The published model stays as it is, to compare
// with.
bool suits_implicit_viscosity(const Scene& scene, const Plan& plan) {
  return plan.viscous() && corrects_gradients(plan.model) && !any_probe(scene);
}

// In thin fluid artificial viscosity far exceeds the fluid's own. The threshold is the corrected model's in
// the incompressible one too, so that both treat a fluid alike.
bool suits_stress(const FluidExtremes& fluids, const Plan& plan) {
  return plan.viscous() && corrects_gradients(plan.model) && !plan.implicit_viscosity &&
         fluids.most_viscous > kThin * weakly_compressible_artificial_viscosity(plan, fluids.lightest);
}

void list_passes(const Scene& scene, Plan& plan) {
  const SceneFacts facts = facts_of(scene, plan);
  plan.passes.clear();
  plan.left_out.clear();
  for (std::size_t i = 0; i < kPassCount; ++i) {
    const PassId id = static_cast<PassId>(i);
    (plan.has(id) ? plan.passes : plan.left_out).push_back({id, entry(id).need(facts).reason});
  }
}

}  // namespace

Plan make_plan(const Scene& scene, double spacing, bool may_be_implicit) {
  Plan plan;
  plan.spacing = spacing;
  plan.support_radius = scene.support_ratio * spacing;
  plan.model = scene.model;
  plan.tension = scene.tension;
  plan.stiffness = scene.stiffness > 0.0 ? scene.stiffness : stiffness_for(scene);
  weigh_bodies(scene, plan);
  decide(scene, plan, PassSet::all());
  StepLimit limit = step_limit(scene, plan);
  if (may_be_implicit && suits_implicit_viscosity(scene, plan)) {
    Plan implicit = plan;
    implicit.implicit_viscosity = true;
    decide(scene, implicit, kOfViscosity);
    const StepLimit longer = step_limit(scene, implicit);
    if (longer.step > worth_solving(plan) * limit.step) {
      plan = implicit;
      limit = longer;
    }
  }
  plan.passes_stress = suits_stress(fluid_extremes(scene), plan);
  decide(scene, plan, {PassId::kFluidStress});
  plan.time_step = limit.step;
  plan.time_step_reason = limit.reason;
  plan.max_speed = speed_limit(plan, plan.time_step);
  if (plan.has(PassId::kHeat)) plan.heat_steps = heat_steps(scene, plan);
  list_passes(scene, plan);
  return plan;
}

void plan_viscosity(const Scene& scene, Plan& plan) {
  decide(scene, plan, kOfViscosity);
  list_passes(scene, plan);
}

}  // namespace slosh
