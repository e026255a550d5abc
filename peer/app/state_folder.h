// What the program keeps from run to run, and where.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scenes/scene.h"
#include "sim/backend.h"

namespace slosh {

/// $XDG_STATE_HOME/slosh, else ~/.local/state/slosh; empty where neither is known. May not exist yet.
std::string state_folder();

/// Where the views that a person keeps of a scene are, in views/ of it: a shipped scene's by its name, as
/// one's that comes over a network; that of a file of one's own by its path too, so that two scenes of one
/// name keep theirs. Empty where there is no state folder.
std::filesystem::path file_of_views(const Scene& scene);

/// The spacing that was measured once for a scene on a machine is taken again, so that forces compare from
/// run to run. What that holds for: the scene file's bytes, the processor, backend, threads and version.
std::string spacing_key(const std::filesystem::path& scene_file, const std::string& processor,
                        Backend backend, int threads);
/// m; nothing where none was kept, or what was cannot be read.
std::optional<double> kept_spacing(const std::string& key);
/// Keeps it in spacings.json of the state folder, among the newest hundred. What cannot be written is not
/// kept: the next run measures again.
void keep_spacing(const std::string& key, double spacing);

}  // namespace slosh
