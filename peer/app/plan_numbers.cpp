#include "peer/app/plan_numbers.h"

#include <algorithm>
#include <cmath>

#include "peer/app/time_estimate.h"
#include "peer/output/summary.h"
#include "peer/view/foam.h"
#include "scenes/sample.h"
#include "sim/columns.h"
#include "sim/fluid_extremes.h"
#include "sim/math/format.h"
#include "sim/step_limits.h"
#include "sim/viscosity/stability.h"
#include "sim/world.h"

namespace slosh {
namespace {

/// Bytes of a body's particle on the CPU: where it sits, and its place, velocity, pressure, volume,
/// viscosity, body and key in the order of cells.
constexpr double kSurfaceBytes = 100.0;

std::string stiffness_line(const Scene& scene, const Plan& plan, double head) {
  const double compression = head / plan.stiffness;
  if (scene.stiffness > 0.0)
    return format("stiffness from  the scene; the head compresses the fluid by %.3g %%\n",
                  100.0 * compression);
  return format("stiffness from  a head of %.3g m²/s², which compresses the fluid by %.3g %%\n", head,
                100.0 * compression);
}

// What the step is, of what each explicit part would bear.
std::string share_lines(const Scene& scene, const Plan& plan) {
  const double step = plan.time_step / plan.sub_steps;
  std::string text;
  if (!plan.has(PassId::kPressureSolve))
    text += format("sound number    %.2g (c · step / support radius)\n",
                   std::sqrt(plan.stiffness) * step / plan.support_radius);
  if (plan.viscous() || corrects_gradients(plan.model)) {
    const FluidExtremes fluids = fluid_extremes(scene);
    text += format(
        "viscous number  %.2g (ν · step / spacing²), %.0f %% of the step that explicit viscosity allows\n",
        fluids.most_viscous / fluids.lightest * step / (plan.spacing * plan.spacing),
        100.0 * step / viscous_step(scene, plan, fluids));
  }
  return text;
}

}  // namespace

std::string start_in_words(const Scene& scene) {
  if (scene.settle > 0.0)
    return format(
        "settles %.3g s before the run: a head or a layering that its fluid starts with is lost (settle_s 0 "
        "keeps it)",
        scene.settle);
  return "starts as the scene has it: nothing settles before the run";
}

std::string plan_numbers(const Scene& scene, const Plan& plan, double fluid, double surface) {
  std::string text = "start           " + start_in_words(scene) + "\n";
  if (plan.has_fluid()) {
    const FluidHeights heights = fluid_heights(scene);
    const double g = glm::length(scene.gravity);
    const double head = g * heights.load + 0.5 * plan.driven_speed * plan.driven_speed;
    text += format("depth           %.3g m of fluid, the weight of %.3g m of the heaviest; %.3g m to fall\n",
                   heights.depth, heights.load, heights.drop);
    if (!plan.has(PassId::kPressureSolve)) text += stiffness_line(scene, plan, head);
    text += share_lines(scene, plan);
  }
  text += format("particles       about %s of fluid and %s of bodies\n",
                 grouped(static_cast<std::uint64_t>(fluid)).c_str(),
                 grouped(static_cast<std::uint64_t>(surface)).c_str());
  const double bytes = column_bytes(plan) * fluid + kSurfaceBytes * surface;
  text += format("memory          about %.3g MB for them\n", 1e-6 * bytes);
  return text;
}

Result<std::string> step_cost_in_words(const Scene& scene, const Plan& plan, double particles,
                                       Backend backend, int gpu) {
  const auto line = [&](double seconds, const std::string& how) {
    return format("a step          about %.3g ms on %s, real time × %.2g\n", 1e3 * seconds, how.c_str(),
                  plan.time_step / seconds);
  };
  if (particles <= (backend == Backend::kCuda ? kMaxToStepOnGpu : kMaxToStep)) {
    const Result<SampledScene> sampled = sample_scene(scene, plan.spacing);
    if (!sampled) return sampled.error();
    Result<World> world = make_world(scene, sampled.value(), plan, {.backend = backend, .gpu = gpu});
    if (!world) return world.error();
    return line(measure_step(world.value(), {}), world.value().backend() + ", as the scene starts");
  }
  if (backend == Backend::kCuda)
    return line(particles * kStatedStepCostOnGpu, "an H200, not measured on this machine");
  return line(particles * kStatedStepCost, "one core of an ordinary machine, not measured");
}

std::string picture_in_words(const Scene& scene) {
  struct Line {
    const char* what;
    bool there;
    std::string reason;
  };
  const bool glass = std::ranges::any_of(
      scene.bodies, [](const Body& body) { return body.mesh >= 0 && body.material.opacity < 1.0f; });
  const FoamPlan foam = plan_foam(scene);
  const bool fluid = !scene.fluids.empty();
  const Line lines[] = {
      {"the fluid's surface and its shadow", fluid, fluid ? "there is fluid" : "there is no fluid"},
      {"glass", glass, glass ? "a body lets light through" : "no body lets light through"},
      {"foam, spray and bubbles", foam.any(), foam.reason}};
  std::string text = "\nEach picture\n";
  for (const Line& line : lines)
    if (line.there) text += format("  %-38s %s\n", line.what, line.reason.c_str());
  if (std::ranges::all_of(lines, &Line::there)) return text;
  text += "Left out\n";
  for (const Line& line : lines)
    if (!line.there) text += format("  %-38s %s\n", line.what, line.reason.c_str());
  return text;
}

}  // namespace slosh
