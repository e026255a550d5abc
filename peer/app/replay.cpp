// The verb `replay`: a recording simulated again, compared and filmed.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>

#include "peer/app/common_options.h"
#include "peer/app/interrupt.h"
#include "peer/app/play_modes.h"
#include "peer/app/replay_run.h"
#include "peer/app/verbs.h"

namespace slosh {
namespace {

struct ReplayVerbOptions : ShowOptions {
  std::string file;
  std::string backend = "auto";
  int threads = 0;
  int gpu = 0;
};

constexpr const char* kReplayFooter =
    R"(The world is simulated again from the recorded inputs, as fast as it goes. On the backend that it was
recorded on, every hash is compared: "84 of 84 hashes agree", or the first tick that differs and exit
code 1. On another one bodies are compared within a spacing. With --out, DIR gets what `slosh play`
writes headless: view.mp4, final.png, wrenches.csv, wrenches.png, summary.json; wrenches are the world's,
not the device loop's.

Examples:
  slosh play bucket --headless --record bucket.rec
  slosh replay bucket.rec --no-render
  slosh replay bucket.rec --out out/again --size 1280x720)";

int replay(ReplayVerbOptions options) {
  end_at_interrupts();
  Progress progress;
  const std::optional<Backend> backend = backend_named(options.backend);
  if (!backend)
    return fail({"--backend", "'" + options.backend + "' is unknown", "Choose auto, cpu or cuda"});
  const int cores = this_machine().cores;
  const bool kept = !options.out.empty();
  options.render = options.render && kept;  // without a folder there is nowhere for a film to go
  if (options.threads == 0) options.threads = std::max(1, options.render ? cores - 1 : cores);
  progress.phase("opening", options.file);
  Result<std::unique_ptr<keep::Replayer>> opened =
      keep::Replayer::open(options.file, {options.threads, *backend, options.gpu});
  if (!opened) return fail(opened.error(), progress);
  keep::Replayer& replayer = *opened.value();

  Stage stage;
  stage.scene = replayer.head().scene;
  stage.machine = this_machine();
  const Result<bool> set = set_stage(options, kept, stage);
  if (!set) return fail(set.error());
  stage.seconds = options.seconds > 0.0 ? options.seconds : std::numeric_limits<double>::infinity();
  Result<std::unique_ptr<ReplayRun>> run =
      ReplayRun::create(replayer, stage, options.render ? options.frames_per_second : 0.0);
  if (!run) return fail(run.error());
  catch_interrupts();
  RunSummary summary;
  const Result<bool> shown = show_headless(stage, *run.value(), options, progress, summary);
  if (!shown) return fail(shown.error());
  summary.threads = options.threads;
  const int code = finish_run(stage, options, progress, summary);
  if (!run.value()->problem().empty()) return fail({"", run.value()->problem(), ""});
  return code != kExitOk || replayer.verdict().same(replayer.head().spacing) ? code : kExitFailed;
}

}  // namespace

void add_replay(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb = app.add_subcommand("replay", "Simulate a recording again, compare it and film it");
  auto o = std::make_shared<ReplayVerbOptions>();
  verb->add_option("FILE", o->file, "What --record wrote")->required();
  add_never_a_window_option(*verb, "No window: a replay has none anyway, its film goes into --out");
  add_out_options(*verb, *o, "Folder for the film, the plot and the tables; without it only compares");
  add_seconds_option(*verb, o->seconds, 0.001, "Simulated seconds from its start (all)");
  add_backend_options(*verb, o->backend, o->gpu,
                      "What to simulate on; auto: where it was recorded, if that is here");
  verb->add_option("--threads", o->threads, "Cores for the simulation (all); the result is the same")
      ->check(CLI::Range(1, 1024));
  add_show_options(*verb, *o, false);
  add_measure_option(*verb, *o);
  add_export_options(*verb, *o);
  verb->footer(kReplayFooter);
  verb->callback([&chosen, o] { chosen = [o] { return replay(*o); }; });
}

}  // namespace slosh
