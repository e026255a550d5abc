// The program's verbs: each adds its subcommand and, when chosen, runs and returns an exit code.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>

#include "sim/math/result.h"

namespace slosh {

constexpr int kExitOk = 0;
constexpr int kExitFailed = 1;
constexpr int kExitUsage = 2;

class Progress;
struct SettingsFile;

/// What the chosen verb will do once the command line is read.
using VerbRun = std::function<int()>;

void add_play(CLI::App& app, VerbRun& chosen);
void add_host(CLI::App& app, VerbRun& chosen);
void add_join(CLI::App& app, VerbRun& chosen);
void add_watch(CLI::App& app, VerbRun& chosen);
void add_replay(CLI::App& app, VerbRun& chosen);
void add_links(CLI::App& app, VerbRun& chosen);
void add_devices(CLI::App& app, VerbRun& chosen);
void add_scenes(CLI::App& app, VerbRun& chosen);
void add_check(CLI::App& app, VerbRun& chosen);
void add_plan(CLI::App& app, VerbRun& chosen);
/// The laboratory's, in the program slosh-lab (tests/lab), with what --help says of them here and there.
void add_sweep(CLI::App& app, VerbRun& chosen);
void add_report(CLI::App& app, VerbRun& chosen);
inline constexpr const char* kSweepAbout = "Run a scene with other values of its fields: one table, one plot";
inline constexpr const char* kReportAbout =
    "Measure: error against run time, stability, delays, passes, speed, pictures, figures";
/// `file` must outlive `chosen`.
void add_settings(CLI::App& app, const SettingsFile& file, VerbRun& chosen);
/// Gives the options of every verb of `app` their values from `file`, and says at each which key it has. What
/// an option refuses becomes an error of the file. To be called once all verbs are there and before they are
/// parsed.
void put_in_force(SettingsFile& file, CLI::App& app);

/// "slosh: <where>: <what>. <mend>." on stderr; returns kExitFailed.
int fail(const Error& error);
/// The same, below what `progress` kept up to date.
int fail(const Error& error, Progress& progress);

}  // namespace slosh
