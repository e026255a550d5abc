#include "sim/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/fluid_extremes.h"
#include "sim/math/format.h"
#include "sim/pressure/pressure_solve.h"
#include "sim/step_limits.h"
#include "sim/viscosity/artificial_viscosity.h"
#include "sim/viscosity/stability.h"

namespace slosh {

namespace {

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

bool any_free(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const Body& b) { return b.motion == BodyMotion::kFree; });
}

void decide_bodies(const Scene& scene, const FluidExtremes& fluids, Plan& plan) {
  int solid = 0;
  int free_solid = 0;
  int free_probes = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const bool is_free = body.motion == BodyMotion::kFree;
    solid += !body.point_probe;
    free_solid += is_free && !body.point_probe;
    free_probes += is_free && body.point_probe;
    const double reference = plan.has_fluid() ? fluids.heaviest : 1000.0;
    const double density =
        body.particle_density > 0.0 ? body.particle_density : reference * (1.0 + kBodyCompression);
    plan.body_density.push_back(density);
    plan.body_pressure.push_back(plan.stiffness * (density - reference));
    if (plan.has_fluid() && (is_free || body.measured)) plan.wrench_bodies.push_back(static_cast<int>(i));
  }
  plan.runs.set(PassId::kWalls, plan.has_fluid() && solid > 0);
  plan.runs.set(PassId::kPlaceBodies, plan.has(PassId::kWalls) && free_solid > 0);
  plan.runs.set(PassId::kWrenches, !plan.wrench_bodies.empty());
  plan.runs.set(PassId::kCouplings, !scene.grips.empty());
  plan.runs.set(PassId::kContacts, (free_solid > 0 && solid > 1) || (free_probes > 0 && solid > 0));
  plan.runs.set(PassId::kMoveBodies, any_free(scene));
}

bool any_probe(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return b.point_probe; });
}

// A probe's force is known when the fluid has moved only, and the body's solve would wait for it in vain.
void decide_body_drag(const Scene& scene, Plan& plan) {
  plan.waits_for_bodies = plan.has(PassId::kPlaceBodies) && !any_probe(scene);
  plan.runs.set(PassId::kBodyDrag, plan.viscous() && plan.waits_for_bodies);
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

// A probe's velocity is its body's, which is known only later. The other models stay as they are, to compare
// with.
bool suits_implicit_viscosity(const Scene& scene, const Plan& plan) {
  return plan.viscous() && corrects_gradients(plan.model) && !any_probe(scene);
}

void decide_implicit_viscosity(Plan& plan) {
  plan.runs.set(PassId::kImplicitViscosity, plan.implicit_viscosity && plan.viscous());
  if (plan.has(PassId::kImplicitViscosity)) plan.runs.set(PassId::kBodyDrag, false);
}

// In thin fluid artificial viscosity far exceeds the fluid's own. The threshold is the corrected model's in
// the incompressible one too, so that both treat a fluid alike.
bool suits_stress(const FluidExtremes& fluids, const Plan& plan) {
  return plan.viscous() && corrects_gradients(plan.model) && !plan.implicit_viscosity &&
         fluids.most_viscous > kThin * weakly_compressible_artificial_viscosity(plan, fluids.lightest);
}

void decide_stress(Plan& plan) {
  plan.runs.set(PassId::kFluidStress, plan.passes_stress && plan.explicit_viscosity());
}

struct Reasons {
  std::string there, not_there;
};

// Why each pass is there, or why it is not.
Reasons reasons_for(PassId id, const Scene& scene, const FluidExtremes& fluids, const Plan& plan) {
  const auto count_free = [&](bool solid_only) {
    return static_cast<std::size_t>(std::count_if(
        scene.bodies.begin(), scene.bodies.end(),
        [&](const Body& b) { return b.motion == BodyMotion::kFree && !(solid_only && b.point_probe); }));
  };
  const bool paper = plan.model == ParticleModel::kPaper;
  switch (id) {
    case PassId::kSortFluid:
      return {"cells of the support radius, so that neighbour rows are contiguous", "no fluid"};
    case PassId::kPlaceBodies:
      return {"free bodies carry their particles (Eq 14)", "no free body with a surface meets fluid"};
    case PassId::kDensity:
      return {paper ? "Eq 2 and 7, fluid particles only (section 4.1)" : "Eq 2 and 7, body particles counted",
              "no fluid"};
    case PassId::kFluidStress:
      return {
          format(
              "viscous stress τ = μ(G + Gᵀ) for fluid of up to %.3g Pa·s; Eq 9 within about two spacings of "
              "no-slip walls",
              fluids.most_viscous),
          !plan.viscous()                        ? "nothing is viscous"
          : !corrects_gradients(plan.model)      ? "the corrected and the incompressible model's"
          : plan.has(PassId::kImplicitViscosity) ? "implicit viscosity uses Eq 9"
                                                 : "thin fluid: artificial viscosity exceeds its own"};
    case PassId::kPressureForce:
      return {paper                              ? "Eq 5"
              : plan.has(PassId::kPressureSolve) ? "Eq 5 by corrected gradients and the last step's pressures"
                                                 : "Eq 5 as the gradient of an energy",
              "no fluid"};
    case PassId::kOneViscosity:
      return {
          format("Eq 6: every fluid has %.3g Pa·s", fluids.most_viscous),
          plan.has(PassId::kPairViscosity) ? "fluids differ: Eq 9 takes its place" : "nothing is viscous"};
    case PassId::kPairViscosity:
      return {format("Eq 9 between fluids of %.3g to %.3g Pa·s", fluids.least_viscous, fluids.most_viscous),
              plan.viscous() ? "one viscosity: Eq 6 is enough" : "nothing is viscous"};
    case PassId::kWalls:
      return {format("Eq 5%s against the particles of %zu bodies", plan.viscous() ? " and 9" : "",
                     scene.bodies.size()),
              plan.has_fluid() ? "no body with a surface" : "no fluid"};
    case PassId::kWrenches:
      return {format("Eq 10–12 for %zu bodies that are free or measured", plan.wrench_bodies.size()),
              plan.has_fluid() ? "every body is fixed and none is measured" : "no fluid"};
    case PassId::kBodyDrag:
      return {
          "free bodies in viscous fluid: drag implicit in the body's velocity, as part of the bodies' solve",
          !plan.viscous()                        ? "nothing is viscous"
          : plan.has(PassId::kImplicitViscosity) ? "bodies are part of the implicit viscosity solve"
          : !plan.has(PassId::kPlaceBodies)      ? "no free body with a surface meets fluid"
                                                 : "a probe needs explicit viscosity"};
    case PassId::kImplicitViscosity:
      return {
          format(
              "viscous force by the velocities at the step's end (conjugate gradients): explicit viscosity "
              "would need steps of %.3g ms",
              1e3 * viscous_step(scene, plan, fluids)),
          !plan.viscous()                   ? "nothing is viscous"
          : !corrects_gradients(plan.model) ? "the corrected and the incompressible model's"
          : any_probe(scene)                ? "a probe needs explicit viscosity"
                                            : "explicit viscosity costs less here"};
    case PassId::kPressureSolve:
      return {format("in place of Eq 7: pressure projection, %d iterations at most", kMaxPressureIterations),
              plan.has_fluid() ? "Eq 7 gives the pressures: the incompressible model solves for them"
                               : "no fluid"};
    case PassId::kIntegrateFluid:
      return {"leap-frog", "no fluid"};
    case PassId::kCouplings:
      return {format("%zu grips, implicit, all of a body in one 6×6 solve (section 4.4)", scene.grips.size()),
              "no grip"};
    case PassId::kContacts:
      return {"a free body can touch another body",
              count_free(false) > 0 ? "no other body with a surface" : "no free body"};
    case PassId::kMoveBodies:
      return {format("Eq 13 and leap-frog for %zu free bodies", count_free(false)), "every body is fixed"};
  }
  return {};
}

void list_passes(const Scene& scene, Plan& plan) {
  const FluidExtremes fluids = fluid_extremes(scene);
  plan.passes.clear();
  plan.left_out.clear();
  for (std::size_t i = 0; i < kPassCount; ++i) {
    const PassId id = static_cast<PassId>(i);
    Reasons reasons = reasons_for(id, scene, fluids, plan);
    if (plan.has(id)) {
      plan.passes.push_back({id, std::move(reasons.there)});
    } else {
      plan.left_out.push_back({id, std::move(reasons.not_there)});
    }
  }
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
  const bool viscous = plan.has_fluid() && (fluids.most_viscous > 0.0 || viscous_body);
  const bool one = fluids.least_viscous == fluids.most_viscous && !probe_differs;
  plan.runs.set(PassId::kOneViscosity, viscous && one);
  plan.runs.set(PassId::kPairViscosity, viscous && !one);
}

}  // namespace

Plan make_plan(const Scene& scene, double spacing, bool may_be_implicit) {
  Plan plan;
  plan.spacing = spacing;
  plan.support_radius = scene.support_ratio * spacing;
  plan.model = scene.model;
  plan.tension = scene.tension;
  const bool fluid = !scene.fluid_volumes.empty() || any_probe(scene);
  for (const PassId id :
       {PassId::kSortFluid, PassId::kDensity, PassId::kPressureForce, PassId::kIntegrateFluid})
    plan.runs.set(id, fluid);
  plan.runs.set(PassId::kPressureSolve, fluid && plan.model == ParticleModel::kIncompressible);
  plan.stiffness = scene.stiffness > 0.0 ? scene.stiffness : stiffness_for(scene);
  decide_viscosity(scene, plan);
  decide_bodies(scene, fluid_extremes(scene), plan);
  decide_body_drag(scene, plan);
  StepLimit limit = step_limit(scene, plan);
  if (may_be_implicit && suits_implicit_viscosity(scene, plan)) {
    Plan implicit = plan;
    implicit.implicit_viscosity = true;
    decide_implicit_viscosity(implicit);
    const StepLimit longer = step_limit(scene, implicit);
    if (longer.step > worth_solving(plan) * limit.step) {
      plan = implicit;
      limit = longer;
    }
  }
  plan.passes_stress = suits_stress(fluid_extremes(scene), plan);
  decide_stress(plan);
  plan.time_step = limit.step;
  plan.time_step_reason = limit.reason;
  plan.max_speed = speed_limit(plan, plan.time_step);
  list_passes(scene, plan);
  return plan;
}

void plan_viscosity(const Scene& scene, Plan& plan) {
  decide_viscosity(scene, plan);
  decide_body_drag(scene, plan);
  decide_implicit_viscosity(plan);
  decide_stress(plan);
  list_passes(scene, plan);
}

}  // namespace slosh
