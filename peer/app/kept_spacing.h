// The spacing that was measured once for a scene on a machine is taken again, so that forces compare from run
// to run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sim/backend.h"

namespace slosh {

/// What a choice holds for: the scene file's bytes, the processor, backend, threads and version.
std::string spacing_key(const std::filesystem::path& scene_file, const std::string& processor,
                        Backend backend, int threads);

/// m; nothing where none was kept, or what was cannot be read.
std::optional<double> kept_spacing(const std::string& key);

/// Keeps it in spacings.json of the state folder, among the newest hundred. What cannot be written is not
/// kept: the next run measures again.
void keep_spacing(const std::string& key, double spacing);

}  // namespace slosh
