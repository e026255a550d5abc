// A small file that is there whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

#include "sim/math/result.h"

namespace slosh {

/// Writes a sibling (`file`.part) and renames it. On an error what was there before stays, and no part of the
/// new one. Errors: the system's, a full disk among them.
Result<bool> write_whole(const std::filesystem::path& file, std::string_view bytes);

}  // namespace slosh
