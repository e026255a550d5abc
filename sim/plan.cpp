#include "sim/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <limits>

#include "sim/math/sph.h"

namespace slosh {

namespace {

constexpr double kPi = 3.14159265358979323846;
// Eq 7 is linear: under its own depth the fluid is denser by g·depth/k. This much is not seen and hardly
// felt.
constexpr double kCompressionAtDepth = 0.04;
// dt ≤ factor · support radius / (sound speed + speed). A tank at rest stays at rest up to 1.2 with the
// consistent model (tests/stability); Eq 5 as printed has half the pressure gradient and so more room, but
// loses it at walls.
constexpr double kCourant = 0.8;
// Free bodies above this share of the fluid layer around them need no shorter step; a bucket held by two
// hands was stable down to 0.01 (tests/stability).
constexpr double kLightBody = 0.05;
// Explicit viscosity is stable below 2/λ; λ of the roughest mode is about twice the lattice sum.
constexpr double kViscousFactor = 0.8;
// What a wall adds to that sum for the fluid's first layer, as a share of the whole lattice.
constexpr double kWallPart = 0.35;
// Body particles stand for fluid denser than rest by this much: enough pressure to hold a column back before
// the fluid itself is compressed, little enough not to push it far off the wall.
constexpr double kBodyCompression = 0.3;

[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

struct FluidHeights {
  double depth = 0.0;  // m, the deepest column that a fluid could stand in as it is placed
  double drop = 0.0;   // m, from the highest fluid to the floor of the domain
};

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

// Σ V ∇²W over the neighbours of a rest lattice, times spacing²: the damping rate of one particle among still
// neighbours is μ/ρ · this / spacing².
double lattice_viscosity_sum(double ratio) {
  const int reach = static_cast<int>(std::ceil(ratio));
  double sum = 0.0;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const double r = std::sqrt(static_cast<double>(x * x + y * y + z * z));
        if (r > 0.0 && r < ratio) sum += ratio - r;
      }
    }
  }
  return 45.0 / (kPi * std::pow(ratio, 6)) * sum;
}

struct FluidExtremes {
  double lightest = std::numeric_limits<double>::infinity(), heaviest = 0.0;
  double least_viscous = std::numeric_limits<double>::infinity(), most_viscous = 0.0;
};

FluidExtremes fluid_extremes(const Scene& scene) {
  FluidExtremes e;
  for (const FluidVolume& volume : scene.fluid_volumes) {
    const Fluid& fluid = scene.fluids[volume.fluid];
    e.lightest = std::min(e.lightest, fluid.rest_density);
    e.heaviest = std::max(e.heaviest, fluid.rest_density);
    e.least_viscous = std::min(e.least_viscous, fluid.dynamic_viscosity);
    e.most_viscous = std::max(e.most_viscous, fluid.dynamic_viscosity);
  }
  return e;
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

// The largest step that each limit allows; the plan takes the smallest and says which it was.
struct StepLimit {
  double step = std::numeric_limits<double>::infinity();
  std::string reason;

  void lower_to(double other, std::string why) {
    if (other < step) {
      step = other;
      reason = std::move(why);
    }
  }
};

StepLimit step_limit(const Scene& scene, const Plan& plan, const FluidExtremes& fluids,
                     const FluidHeights& heights) {
  StepLimit limit;
  limit.lower_to(1.0 / 250.0, "bodies and couplings alone: 250 Hz");
  if (!plan.has_fluid) return limit;
  const double sound = std::sqrt(plan.stiffness);
  const double g = glm::length(scene.gravity);
  // A collapse over its own depth while a hand moves it, or a fall to the floor.
  const double speed = std::max(std::sqrt(2.0 * g * heights.depth) + 1.0, std::sqrt(2.0 * g * heights.drop));
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
  if (plan.viscosity) {
    double most_viscous_body = 0.0;
    for (const Body& body : scene.bodies)
      most_viscous_body = std::max(most_viscous_body, body.dynamic_viscosity);
    const double viscosity =
        fluids.most_viscous + kWallPart * 0.5 * (fluids.most_viscous + most_viscous_body);
    const double central = plan.model == ParticleModel::kPaper ? 1.0 : kCentralDrag / 3.0;
    const double rate = central * viscosity / fluids.lightest * lattice_viscosity_sum(scene.support_ratio) /
                        (plan.spacing * plan.spacing);
    limit.lower_to(kViscousFactor / rate,
                   format("explicit viscosity of %.3g Pa·s in the fluid, %.3g Pa·s at walls",
                          fluids.most_viscous, 0.5 * (fluids.most_viscous + most_viscous_body)));
  }
  return limit;
}

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

}  // namespace

Plan make_plan(const Scene& scene, double spacing) {
  Plan plan;
  plan.spacing = spacing;
  plan.support_radius = scene.support_ratio * spacing;
  plan.model = scene.model;
  plan.tension = scene.tension;
  plan.has_fluid = !scene.fluid_volumes.empty() || std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                                               [](const Body& b) { return b.point_probe; });
  FluidExtremes fluids = fluid_extremes(scene);
  if (scene.fluid_volumes.empty()) fluids = {1000.0, 1000.0, 0.0, 0.0};
  const FluidHeights heights = fluid_heights(scene);
  plan.stiffness = scene.stiffness > 0.0
                       ? scene.stiffness
                       : std::max(glm::length(scene.gravity) * heights.depth / kCompressionAtDepth, 1.0);
  bool viscous_body = false;
  bool probe_differs = false;
  for (const Body& body : scene.bodies) {
    viscous_body |= body.dynamic_viscosity > 0.0;
    probe_differs |=
        body.point_probe && body.dynamic_viscosity > 0.0 && body.dynamic_viscosity != fluids.most_viscous;
  }
  plan.viscosity = plan.has_fluid && (fluids.most_viscous > 0.0 || viscous_body);
  plan.one_viscosity = plan.viscosity && fluids.least_viscous == fluids.most_viscous && !probe_differs;
  decide_bodies(scene, fluids, plan);
  const StepLimit limit = step_limit(scene, plan, fluids, heights);
  plan.time_step = limit.step;
  plan.time_step_reason = limit.reason;
  plan.max_speed = 0.5 * plan.support_radius / plan.time_step;
  list_passes(scene, fluids, plan);
  return plan;
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
