// A scene played by its own scripts as fast as it goes: what every hand feels, at every step, the same again
// each time.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "peer/output/plot.h"
#include "tests/lab/report/trial.h"

namespace slosh {

struct ScriptedRun {
  std::vector<WrenchSeries> hands;               ///< one a grip; a sample a step, nothing averaged
  std::vector<std::vector<Pose>> poses;          ///< of the handles, at the same times
  std::vector<std::vector<glm::dvec3>> centers;  ///< m, world: of mass, of the body that each holds
  report::Cost cost;
};

/// The scene's own model and support; settles as the scene asks, in the hands that hold. `share`, 0–1, is
/// told now and then. Throws report::Refused, report::Stopped.
ScriptedRun run_scripted(const Scene& scene, report::Setting setting, double seconds,
                         const std::function<void(double)>& tell);

/// As play's wrenches.csv, a row a step. False when it could not be written.
bool write_wrenches(const std::filesystem::path& file, const ScriptedRun& run);

}  // namespace slosh
