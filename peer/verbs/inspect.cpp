// The verbs that look at a scene without playing it: scenes, check, plan.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "net/text/clean.h"
#include "peer/output/summary.h"
#include "peer/verbs/common_options.h"
#include "peer/verbs/plan_numbers.h"
#include "peer/verbs/prepare.h"
#include "peer/verbs/verbs.h"
#include "scenes/load.h"
#include "scenes/sample.h"
#include "sim/plan.h"

namespace slosh {
namespace {

int list_scenes() {
  const std::vector<SceneEntry> entries = shipped_scenes();
  if (entries.empty()) {
    return fail({"scenes", "none were found", "Set SLOSH_SCENES to the folder that holds them"});
  }
  for (const SceneEntry& entry : entries) {
    const std::string name = clean_text(entry.name, kMostTextBytes);
    std::printf("%-10s %s\n", name.c_str(), entry.title.c_str());
  }
  return kExitOk;
}

double litres(const Scene& scene) {
  return 1e3 * estimate_particles(scene, 1.0).fluid;
}

double fluid_mass(const Scene& scene, const SampledScene& sampled) {
  double mass = 0.0;
  const double volume = sampled.spacing * sampled.spacing * sampled.spacing;
  for (const std::uint8_t fluid : sampled.fluid_index) mass += volume * scene.fluids[fluid].rest_density;
  return mass;
}

int check(const std::string& name, double asked) {
  Result<Scene> loaded = load_named_scene(name);
  if (!loaded) return fail(loaded.error());
  const Scene& scene = loaded.value();
  const double spacing = asked > 0.0 ? asked : scene.spacing > 0.0 ? scene.spacing : scene.spacing_max;
  SampleReport filling;
  Progress progress;
  Result<SampledScene> sampled = sample_told(scene, spacing, progress, &filling);
  if (!sampled) return fail(sampled.error());

  std::size_t surface = 0;
  for (const SurfaceSamples& samples : sampled.value().surfaces) surface += samples.positions.size();
  std::size_t free_bodies = 0;
  double mass = 0.0;
  for (const Body& body : scene.bodies) {
    if (body.motion != BodyMotion::kFree) continue;
    free_bodies += 1;
    mass += body.mass.mass;
  }
  std::printf("ok: %s\n", scene.title.empty() ? scene.name.c_str() : scene.title.c_str());
  std::printf("  bodies      %zu (%zu free, %.3f kg)\n", scene.bodies.size(), free_bodies, mass);
  std::printf("  grips       %zu\n", scene.grips.size());
  for (const Grip& grip : scene.grips) {
    std::printf("    %-10s on %s, %zu keys of hand motion\n", grip.name.c_str(),
                scene.bodies[static_cast<std::size_t>(grip.body)].name.c_str(), grip.hand_motion.size());
  }
  std::printf("  fluids      %zu, %.2f litres, %.2f kg as sampled\n", scene.fluids.size(), litres(scene),
              fluid_mass(scene, sampled.value()));
  for (std::size_t v = 0; v < filling.volumes.size(); ++v) {
    const FilledVolume& f = filling.volumes[v];
    if (std::abs(f.sampled - f.mesh) <= 0.005 * f.mesh) continue;
    std::printf(
        "    %-10s %.3f of %.3f litres: %.3f lie inside bodies, %.3f in volumes before it, %.3f find no "
        "place\n",
        clean_text(scene.fluid_volumes[v].name, kMostTextBytes).c_str(), 1e3 * f.sampled, 1e3 * f.mesh,
        1e3 * f.in_bodies, 1e3 * f.in_others, 1e3 * f.no_place);
  }
  std::printf("  start       %s\n", start_in_words(scene).c_str());
  const auto measured =
      std::count_if(scene.bodies.begin(), scene.bodies.end(), [](const Body& body) { return body.measured; });
  if (measured > 0 || !scene.gauges.empty() || !scene.regions.empty()) {
    std::printf("  measured    %td bodies, %zu gauges, %zu regions\n", measured, scene.gauges.size(),
                scene.regions.size());
  }
  std::size_t thinnest_body = 0;
  const double wall = thinnest_wall(scene, &thinnest_body);
  if (thinnest_body < scene.bodies.size() && wall < 1e6) {
    std::printf("  thinnest    wall %.1f mm, of %s\n", 1e3 * wall, scene.bodies[thinnest_body].name.c_str());
  }
  std::printf("  particles   %s fluid and %s body particles at %.1f mm (range %.1f to %.1f mm)\n",
              grouped(sampled.value().fluid_positions.size()).c_str(), grouped(surface).c_str(),
              1e3 * spacing, 1e3 * scene.spacing_min, 1e3 * scene.spacing_max);
  return kExitOk;
}

int print_plan(const std::string& name, double spacing) {
  Result<Scene> loaded = load_named_scene(name);
  if (!loaded) return fail(loaded.error());
  const Scene& scene = loaded.value();
  if (spacing <= 0.0) spacing = scene.spacing > 0.0 ? scene.spacing : scene.spacing_max;
  const Plan plan = make_plan(scene, spacing);
  const ParticleEstimate count = estimate_particles(scene, spacing);
  std::printf("%s\nThe numbers behind it\n%s", describe(plan).c_str(),
              plan_numbers(scene, plan, count.fluid, count.surface).c_str());
  std::fflush(stdout);
  std::printf("%s", step_cost_in_words(scene, plan, count.fluid + count.surface).c_str());
  return kExitOk;
}

}  // namespace

void add_scenes(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb = app.add_subcommand("scenes", "List the shipped scenes");
  verb->footer("Example:\n  slosh scenes");
  verb->callback([&chosen] { chosen = list_scenes; });
}

void add_check(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb = app.add_subcommand("check", "Validate a scene and count what is in it");
  auto name = std::make_shared<std::string>();
  auto spacing = std::make_shared<double>(0.0);
  verb->add_option("FILE", *name, "A .gltf or .glb file, or a shipped scene's name")->required();
  verb->add_option("--spacing", *spacing, "Metres between particles (the scene's own, else its coarsest)")
      ->check(in_range(1e-4, 1.0));
  verb->footer(
      "Loads the scene, checks every value and mesh, and samples it.\n"
      "Exit code 1 and the reason when something is wrong.\n\n"
      "Examples:\n  slosh check bucket\n  slosh check my_scene.glb --spacing 0.005");
  verb->callback([&chosen, name, spacing] { chosen = [name, spacing] { return check(*name, *spacing); }; });
}

void add_plan(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb = app.add_subcommand("plan", "Show the passes that a scene needs, each with its reason");
  auto name = std::make_shared<std::string>();
  auto spacing = std::make_shared<double>(0.0);
  verb->add_option("SCENE", *name, "A shipped scene's name, or a .gltf or .glb file")->required();
  verb->add_option("--spacing", *spacing, "Metres between particles (the scene's own, else its coarsest)")
      ->check(in_range(1e-4, 1.0));
  verb->footer("Examples:\n  slosh plan bucket\n  slosh plan pour --spacing 0.008");
  verb->callback(
      [&chosen, name, spacing] { chosen = [name, spacing] { return print_plan(*name, *spacing); }; });
}

int fail(const Error& error) {
  constexpr std::size_t kMost = 4000;
  std::string text = clean_lines(error.text(), kMost);
  if (!text.empty() && text.back() != '.') text += '.';
  std::fprintf(stderr, "slosh: %s\n", text.c_str());
  return kExitFailed;
}

}  // namespace slosh
