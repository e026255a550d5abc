// From what was asked for to everything that a run needs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "peer/app/play_options.h"
#include "peer/haptics/guidance.h"
#include "peer/output/export/export_options.h"
#include "peer/output/machine.h"
#include "peer/output/progress.h"
#include "peer/output/run_folder.h"
#include "scenes/sample.h"
#include "scenes/scene.h"
#include "sim/backend.h"
#include "sim/plan.h"
#include "sim/world.h"

namespace slosh {

/// What a viewer needs of a run, wherever its world is.
struct Stage {
  Scene scene;
  Machine machine;
  double seconds = 0.0;          ///< simulated; infinity = until the window closes
  std::filesystem::path folder;  ///< exists, or empty
  RunFolder claim;               ///< on `folder`, while the run lasts
  int width = 0;
  int height = 0;
  double measure = 0.0;             ///< simulated s between rows of the instruments; 0 = none
  std::vector<ExportKind> exports;  ///< what is written for other programs; empty = nothing
  double export_rate = 30.0;        ///< frames a simulated second
  double row_rate = 500.0;          ///< of hands, rows a simulated second
  bool signals = false;             ///< of hands, each tick of the device loop
  std::vector<GuidedHand> ghost;    ///< hands of an earlier run, shown, and led to where `most` is above 0
  std::shared_ptr<GhostClock> ghost_clock = std::make_shared<GhostClock>(std::vector<double>());  ///< theirs
};

struct Prepared : Stage {
  SampledScene sampled;
  Plan plan;
  std::string spacing_reason;
  Backend backend = Backend::kCpu;  ///< what was chosen; never kAuto
  int gpu = 0;                      ///< the simulation's, with kCuda
  int threads = 1;                  ///< the simulation's
  bool agreed = false;              ///< it may take as long as it takes
  bool unpaced = false;             ///< the world goes as fast as it can
  std::filesystem::path record;     ///< where the run is recorded; empty = it is not

  WorldOptions world_options() const { return {.threads = threads, .backend = backend, .gpu = gpu}; }
};

/// Finds and loads a shipped name or a file.
Result<Scene> load_named_scene(const std::string& name_or_path);

/// What `--backend` comes to on this machine: kCpu or kCuda. Errors: another word than auto, cpu, cuda; cuda
/// where GPU `gpu` does not answer, or another than the first where it does not.
Result<Backend> choose_backend(const std::string& text, int gpu);

/// "640x480" to two numbers of pixels, 16–8192 each. Errors: anything else.
Result<std::pair<int, int>> parse_size(const std::string& text);

/// As sample_scene. What takes more than kLongSampling s is told before it begins, and then how far it is.
Result<SampledScene> sample_told(const Scene& scene, double spacing, Progress& progress,
                                 SampleReport* report = nullptr);
constexpr double kLongSampling = 5.0;

/// How often the instruments of `stage` are read: never without a folder to write to.
void set_measure(const ShowOptions& options, Stage& stage);

/// The hands of an earlier run that `--ghost` names, one a grip that it has. Errors: it cannot be read, or
/// has none; `--guide` without it.
Result<bool> set_ghost(const ShowOptions& options, Stage& stage);

/// What `stage` is to export. Errors: a word that is none.
Result<bool> set_exports(const ShowOptions& options, Stage& stage);

/// Fills `stage` but for its scene, which must be there: size, seconds, folder (made, and this run's own).
/// Errors: a size that is none, a folder that cannot be made or that holds another run, none for what is
/// exported.
Result<bool> set_stage(const ShowOptions& options, bool headless, Stage& stage);

/// Loads, makes the folder, measures, samples, plans; whatever was asked for is looked at before the
/// measuring, which takes long. Errors: anything of these.
Result<Prepared> prepare(const PlayOptions& options, bool headless, Progress& progress);

}  // namespace slosh
