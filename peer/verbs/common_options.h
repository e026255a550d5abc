// Options that several verbs have, each declared once.
#pragma once

#include <CLI/App.hpp>
#include <string>

#include "peer/verbs/play_options.h"

namespace slosh {

/// How a run is drawn: --size, --fps, --bilateral, --no-render. `has_window`: the verb can also open one.
/// `verb` and `options` must outlive the parsing.
void add_show_options(CLI::App& verb, ShowOptions& options, bool has_window);

/// What a world is made of and runs on: --backend, --spacing, --particles, --threads. `all_cores` says what
/// --threads is by default.
void add_world_options(CLI::App& verb, PlayOptions& options, const std::string& all_cores);

/// --backend alone, with what `auto` means.
void add_backend_option(CLI::App& verb, std::string& backend, const std::string& text);

}  // namespace slosh
