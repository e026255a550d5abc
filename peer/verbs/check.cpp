// The verb `check`: everything that is wrong with a scene, or not as it will have been meant, and what is in
// it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "net/text/clean.h"
#include "peer/output/summary.h"
#include "peer/verbs/common_options.h"
#include "peer/verbs/plan_numbers.h"
#include "peer/verbs/prepare.h"
#include "peer/verbs/verbs.h"
#include "scenes/inspect.h"
#include "scenes/load.h"
#include "scenes/sample.h"
#include "sim/backend.h"
#include "sim/plan.h"
#include "sim/step_limits.h"

namespace slosh {
namespace {

struct CheckOptions {
  std::string scene;
  double spacing = 0.0;  // m; 0: the scene's own, else its coarsest
  bool json = false;
};

/// A scene that loads, at one spacing.
struct Counted {
  double spacing = 0.0;
  std::size_t fluid = 0;
  std::size_t surface = 0;
  double mass = 0.0;  // kg of fluid, as sampled
  SampleReport filling;
};

Result<Counted> count(const Scene& scene, double asked, Progress& progress) {
  Counted counted;
  counted.spacing = asked > 0.0 ? asked : scene.spacing > 0.0 ? scene.spacing : scene.spacing_max;
  if (const std::optional<Error> endless =
          refuse_endless(scene, make_plan(scene, counted.spacing, can_solve_drag(Backend::kAuto))))
    return *endless;
  const Result<SampledScene> sampled = sample_told(scene, counted.spacing, progress, &counted.filling);
  if (!sampled) return sampled.error();
  counted.fluid = sampled.value().fluid_positions.size();
  for (const SurfaceSamples& samples : sampled.value().surfaces) counted.surface += samples.positions.size();
  const double volume = std::pow(counted.spacing, 3);
  for (const std::uint8_t fluid : sampled.value().fluid_index)
    counted.mass += volume * scene.fluids[fluid].rest_density;
  return counted;
}

double litres(const Scene& scene) {
  return 1e3 * estimate_particles(scene, 1.0).fluid;
}

/// The name between the quotes of "file: node 'cup': …"; empty where no object is named.
std::string object_of(const std::string& where) {
  const std::string begin = "node '";
  const std::size_t from = where.find(begin);
  if (from == std::string::npos) return {};
  const std::size_t to = where.find('\'', from + begin.size());
  return where.substr(from + begin.size(), to == std::string::npos ? to : to - from - begin.size());
}

void print_warnings(const std::vector<Finding>& warnings) {
  if (warnings.empty()) return;
  std::printf("%zu warning%s: it plays, but\n", warnings.size(), warnings.size() == 1 ? "" : "s");
  for (const Finding& warning : warnings) {
    std::printf("  %s: %s.\n", warning.text.where.c_str(), warning.text.what.c_str());
    if (!warning.text.mend.empty()) std::printf("    %s.\n", warning.text.mend.c_str());
  }
}

nlohmann::json as_json(const std::vector<Finding>& findings) {
  nlohmann::json list = nlohmann::json::array();
  for (const Finding& finding : findings) {
    list.push_back({{"kind", finding.kind},
                    {"object", object_of(finding.text.where)},
                    {"where", finding.text.where},
                    {"what", finding.text.what},
                    {"mend", finding.text.mend}});
  }
  return list;
}

void print_json(const std::string& file, const Inspection& found, const std::optional<Counted>& counted) {
  nlohmann::json out{{"file", file},
                     {"ok", found.errors.empty()},
                     {"errors", as_json(found.errors)},
                     {"warnings", as_json(found.warnings)}};
  if (found.scene && counted) {
    out["scene"] = {{"title", found.scene->title},          {"bodies", found.scene->bodies.size()},
                    {"grips", found.scene->grips.size()},   {"fluids", found.scene->fluids.size()},
                    {"fluid_litres", litres(*found.scene)}, {"fluid_kg", counted->mass},
                    {"spacing_m", counted->spacing},        {"fluid_particles", counted->fluid},
                    {"body_particles", counted->surface}};
  }
  std::printf("%s\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

void print_scene(const Scene& scene, const Counted& counted) {
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
              counted.mass);
  for (std::size_t v = 0; v < counted.filling.volumes.size(); ++v) {
    const FilledVolume& f = counted.filling.volumes[v];
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
              grouped(counted.fluid).c_str(), grouped(counted.surface).c_str(), 1e3 * counted.spacing,
              1e3 * scene.spacing_min, 1e3 * scene.spacing_max);
}

int check(const CheckOptions& options) {
  const Result<std::filesystem::path> file = find_scene(options.scene);
  if (!file) return fail(file.error());
  Inspection found = inspect_scene(file.value());
  std::optional<Counted> counted;
  if (found.scene) {
    Progress progress;
    Result<Counted> result = count(*found.scene, options.spacing, progress);
    if (result) {
      counted = std::move(result.value());
    } else {
      found.errors.push_back({"error", result.error()});
    }
  }
  if (options.json) {
    print_json(file.value().string(), found, counted);
  } else {
    if (counted) print_scene(*found.scene, *counted);
    print_warnings(found.warnings);
    std::fflush(stdout);
    for (const Finding& finding : found.errors) fail(finding.text);
    if (found.errors.size() > 1)
      std::fprintf(stderr, "slosh: %zu errors keep it from playing\n", found.errors.size());
  }
  return found.errors.empty() ? kExitOk : kExitFailed;
}

}  // namespace

void add_check(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb =
      app.add_subcommand("check", "Say everything that is wrong with a scene, and what is in it");
  auto o = std::make_shared<CheckOptions>();
  verb->add_option("FILE", o->scene, "A .gltf or .glb file, or a shipped scene's name")->required();
  verb->add_option("--spacing", o->spacing, "Metres between particles (the scene's own, else its coarsest)")
      ->check(in_range(1e-4, 1.0));
  verb->add_flag("--json", o->json, "The same for programs, as JSON on standard output");
  verb->footer(
      "Loads the scene, checks every value and mesh, and samples it. Errors keep it from playing; warnings "
      "are what\n"
      "exports from Blender are known to lose (a camera, the animation, modifiers, +Y up, …), each with the "
      "mend in\n"
      "Blender's words. All at once; of each object the first error.\n"
      "Exit code 1 where there is an error, 0 with warnings alone.\n\n"
      "Examples:\n  slosh check bucket\n  slosh check my_scene.glb --spacing 0.005\n"
      "  slosh check my_scene.glb --json");
  verb->callback([&chosen, o] { chosen = [o] { return check(*o); }; });
}

}  // namespace slosh
