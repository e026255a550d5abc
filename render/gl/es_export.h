// The programs of es_programs.h as files, for somebody who writes a spectator for a browser.
#pragma once

#include <cstddef>
#include <filesystem>

#include "sim/math/result.h"

namespace slosh {

/// Writes each text into `folder` (made if it is not there), and programs.json: of each program its two
/// files, its defines, the units of its textures and of its buffers with the texels of an item, the binding
/// points of its blocks. Gives how many programs. Errors: a folder or a file that cannot be written.
Result<std::size_t> export_es_programs(const std::filesystem::path& folder);

}  // namespace slosh
