// Gnuplot, fed with scripts of ours.
#pragma once

#include <filesystem>
#include <string>

#include "sim/math/result.h"

namespace slosh {

/// A text as a string of gnuplot's. Gnuplot runs what stands in backquotes in a string, and its single-quoted
/// strings end at a doubled quote that comes first: so no character of a name may reach its parser. Every
/// byte is written as a number, `\ooo`, which gnuplot turns into text after it has parsed.
std::string gnuplot_text(const std::string& text);

/// Runs a script that writes a picture to its standard output, and keeps that in `file`, whole or not at all.
/// Errors: gnuplot is missing or failed, the file cannot be written.
Result<bool> draw(const std::string& script, const std::filesystem::path& file);

}  // namespace slosh
