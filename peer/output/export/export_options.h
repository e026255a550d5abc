// What is to be written for other programs while a run goes on.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh {

/// In the order of kExportNames.
enum class ExportKind : std::uint8_t { kParticlesPly, kParticlesVtu, kSurfacePly, kSurfaceGlb, kSurfaceVdb };

/// As --export takes them: what, a colon, the file format.
inline constexpr std::array kExportNames{"particles:ply", "particles:vtu", "surface:ply", "surface:glb",
                                         "surface:vdb"};

/// Whether this program was built with OpenVDB, which makes surfaces.
bool can_make_surfaces();

/// The kinds that `words` name, each once. Errors, for --export: a word that is none, with the nearest that
/// is; a surface where the program was built without OpenVDB.
Result<std::vector<ExportKind>> parse_exports(const std::vector<std::string>& words);

bool is_surface(ExportKind kind);
/// "particles" or "surface".
const char* stem(ExportKind kind);
/// "ply", "vtu", "glb", "vdb".
const char* extension(ExportKind kind);

}  // namespace slosh
