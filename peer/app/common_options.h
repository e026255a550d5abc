// Options that several verbs have, each declared once.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>
#include <string>

#include "peer/app/play_options.h"

namespace slosh {

/// A number from `least` to `most`: "nan" and "inf", which CLI::Range lets through, are none.
CLI::Validator in_range(double least, double most);

/// For a whole number, also as 1e6 (CLI::Option::transform).
CLI::Validator whole_number();

/// --seconds with `text`, from `least` up.
void add_seconds_option(CLI::App& verb, double& seconds, double least, const std::string& text);

/// Where the files of a run go: --out with `text`, --overwrite.
void add_out_options(CLI::App& verb, ShowOptions& options, const std::string& text);

/// --headless of a verb that opens no window whatever is said: so that one command line serves all verbs that
/// run a world. `text`: that, and who opens one.
void add_never_a_window_option(CLI::App& verb, const std::string& text);

/// How a run is drawn: --size, --ghost, --fps, --surface, --bilateral, --ocio, --display, --view,
/// --environment, --font-scale, --runs, --plot, --curves, --no-render. `has_window`: the verb can also open
/// one. `verb` and `options` must outlive the parsing.
void add_show_options(CLI::App& verb, ShowOptions& options, bool has_window);
/// --guide, of a verb with hands: beside --ghost of add_show_options().
void add_guide_option(CLI::App& verb, ShowOptions& options);

/// `--vr` and what goes with it.
void add_headset_options(CLI::App& verb, ShowOptions& options, bool has_hands = true);
/// --measure, for a run that writes files.
CLI::Option* add_measure_option(CLI::App& verb, ShowOptions& options);

/// --export and --export-rate, for a run that writes files.
void add_export_options(CLI::App& verb, ShowOptions& options);

/// What a world is made of and runs on: --backend, --spacing, --particles, --threads, --yes. `all_cores` says
/// what --threads is by default.
void add_world_options(CLI::App& verb, PlayOptions& options, const std::string& all_cores);

/// --backend, with what `auto` means, and --sim-gpu.
void add_backend_options(CLI::App& verb, std::string& backend, int& gpu, const std::string& text);

}  // namespace slosh
