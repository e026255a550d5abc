#include "peer/app/prepare.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>
#include <tuple>

#include "host/auto_spacing.h"
#include "host/keep/recording.h"
#include "peer/app/measurer.h"
#include "peer/app/state_folder.h"
#include "peer/app/time_estimate.h"
#include "peer/haptics/make_device.h"
#include "peer/haptics/script_device.h"
#include "peer/output/summary.h"
#include "scenes/load.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

struct Spacing {
  double metres = 0.0;
  std::string reason;
};

Result<Spacing> spacing_for_particles(const Scene& scene, std::size_t particles) {
  const double volume = estimate_particles(scene, 1.0).fluid;  // particles of 1 m³
  if (volume <= 0.0) return Error{"--particles", "the scene has no fluid", "Use --spacing"};
  const double spacing = std::cbrt(volume / static_cast<double>(particles));
  return Spacing{spacing, "asked for " + grouped(particles) + " fluid particles"};
}

/// The number after --spacing; nothing where it is to be chosen.
Result<std::optional<double>> asked_spacing(const PlayOptions& options) {
  if (options.spacing.empty() || options.spacing == "auto") return std::optional<double>();
  double metres = 0.0;
  const char* end = options.spacing.data() + options.spacing.size();
  const auto [at, code] = std::from_chars(options.spacing.data(), end, metres);
  if (code != std::errc() || at != end || !(metres >= 1e-4 && metres <= 1.0)) {
    return Error{"--spacing", "'" + options.spacing + "' is neither auto nor 0.0001 to 1 metres",
                 "For 10 mm give 0.01"};
  }
  return std::optional(metres);
}

Result<Spacing> choose(const Scene& scene, const PlayOptions& options, std::optional<double> asked,
                       int threads, Backend backend, Progress& progress) {
  if (options.particles > 0) return spacing_for_particles(scene, options.particles);
  if (asked) return Spacing{*asked, "asked for"};
  if (options.spacing.empty() && scene.spacing > 0.0) return Spacing{scene.spacing, "the scene asks for it"};

  // Measured once for this scene here, it is taken again; --spacing auto measures anew.
  const std::string key = spacing_key(scene.source_file, this_machine().cpu, backend, threads);
  if (options.spacing.empty()) {
    const std::optional<double> kept = kept_spacing(key);
    if (kept && *kept >= scene.spacing_min && *kept <= scene.spacing_max)
      return Spacing{*kept, "measured for this scene on this machine before (--spacing auto measures again)"};
  }
  progress.phase("measuring");
  SpacingOptions measure;
  measure.threads = threads;
  measure.backend = backend;
  measure.gpu = options.gpu;
  measure.tell = [&progress](const std::string& text) { progress.update(-1.0, text); };
  const Result<SpacingChoice> choice = measure_spacing(scene, measure);
  if (!choice) return choice.error();
  keep_spacing(key, choice.value().spacing);
  return Spacing{choice.value().spacing, choice.value().reason};
}

Result<RunFolder> take_folder(const ShowOptions& options, const Scene& scene, bool headless) {
  if (!options.out.empty()) return RunFolder::take(options.out, options.overwrite);
  if (!headless) return RunFolder();
  const std::string name =
      !options.default_out.empty() ? options.default_out : folder_name(scene.name, "scene");
  return RunFolder::take_free(std::filesystem::path(options.runs) / name);
}

/// Steps of 1/`rate` s, of as many sub-steps no longer than the plan's own steps.
void step_at(Plan& plan, double rate) {
  constexpr double kSameStep = 1e-9;
  const double own = plan.time_step / plan.sub_steps;
  plan.time_step = 1.0 / rate;
  plan.sub_steps = std::max(1, static_cast<int>(std::ceil(plan.time_step / own - kSameStep)));
  plan.max_speed = speed_limit(plan, plan.time_step / plan.sub_steps);
}

/// Whether a recording can be begun there later. Errors: no such folder, not writable, something is there.
Result<bool> check_record(const std::string& record) {
  if (record.empty()) return true;
  const std::filesystem::path file(record);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::error_code code;
  const char* const mend = "Choose another file with --record";
  if (!std::filesystem::is_directory(folder, code))
    return Error{record, "there is no folder " + folder.string(), mend};
  if (std::filesystem::is_directory(file, code)) return Error{record, "is a folder", mend};
  if (const Result<bool> free = keep::check_unrecorded(file); !free) return free.error();
  const bool there = std::filesystem::exists(file, code);
  if (access(there ? file.c_str() : folder.c_str(), there ? W_OK : W_OK | X_OK) != 0)
    return Error{record, "cannot be written: " + std::generic_category().message(errno), mend};
  return true;
}

}  // namespace

Result<Scene> load_named_scene(const std::string& name_or_path) {
  const Result<std::filesystem::path> file = find_scene(name_or_path);
  if (!file) return file.error();
  return load_scene(file.value());
}

Result<std::pair<int, int>> parse_size(const std::string& text) {
  int width = 0;
  int height = 0;
  const char* end = text.data() + text.size();
  auto [at, code] = std::from_chars(text.data(), end, width);
  if (code == std::errc() && at != end && *at == 'x') {
    const auto [after, second] = std::from_chars(at + 1, end, height);
    if (second == std::errc() && after == end && width >= 16 && width <= 8192 && height >= 16 &&
        height <= 8192) {
      return std::pair{width, height};
    }
  }
  return Error{"--size", "'" + text + "' is not WIDTHxHEIGHT in pixels, 16 to 8192 each",
               "For example 640x480"};
}

Result<Backend> choose_backend(const std::string& text, int gpu_number) {
  const std::optional<Backend> wanted = backend_named(text);
  if (!wanted) return Error{"--backend", "'" + text + "' is unknown", "Choose auto, cpu or cuda"};
  std::string reason;
  const bool gpu = *wanted != Backend::kCpu && cuda_available(&reason, gpu_number);
  if (*wanted == Backend::kCuda && !gpu) {
    return Error{"--backend cuda", reason, "Use --backend cpu or auto"};
  }
  if (gpu_number > 0 && !gpu)
    return Error{format("--sim-gpu %d", gpu_number),
                 *wanted == Backend::kCpu ? "the simulation is to run on the CPU" : reason,
                 "Leave it out, or give --backend cuda and a GPU that `nvidia-smi -L` lists"};
  return gpu ? Backend::kCuda : Backend::kCpu;
}

Result<bool> set_stage(const ShowOptions& options, bool headless, Stage& stage) {
  stage.row_rate = options.row_rate;
  stage.signals = options.signals;
  if (options.render_gpu >= 0 && !headless)
    return Error{"--render-gpu", "is for films: a window is drawn by its display's GPU",
                 "Give --headless too, or choose the simulation's GPU with --sim-gpu"};
  const Result<std::pair<int, int>> size =
      parse_size(options.size.empty() ? std::string("1280x720") : options.size);
  if (!size) return size.error();
  std::tie(stage.width, stage.height) = size.value();
  stage.seconds = options.seconds > 0.0 ? options.seconds
                  : headless            ? stage.scene.duration
                                        : std::numeric_limits<double>::infinity();
  if (const Result<bool> exports = set_exports(options, stage); !exports) return exports.error();
  if (const Result<bool> ghost = set_ghost(options, stage); !ghost) return ghost.error();
  Result<RunFolder> folder = take_folder(options, stage.scene, headless);
  if (!folder) return folder.error();
  if (!stage.exports.empty() && folder.value().path().empty())
    return Error{"--export", "there is no folder to write to", "Give one with --out, or run with --headless"};
  stage.claim = folder.value();
  stage.folder = stage.claim.path();
  set_measure(options, stage);
  return true;
}

Result<bool> set_exports(const ShowOptions& options, Stage& stage) {
  Result<std::vector<ExportKind>> exports = parse_exports(options.exports);
  if (!exports) return exports.error();
  stage.exports = std::move(exports.value());
  stage.export_rate = options.export_rate;
  return true;
}

Result<SampledScene> sample_told(const Scene& scene, double spacing, Progress& progress,
                                 SampleReport* report) {
  const ParticleEstimate particles = estimate_particles(scene, spacing);
  const double seconds = estimate_sampling(particles);
  if (seconds < kLongSampling) return sample_scene(scene, spacing, report);
  progress.note("sampling takes about " + duration(seconds) + ": some " +
                grouped(static_cast<std::uint64_t>(particles.surface)) + " particles of bodies and " +
                grouped(static_cast<std::uint64_t>(particles.fluid)) +
                " of fluid. Is the scene in metres? Larger --spacing is quicker");
  return sample_scene(scene, spacing, report, [&](double share) { progress.update(share, "sampling"); });
}

void set_measure(const ShowOptions& options, Stage& stage) {
  const bool asks = options.measure > 0.0 || (options.measure < 0.0 && asks_to_be_measured(stage.scene));
  if (asks && !stage.folder.empty())
    stage.measure = options.measure > 0.0 ? options.measure : kMeasureInterval;
}

Result<Prepared> prepare(const PlayOptions& options, bool headless, Progress& progress) {
  Prepared p;
  const Result<Backend> backend = choose_backend(options.backend, options.gpu);
  if (!backend) return backend.error();
  const Result<std::optional<double>> asked = asked_spacing(options);
  if (!asked) return asked.error();
  if (!options.size.empty()) {
    if (const Result<std::pair<int, int>> size = parse_size(options.size); !size) return size.error();
  }
  if (options.unpaced && !headless) {
    return Error{"--unpaced", "is for a run that nobody looks at", "Give --headless or --no-render too"};
  }
  if (const Result<bool> recordable = check_record(options.record); !recordable) return recordable.error();
  p.backend = backend.value();
  p.gpu = options.gpu;
  p.record = options.record;
  p.agreed = options.agreed;
  p.unpaced = options.unpaced;
  p.machine = this_machine();
  // Drawing takes a core of its own; the device loop and the encoder take little.
  p.threads = options.threads > 0 ? options.threads
                                  : std::max(1, options.render ? p.machine.cores - 1 : p.machine.cores);

  progress.phase("loading", options.scene);
  Result<Scene> scene = load_named_scene(options.scene);
  if (!scene) return scene.error();
  p.scene = std::move(scene.value());
  for (const Error& what : p.scene.left_out)
    progress.note("slosh: " + what.text() + "; the run goes on without it");
  if (!options.devices.empty()) {
    const Result<DeviceSet> devices = make_devices(p.scene, options.devices, !headless, options.controllers);
    if (!devices) return devices.error();
    for (const std::unique_ptr<Device>& device : devices.value().devices) {
      if (!options.unpaced || device->immediate()) continue;
      return Error{"--unpaced", std::string("a ") + device->kind() + " goes by the clock on the wall",
                   "Leave --unpaced out, or use script, replay:FILE or operator"};
    }
  }
  const Result<bool> set = set_stage(options, headless, p);
  if (!set) return set.error();

  const Result<Spacing> spacing = choose(p.scene, options, asked.value(), p.threads, p.backend, progress);
  if (!spacing) return spacing.error();
  p.spacing_reason = spacing.value().reason;
  progress.note(format("spacing %.2f mm: ", 1e3 * spacing.value().metres) + p.spacing_reason);

  progress.phase("sampling");
  Result<SampledScene> sampled = sample_told(p.scene, spacing.value().metres, progress);
  if (!sampled) return sampled.error();
  p.sampled = std::move(sampled.value());
  p.plan = make_plan(p.scene, spacing.value().metres);
  if (options.step_rate > 0.0) step_at(p.plan, options.step_rate);
  return p;
}

}  // namespace slosh
