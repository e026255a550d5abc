// The verbs `scenes` and `plan`, and how every verb fails.
#include <cstdio>
#include <memory>
#include <string_view>

#include "net/text/clean.h"
#include "peer/app/common_options.h"
#include "peer/app/plan_numbers.h"
#include "peer/app/prepare.h"
#include "peer/app/verbs.h"
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
    const std::string name = clean_text(entry.name, kMaxTextBytes);
    std::printf("%-10s %s\n", name.c_str(), entry.title.c_str());
  }
  return kExitOk;
}

struct PlanOptions {
  std::string scene;
  double spacing = 0.0;  // m, 0 = the scene's
  std::string backend = "auto";
  int gpu = 0;
};

int print_plan(const PlanOptions& options) {
  Result<Scene> loaded = load_named_scene(options.scene);
  if (!loaded) return fail(loaded.error());
  const Scene& scene = loaded.value();
  const Result<Backend> backend = choose_backend(options.backend, options.gpu);
  if (!backend) return fail(backend.error());
  double spacing = options.spacing;
  if (spacing <= 0.0) spacing = scene.spacing > 0.0 ? scene.spacing : scene.spacing_max;
  const Plan plan = make_plan(scene, spacing);
  const ParticleEstimate count = estimate_particles(scene, spacing);
  std::printf("%s%s\nThe numbers behind it\n%s", describe(plan).c_str(), picture_in_words(scene).c_str(),
              plan_numbers(scene, plan, count.fluid, count.surface).c_str());
  std::fflush(stdout);
  const Result<std::string> cost =
      step_cost_in_words(scene, plan, count.fluid + count.surface, backend.value(), options.gpu);
  if (!cost) return fail({"a step", "cannot be taken: " + cost.error().text(), ""});
  std::printf("%s", cost.value().c_str());
  if (plan.has_fluid())
    std::printf("carried out     %s\n",
                variant_in_words(plan, static_cast<std::uint32_t>(count.fluid), backend.value(), options.gpu)
                    .c_str());
  return kExitOk;
}

}  // namespace

void add_scenes(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb = app.add_subcommand("scenes", "List the shipped scenes");
  verb->footer("Example:\n  slosh scenes");
  verb->callback([&chosen] { chosen = list_scenes; });
}

void add_plan(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb = app.add_subcommand("plan", "Show the passes that a scene needs, each with its reason");
  auto options = std::make_shared<PlanOptions>();
  verb->add_option("SCENE", options->scene, "A shipped scene's name, or a .gltf or .glb file")->required();
  verb->add_option("--spacing", options->spacing,
                   "Metres between particles (the scene's own, else its coarsest)")
      ->check(in_range(1e-4, 1.0));
  add_backend_options(*verb, options->backend, options->gpu, "What a step is measured on");
  verb->footer(
      "Examples:\n  slosh plan bucket\n  slosh plan pour --spacing 0.008\n  slosh plan pool --backend cpu");
  verb->callback([&chosen, options] { chosen = [options] { return print_plan(*options); }; });
}

int fail(const Error& error) {
  constexpr std::size_t kMax = 4000;
  std::string text = clean_lines(error.text(), kMax);
  if (!text.empty() && std::string_view(".?!").find(text.back()) == std::string_view::npos) text += '.';
  std::fprintf(stderr, "slosh: %s\n", text.c_str());
  return kExitFailed;
}

int fail(const Error& error, Progress& progress) {
  progress.end();
  return fail(error);
}

}  // namespace slosh
