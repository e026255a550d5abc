#include "sim/step_limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sim/fluid_extremes.h"
#include "sim/math/format.h"
#include "sim/passes/heat/conduction.h"
#include "sim/passes/implicit_viscosity/implicit.h"
#include "sim/viscosity/stability.h"

namespace slosh {

namespace {

// dt ≤ factor · support radius / (sound speed + speed). A tank at rest stays at rest up to 1.2 where
// an energy's gradient presses (tests/stability); Eq 5 as printed has half the pressure gradient and so more
// room, but loses it at walls.
constexpr double kCourant = 0.8;
// The same for a change while the world runs, between what a plan keeps to and what was measured to hold.
constexpr double kLiveCourant = 1.0;
// Pressure projection has no sound: dt ≤ factor · support radius / speed. Half as long again slows and
// crushes particles in a dam break.
constexpr double kSolvedCourant = 0.4;
// A lattice of bonds is stable below 0.8 of the time that √(E/ρ) takes for a spacing.
constexpr double kBondCourant = 0.5;
constexpr double kFarShorter = 0.25;  // of the step that the flow asks for: density_time()
// Free bodies above this share of the fluid layer around them need no shorter step. At 0.05 a released ball
// rattled in water (tests/notebook/2026-11-26-light-bodies-and-stacks.md).
constexpr double kLightBody = 0.1;

// m/s in the lightest fluid.
double fastest_sound(const Scene& scene, const Plan& plan) {
  const FluidExtremes fluids = fluid_extremes(scene);
  const double stiffer = pressing_density(scene, fluids.lightest) / fluids.lightest;
  return std::sqrt(plan.stiffness * stiffer);
}

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

// A hand may be as fast as this though no script says so.
constexpr double kHandSpeed = 1.0;       // m/s
constexpr double kFastestDriven = 20.0;  // m/s: a script that jumps is a spring's pull, not a speed

// m/s: a collapse over its own depth while a hand moves it, or a fall to the floor.
double expected_speed(double gravity, double depth, double drop, double driven) {
  return std::max(std::sqrt(2.0 * gravity * depth) + std::max(driven, kHandSpeed),
                  std::sqrt(2.0 * gravity * drop + driven * driven));
}

// s, where there is no sound.
double solved_step(const Plan& plan, double speed) {
  return kSolvedCourant * plan.support_radius / speed;
}

// The box of a volume, with y along up.
struct Block {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
  double density = 0.0;  // kg/m³

  bool over(double x, double z) const { return low.x <= x && x < high.x && low.z <= z && z < high.z; }
};

std::vector<Block> blocks(const Scene& scene, const glm::dvec3& up) {
  const glm::dvec3 across = std::abs(up.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(up, across));
  const glm::dvec3 z = glm::cross(x, up);
  std::vector<Block> all;
  for (const FluidVolume& volume : scene.fluid_volumes) {
    Block block;
    block.density = scene.fluids[volume.fluid].rest_density;
    for (const glm::vec3& local : scene.meshes[volume.mesh].positions) {
      const glm::dvec3 p = transform_point(volume.pose, glm::dvec3(local));
      const glm::dvec3 turned(glm::dot(x, p), glm::dot(up, p), glm::dot(z, p));
      block.low = glm::min(block.low, turned);
      block.high = glm::max(block.high, turned);
    }
    all.push_back(block);
  }
  std::sort(all.begin(), all.end(), [](const Block& a, const Block& b) { return a.low.y < b.low.y; });
  return all;
}

// What stands over (x, z), from below: where blocks overlap the lower one counts.
void add_column(const std::vector<Block>& all, double x, double z, double heaviest, FluidHeights& heights) {
  double depth = 0.0, load = 0.0, top = -std::numeric_limits<double>::infinity();
  for (const Block& block : all) {
    if (!block.over(x, z) || block.high.y <= top) continue;
    const double own = block.high.y - std::max(block.low.y, top);
    depth += own;
    load += block.density / heaviest * own;
    top = block.high.y;
  }
  heights.depth = std::max(heights.depth, depth);
  heights.load = std::max(heights.load, load);
}

// m, from a grip to the furthest point of its body.
double reach_of(const Scene& scene, const Grip& grip) {
  const int mesh = scene.bodies[static_cast<std::size_t>(grip.body)].mesh;
  double reach = 0.0;
  if (mesh < 0) return reach;
  for (const glm::vec3& p : scene.meshes[static_cast<std::size_t>(mesh)].positions)
    reach = std::max(reach, glm::distance(glm::dvec3(p), grip.pose.position));
  return reach;
}

// m/s: √(E/ρ) of the stiffest that a fluid sets to.
double fastest_in_solid(const Scene& scene) {
  double speed = 0.0;
  for (const Fluid& fluid : scene.fluids)
    speed = std::max(speed, std::sqrt(fluid.heat.modulus / fluid.rest_density));
  return speed;
}

void limit_by_diffusion(const Scene& scene, const Plan& plan, const FluidExtremes& fluids, StepLimit& limit) {
  if (plan.has(PassId::kImplicitViscosity)) {
    if (corrects_gradients(plan.model))
      limit.lower_to(artificial_viscosity_step(scene, plan, fluids),
                     "explicit artificial viscosity on velocity fluctuations");
    limit.lower_to(kMaxImplicit * viscous_step(scene, plan, fluids),
                   format("implicit viscosity of %.3g Pa·s: %g explicit steps in one", fluids.most_viscous,
                          kMaxImplicit));
  } else if (plan.viscous() || corrects_gradients(plan.model)) {
    const double of_bodies = most_viscous_body(scene, fluids.most_viscous);
    limit.lower_to(viscous_step(scene, plan, fluids),
                   format("explicit viscosity of %.3g Pa·s in the fluid, %.3g Pa·s at walls",
                          fluids.most_viscous, 0.5 * (fluids.most_viscous + of_bodies)));
  }
  if (plan.has(PassId::kBonds)) {
    const double speed = fastest_in_solid(scene);
    limit.lower_to(kBondCourant * plan.spacing / speed,
                   format("bonds: %.1f · spacing / %.1f m/s", kBondCourant, speed));
  }
  if (plan.has(PassId::kHeat)) limit.lower_to(conduction_step(scene, plan), "explicit conduction of heat");
}

// m/s between any two keys. `turned`: m that a rotation vector, world axes, moves what is farthest out.
template <class Turned>
double fastest_of(const std::vector<PoseKey>& keys, const Turned& turned) {
  double speed = 0.0;
  for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
    const PoseKey &from = keys[k], &to = keys[k + 1];
    const double way = glm::distance(from.pose.position, to.pose.position) +
                       turned(rotation_between(from.pose.orientation, to.pose.orientation), from.pose);
    if (to.time > from.time) speed = std::max(speed, way / (to.time - from.time));
  }
  return speed;
}

// A long screw that turns about its own axis is slow: the distance from the axis counts, of the mesh's box,
// whose corners are few.
double driven_body_speed(const TriangleMesh& mesh, const std::vector<PoseKey>& keys) {
  double reach = 0.0;
  glm::dvec3 low(0.0), high(0.0);
  for (const glm::dvec3 p : mesh.positions) {
    reach = std::max(reach, glm::length(p));
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  return fastest_of(keys, [&](const glm::dvec3& rotation, const Pose& pose) {
    const glm::dvec3 turn = glm::conjugate(pose.orientation) * rotation;
    double way = 0.0;
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 corner(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
      way = std::max(way, glm::length(glm::cross(turn, corner)));
    }
    return std::min(way, reach * glm::length(rotation));
  });
}

}  // namespace

double driven_speed(const Scene& scene) {
  double speed = 0.0;
  for (const FluidVolume& volume : scene.fluid_volumes) speed = std::max(speed, glm::length(volume.velocity));
  for (const Body& body : scene.bodies) {
    if (body.motion == BodyMotion::kFree) speed = std::max(speed, glm::length(body.twist.linear));
  }
  for (const Grip& grip : scene.grips) {
    const double reach = reach_of(scene, grip);
    speed = std::max(speed, fastest_of(grip.hand_motion, [reach](const glm::dvec3& rotation, const Pose&) {
                       return reach * glm::length(rotation);
                     }));
  }
  for (const Body& body : scene.bodies) {
    if (body.motion != BodyMotion::kDriven || body.mesh < 0) continue;
    speed = std::max(speed, driven_body_speed(scene.meshes[static_cast<std::size_t>(body.mesh)], body.keys));
  }
  return std::min(speed, kFastestDriven);
}

double pressing_density(const Scene& scene, double density) {
  return scene.model == ParticleModel::kPaper ? density : fluid_extremes(scene).heaviest;
}

FluidHeights fluid_heights(const Scene& scene) {
  const double g = glm::length(scene.gravity);
  const glm::dvec3 up = g > 0.0 ? -scene.gravity / g : glm::dvec3(0.0, 1.0, 0.0);
  const std::vector<Block> all = blocks(scene, up);
  const double heaviest = fluid_extremes(scene).heaviest;
  FluidHeights heights;
  double top = -std::numeric_limits<double>::infinity();
  // What all blocks over some place have in common begins at the low x of one and the low z of one of them.
  for (const Block& a : all) {
    top = std::max(top, a.high.y);
    for (const Block& b : all) add_column(all, a.low.x, b.low.z, heaviest, heights);
  }
  const glm::dvec3 lowest_corner =
      glm::mix(scene.domain_max, scene.domain_min, glm::greaterThanEqual(up, glm::dvec3(0.0)));
  if (scene.domain_min != scene.domain_max) heights.drop = std::max(0.0, top - glm::dot(up, lowest_corner));
  return heights;
}

double density_time(const Plan& plan, double gravity, double dt) {
  const double speed = expected_speed(gravity, plan.fluid_depth, plan.fluid_drop, plan.driven_speed);
  const double asked_for = solved_step(plan, speed);
  return dt < kFarShorter * asked_for ? asked_for : dt;
}

StepLimit step_limit(const Scene& scene, Plan& plan) {
  StepLimit limit;
  limit.lower_to(1.0 / 250.0, "bodies and couplings alone: 250 Hz");
  if (!plan.has_fluid()) return limit;
  const FluidExtremes fluids = fluid_extremes(scene);
  const FluidHeights heights = fluid_heights(scene);
  plan.fluid_depth = heights.depth;
  plan.fluid_drop = heights.drop;
  plan.driven_speed = driven_speed(scene);
  const double sound = fastest_sound(scene, plan);
  const double speed =
      expected_speed(glm::length(scene.gravity), heights.depth, heights.drop, plan.driven_speed);
  if (plan.has(PassId::kPressureSolve)) {
    limit.lower_to(solved_step(plan, speed),
                   format("speed: %.2f · support radius / %.1f m/s", kSolvedCourant, speed));
    limit_by_diffusion(scene, plan, fluids, limit);
    return limit;
  }
  const double courant = kCourant * plan.support_radius / (sound + speed);
  limit.lower_to(courant, format("sound: %.2f · support radius / (%.1f + %.1f m/s)", kCourant, sound, speed));
  // With one k for all (the paper's) a light particle is pushed about by its heavy neighbours.
  const double contrast =
      plan.model == ParticleModel::kPaper ? 0.5 * (1.0 + fluids.heaviest / fluids.lightest) : 1.0;
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
  limit_by_diffusion(scene, plan, fluids, limit);
  return limit;
}

std::optional<Error> refuse_endless(const Scene& scene, const Plan& plan) {
  const double step = plan.time_step / plan.sub_steps;
  if (step >= kShortestStep) return std::nullopt;
  Error error{
      "time step",
      format("%.3g µs, by %s: %.3g steps for each simulated second would not come to an end", 1e6 * step,
             plan.time_step_reason.c_str(), 1.0 / step),
      "Take coarser particles, or a softer or a thinner fluid; where walls are viscous, less of that"};
  const double g = glm::length(scene.gravity);
  const double fall = expected_speed(g, 0.0, plan.fluid_drop, plan.driven_speed);
  const double rest =
      fastest_sound(scene, plan) + expected_speed(g, plan.fluid_depth, 0.0, plan.driven_speed);
  if (fall > 10.0 * rest && step * (rest + fall) > rest * kShortestStep) {
    error.mend = format(
        "What falls to the floor of its domain, %.3g m below, goes at %.3g m/s: raise the "
        "scene's domain_min_m",
        plan.fluid_drop, fall);
    return error;
  }
  if (!plan.viscous()) return error;
  Plan shortest = plan;
  shortest.time_step = kShortestStep;  // of a sub-step
  shortest.sub_steps = 1;
  const double most = max_viscosity_allowed(scene, shortest, drag_layer(scene, plan));
  if (most > 0.0 && most < fluid_extremes(scene).most_viscous)
    error.mend = format("Up to %.3g Pa·s run at this spacing; coarser particles allow more", most);
  return error;
}

double most_gravity_allowed(const Scene& scene, const Plan& plan) {
  const double g = glm::length(scene.gravity);
  if (!plan.has_fluid() || g <= 0.0) return std::numeric_limits<double>::infinity();
  // With pressure projection, by the same margin over what the plan keeps to.
  const double speed = plan.has(PassId::kPressureSolve)
                           ? kLiveCourant / kCourant * kSolvedCourant * plan.support_radius / plan.time_step
                           : kLiveCourant * plan.sound_share * plan.support_radius / plan.time_step -
                                 fastest_sound(scene, plan);
  // The speed at which expected_speed() comes out, solved for the gravity.
  const auto reached = [&](double fall, double squared) {
    return fall > 0.0 ? std::max(squared, 0.0) / (2.0 * g * fall) : std::numeric_limits<double>::infinity();
  };
  const double collapse = std::max(speed - std::max(plan.driven_speed, kHandSpeed), 0.0);
  return std::min(reached(plan.fluid_depth, collapse * collapse),
                  reached(plan.fluid_drop, speed * std::abs(speed) - plan.driven_speed * plan.driven_speed));
}

}  // namespace slosh
