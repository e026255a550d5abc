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

/// The line of a script that chooses the format ("png", "svg" or "pdf") and the size, in pixels; a PDF's are
/// points of 1/72 inch, so that letters of `font_points` are as large on its sheet.
std::string gnuplot_terminal(const std::string& format, int width, int height, int font_points);

/// Runs a script that writes a picture to its standard output, and keeps that in `file`, whole or not at all.
/// Errors: gnuplot is missing or failed, the file cannot be written.
Result<bool> draw(const std::string& script, const std::filesystem::path& file);

}  // namespace slosh
