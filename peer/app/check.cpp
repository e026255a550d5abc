// The verb `check`: everything that is wrong with a scene, or not as it will have been meant, and what is in
// it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "net/text/clean.h"
#include "net/wire/scene_package.h"
#include "peer/app/check_run.h"
#include "peer/app/common_options.h"
#include "peer/app/plan_numbers.h"
#include "peer/app/prepare.h"
#include "peer/app/verbs.h"
#include "peer/output/summary.h"
#include "scenes/inspect.h"
#include "scenes/load.h"
#include "scenes/sample.h"
#include "sim/backend.h"
#include "sim/math/format.h"
#include "sim/plan.h"
#include "sim/step_limits.h"

namespace slosh {
namespace {

struct CheckOptions {
  std::string scene;
  double spacing = 0.0;  // m; 0: the scene's own, else its coarsest
  bool json = false;
  bool still = false;  // --static: nothing is stepped
};

/// A scene that loads, at one spacing.
struct Counted {
  double spacing = 0.0;
  std::size_t fluid = 0;
  std::size_t surface = 0;
  double mass = 0.0;  // kg of fluid, as sampled
  SampleReport filling;
  std::optional<CheckRun> run;
};

constexpr std::size_t kMaxToRun = 400'000;  // particles: more do not get anywhere in the time that check has

Result<Counted> count(const Scene& scene, const CheckOptions& options, Progress& progress) {
  Counted counted;
  const double asked = options.spacing;
  counted.spacing = asked > 0.0 ? asked : scene.spacing > 0.0 ? scene.spacing : scene.spacing_max;
  const Plan plan = make_plan(scene, counted.spacing);
  if (const std::optional<Error> endless = refuse_endless(scene, plan)) return *endless;
  const Result<SampledScene> sampled = sample_told(scene, counted.spacing, progress, &counted.filling);
  if (!sampled) return sampled.error();
  counted.fluid = sampled.value().fluid_positions.size();
  for (const SurfaceSamples& samples : sampled.value().surfaces) counted.surface += samples.positions.size();
  const double volume = std::pow(counted.spacing, 3);
  for (const std::uint8_t fluid : sampled.value().fluid_index)
    counted.mass += volume * scene.fluids[fluid].rest_density;
  if (options.still || counted.fluid == 0) return counted;
  if (counted.fluid + counted.surface > kMaxToRun) {
    counted.run.emplace();
    return counted;
  }
  Result<CheckRun> run = run_for_check(scene, sampled.value(), plan, progress);
  if (!run) return run.error();
  counted.run = std::move(run.value());
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

/// A sentence has one end.
const char* end_of(const std::string& text) {
  return text.ends_with('.') || text.ends_with('?') || text.ends_with('!') ? "" : ".";
}

void print_warnings(const std::vector<Finding>& warnings, bool plays) {
  if (warnings.empty()) return;
  std::printf("%zu warning%s: %s\n", warnings.size(), warnings.size() == 1 ? "" : "s",
              plays ? "it plays, but" : "beside what keeps it from playing");
  for (const Finding& warning : warnings) {
    const Error& text = warning.text;
    std::printf("  %s: %s%s\n", text.where.c_str(), text.what.c_str(), end_of(text.what));
    if (!text.mend.empty()) std::printf("    %s%s\n", text.mend.c_str(), end_of(text.mend));
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
    if (counted->run && counted->run->watched > 0.0) {
      const CheckRun& run = *counted->run;
      nlohmann::json hands = nlohmann::json::array();
      for (const CheckRun::Felt& hand : run.hands)
        hands.push_back({{"grip", hand.grip},
                         {"force_n", hand.force},
                         {"swing_n", hand.swing},
                         {"steady", hand.steady()}});
      out["rest"] = {
          {"settled_s", run.settled}, {"left", run.left}, {"falling", run.falling}, {"hands", hands}};
    }
  }
  std::printf("%s\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

/// How a joint lets go and closes.
std::string changes_in_words(const Joint& joint) {
  std::string words = joint.starts_apart ? ", apart at first" : "";
  if (joint.breaks_force > 0.0) words += format(", breaks above %g N", joint.breaks_force);
  if (joint.breaks_torque > 0.0)
    words += format(joint.breaks_force > 0.0 ? " or %g N·m" : ", breaks above %g N·m", joint.breaks_torque);
  if (joint.joins_within > 0.0)
    words +=
        format(", closes within %g mm and %g°", 1e3 * joint.joins_within, glm::degrees(joint.joins_turn));
  return words;
}

void print_scene(const Scene& scene, const Counted& counted) {
  std::size_t free_bodies = 0;
  double mass = 0.0;
  for (const Body& body : scene.bodies) {
    if (body.motion != BodyMotion::kFree) continue;
    free_bodies += 1;
    mass += body.mass.mass;
  }
  const auto driven = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                    [](const Body& body) { return body.motion == BodyMotion::kDriven; });
  std::printf("ok: %s\n", scene.title.empty() ? scene.name.c_str() : scene.title.c_str());
  std::printf("  bodies      %zu (%zu free, %.3f kg)\n", scene.bodies.size(), free_bodies, mass);
  if (driven > 0) std::printf("  driven      %td bodies, by their keys\n", driven);
  for (const Joint& joint : scene.joints) {
    std::printf(
        "  joint       %s: %s of %s and %s%s%s\n", joint.name.c_str(),
        kJointKindNames[static_cast<std::size_t>(joint.kind)],
        scene.bodies[static_cast<std::size_t>(joint.body)].name.c_str(),
        joint.other < 0 ? "the world" : scene.bodies[static_cast<std::size_t>(joint.other)].name.c_str(),
        joint.motor_limit > 0.0 ? ", with a motor" : "", changes_in_words(joint).c_str());
  }
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
        clean_text(scene.fluid_volumes[v].name, kMaxTextBytes).c_str(), 1e3 * f.sampled, 1e3 * f.mesh,
        1e3 * f.in_bodies, 1e3 * f.in_others, 1e3 * f.no_place);
  }
  std::printf("  start       %s\n", start_in_words(scene).c_str());
  if (counted.run) std::printf("  rest        %s\n", rest_in_words(*counted.run).c_str());
  const auto measured =
      std::count_if(scene.bodies.begin(), scene.bodies.end(), [](const Body& body) { return body.measured; });
  if (measured > 0 || !scene.gauges.empty() || !scene.regions.empty()) {
    std::printf("  measured    %td bodies, %zu gauges, %zu regions\n", measured, scene.gauges.size(),
                scene.regions.size());
  }
  if (!scene.task.empty()) std::printf("  task        %zu steps\n", scene.task.size());
  for (const TaskStep& step : scene.task) {
    std::printf("    %s\n      until %s", step.say.c_str(), in_words(step.until, scene).c_str());
    if (step.hold > 0.0) std::printf(", for %.3g s", step.hold);
    if (step.within > 0.0) std::printf("; within %.3g s", step.within);
    std::printf("\n");
    for (const TaskAct& act : step.then) std::printf("      then %s\n", in_words(act, scene).c_str());
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

/// What of the volumes' fluid is not there, as sampled.
void judge_filling(const Scene& scene, const SampleReport& filling, Inspection& found) {
  constexpr double kMuch = 0.02;  // of a volume
  for (std::size_t v = 0; v < filling.volumes.size(); ++v) {
    const FilledVolume& f = filling.volumes[v];
    const std::string where = scene.source_file + ": node '" + scene.fluid_volumes[v].name + "'";
    if (f.in_others > kMuch * f.mesh)
      found.warnings.push_back(
          {"shared-place",
           {where,
            format("shares its place with volumes before it: %.3g of its %.3g litres are left out",
                   1e3 * f.in_others, 1e3 * f.mesh),
            "Cut the volumes so that they touch, or move one"}});
    if (f.no_place > kMuch * f.mesh)
      found.warnings.push_back(
          {"no-place",
           {where,
            format("%.3g of its %.3g litres find no place at this spacing", 1e3 * f.no_place, 1e3 * f.mesh),
            "Give finer particles (--spacing), or leave the fluid room to rise above its mesh"}});
  }
}

/// What plays here and could not be sent to guests.
void judge_network(const Scene& scene, double spacing, Inspection& found) {
  const Result<wire::Bytes> packed = pack_scene(scene, spacing, SceneParts::kSeen);
  if (!packed)
    found.warnings.push_back(
        {"network",
         {scene.source_file,
          "plays here and cannot be hosted: " + packed.error().where + " " + packed.error().what,
          packed.error().mend}});
}

int check(const CheckOptions& options) {
  const Result<std::filesystem::path> file = find_scene(options.scene);
  if (!file) return fail(file.error());
  Progress progress;
  if (progress.terminal()) progress.phase("reading", options.scene);
  Inspection found = inspect_scene(file.value());
  std::optional<Counted> counted;
  if (found.scene) {
    Result<Counted> result = count(*found.scene, options, progress);
    if (result) {
      counted = std::move(result.value());
      judge_filling(*found.scene, counted->filling, found);
      judge_network(*found.scene, counted->spacing, found);
      if (counted->run) judge_run(*found.scene, *counted->run, counted->spacing, found);
    } else {
      found.errors.push_back({"error", result.error()});
    }
  }
  progress.end();
  if (options.json) {
    print_json(file.value().string(), found, counted);
  } else {
    if (counted && found.errors.empty()) print_scene(*found.scene, *counted);
    print_warnings(found.warnings, found.errors.empty());
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
  verb->add_flag("--static", o->still, "Look at the file alone: do not let the scene run for a moment");
  verb->add_flag("--json", o->json, "The same for programs, as JSON on standard output");
  verb->footer(
      "Loads the scene, checks every value and mesh, samples it, and lets it run for a moment: it settles, "
      "then "
      "the hands\n"
      "stand still and what they feel is watched, in 10 s at most (--static leaves that out). Errors keep it "
      "from\n"
      "playing; warnings are what will surprise: what exports from Blender are known to lose (a camera, the "
      "animation,\n"
      "modifiers, +Y up, …), what the file says and slosh does not do (shape keys, skins, hidden objects), "
      "fluid "
      "that lies in\n"
      "no vessel or leaves it, layers thinner than particles, hands out of reach, sizes in other units, a "
      "start "
      "that is not at\n"
      "rest. Each with the number, and the mend in Blender's words.\n"
      "Exit code 1 where there is an error, 0 with warnings alone.\n\n"
      "Examples:\n  slosh check bucket\n  slosh check my_scene.glb --spacing 0.005\n"
      "  slosh check my_scene.glb --json");
  verb->callback([&chosen, o] { chosen = [o] { return check(*o); }; });
}

}  // namespace slosh
