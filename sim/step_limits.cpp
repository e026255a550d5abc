#include "sim/step_limits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/fluid_extremes.h"
#include "sim/format.h"
#include "sim/viscosity/stability.h"

namespace slosh {

namespace {

// dt ≤ factor · support radius / (sound speed + speed). A tank at rest stays at rest up to 1.2 with the
// consistent model (tests/stability); Eq 5 as printed has half the pressure gradient and so more room, but
// loses it at walls.
constexpr double kCourant = 0.8;
// The same for a change while the world runs, between what a plan keeps to and what was measured to hold.
constexpr double kLiveCourant = 1.0;
// Free bodies above this share of the fluid layer around them need no shorter step; a bucket held by two
// hands was stable down to 0.01 (tests/stability).
constexpr double kLightBody = 0.05;

// m² of a mesh.
double surface_area(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return area;
}

// How much lighter a free body is than the layer of fluid that its particles stand for; 1 or less.
double lightest_body_share(const Scene& scene, double spacing, double density) {
  double share = 1.0;
  for (const Body& body : scene.bodies) {
    if (body.motion != BodyMotion::kFree || body.point_probe || body.mesh < 0) continue;
    const double layer = surface_area(scene.meshes[body.mesh]) * spacing * density;
    if (layer > 0.0) share = std::min(share, body.mass.mass / layer);
  }
  return share;
}

// m/s: a collapse over its own depth while a hand moves it, or a fall to the floor.
double expected_speed(double gravity, double depth, double drop) {
  return std::max(std::sqrt(2.0 * gravity * depth) + 1.0, std::sqrt(2.0 * gravity * drop));
}

}  // namespace

FluidHeights fluid_heights(const Scene& scene) {
  const double g = glm::length(scene.gravity);
  const glm::dvec3 up = g > 0.0 ? -scene.gravity / g : glm::dvec3(0.0, 1.0, 0.0);
  FluidHeights heights;
  double top = -std::numeric_limits<double>::infinity();
  for (const FluidVolume& volume : scene.fluid_volumes) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const glm::vec3& p : scene.meshes[volume.mesh].positions) {
      const double height = glm::dot(up, transform_point(volume.pose, glm::dvec3(p)));
      low = std::min(low, height);
      high = std::max(high, height);
    }
    heights.depth = std::max(heights.depth, high - low);
    top = std::max(top, high);
  }
  const glm::dvec3 lowest_corner =
      glm::mix(scene.domain_max, scene.domain_min, glm::greaterThanEqual(up, glm::dvec3(0.0)));
  if (scene.domain_min != scene.domain_max) heights.drop = std::max(0.0, top - glm::dot(up, lowest_corner));
  return heights;
}

StepLimit step_limit(const Scene& scene, Plan& plan) {
  StepLimit limit;
  limit.lower_to(1.0 / 250.0, "bodies and couplings alone: 250 Hz");
  if (!plan.has_fluid()) return limit;
  const FluidExtremes fluids = fluid_extremes(scene);
  const FluidHeights heights = fluid_heights(scene);
  plan.fluid_depth = heights.depth;
  plan.fluid_drop = heights.drop;
  const double sound = std::sqrt(plan.stiffness);
  const double speed = expected_speed(glm::length(scene.gravity), heights.depth, heights.drop);
  const double courant = kCourant * plan.support_radius / (sound + speed);
  limit.lower_to(courant, format("sound: %.2f · support radius / (%.1f + %.1f m/s)", kCourant, sound, speed));
  const double contrast = 0.5 * (1.0 + fluids.heaviest / fluids.lightest);
  if (contrast > 1.0) {
    limit.lower_to(courant / std::sqrt(contrast), format("sound, at a density ratio of %.3g between fluids",
                                                         fluids.heaviest / fluids.lightest));
  }
  // A light body is thrown about by single fluid particles, so its step must be shorter by the root of its
  // share.
  const double share = lightest_body_share(scene, plan.spacing, fluids.heaviest);
  if (share < kLightBody) {
    limit.lower_to(courant * std::sqrt(share / kLightBody / contrast),
                   format("sound, at a body of %.3g times the mass of the fluid layer around it", share));
  }
  plan.sound_share = std::sqrt(std::min(1.0, share / kLightBody) / contrast);
  if (plan.viscous() || plan.model == ParticleModel::kCorrected) {
    const double of_bodies = most_viscous_body(scene);
    limit.lower_to(viscous_step(scene, plan, fluids),
                   format("explicit viscosity of %.3g Pa·s in the fluid, %.3g Pa·s at walls",
                          fluids.most_viscous, 0.5 * (fluids.most_viscous + of_bodies)));
  }
  return limit;
}

std::optional<Error> refuse_endless(const Scene& scene, const Plan& plan) {
  const double step = plan.time_step / plan.sub_steps;
  if (step >= kShortestStep) return std::nullopt;
  Error error{"time step",
              format("%.3g µs, by %s: %.3g steps for each simulated second would not come to an end",
                     1e6 * step, plan.time_step_reason.c_str(), 1.0 / step),
              "Take coarser particles, or a softer or a thinner fluid"};
  if (!plan.viscous()) return error;
  Plan shortest = plan;
  shortest.time_step = kShortestStep;
  const double most = most_viscous_allowed(scene, shortest);
  if (most < fluid_extremes(scene).most_viscous)
    error.mend = format("Up to %.3g Pa·s run at this spacing; coarser particles allow more", most);
  return error;
}

double most_gravity_allowed(const Scene& scene, const Plan& plan) {
  const double g = glm::length(scene.gravity);
  if (!plan.has_fluid() || g <= 0.0) return std::numeric_limits<double>::infinity();
  const double speed =
      kLiveCourant * plan.sound_share * plan.support_radius / plan.time_step - std::sqrt(plan.stiffness);
  // The speed at which expected_speed() comes out, solved for the gravity.
  const auto reached = [&](double fall, double start) {
    return fall > 0.0 ? std::pow(std::max(speed - start, 0.0), 2) / (2.0 * g * fall)
                      : std::numeric_limits<double>::infinity();
  };
  return std::min(reached(plan.fluid_depth, 1.0), reached(plan.fluid_drop, 0.0));
}

}  // namespace slosh
