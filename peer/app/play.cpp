// The verb `play`: its options, and the choice between a window and a film.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "net/console_verbs.h"
#include "peer/app/common_options.h"
#include "peer/app/find_headset.h"
#include "peer/app/interrupt.h"
#include "peer/app/local_run.h"
#include "peer/app/play_modes.h"
#include "peer/app/verbs.h"
#include "render/context.h"

namespace slosh {
namespace {

constexpr const char* kPlayFooter =
    R"(Without a display, or with --headless, the run becomes a film. DIR gets
  wrenches.csv   time_s,device,fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm: simulated time, device from 0, and the
                 wrench on the hand (what is felt: a held weight is negative fy), torque about the
                 handle, world axes, y up
  poses.csv      where the handles were; --device replay:FILE plays it again
  bodies.csv, probes.csv   what the scene's instruments read, see --measure
  wrenches.png   forces above, torques below, one colour a device; --plot svg or pdf for a paper
  frames/        what --export asks for, numbered by time
  view.mp4, final.png, summary.json

In the window the mouse takes over what scripts hold: drag a thing (with all its hands) or one handle, the
wheel tilts and pours, Ctrl tilts any way, Shift goes over the table; B gives the hands back. Elsewhere
left drag turns the camera, the wheel zooms. Space pauses, N takes one step, Down and Up slow motion,
Tab sliders, P keeps the picture, R starts again, H shows all keys, Esc ends. Ctrl-C ends a run in
order, with everything written (exit code 130).

While it runs, type in the terminal, or through a pipe:
)";

constexpr const char* kExamples =
    "\n\n"
    "Examples:\n"
    "  slosh play\n"
    "  slosh play pour --seconds 5 --out out/pour --headless\n"
    "  slosh play bucket --device script --device mouse\n"
    "  slosh play bucket --vr --device xr-left --device xr-right\n"
    "  slosh play my_scene.glb --spacing 0.008 --threads 4\n"
    "  slosh play pool --particles 1e6 --headless --sim-gpu 0 --render-gpu 1\n"
    "  slosh play bucket --headless --device replay:out/bucket/poses.csv";

/// Before the run, which would be played for nothing.
std::optional<Error> no_score(const PlayOptions& options, const Scene& scene) {
  if (options.score.empty()) return std::nullopt;
  if (scene.task.empty())
    return Error{"--score", "the scene '" + scene.name + "' has no guided task to score",
                 "Leave it out, or play one that has (crepe, pour); scenes/TASKS.md tells how to make one"};
  std::error_code unknown;
  if (!std::filesystem::exists(options.score, unknown)) return std::nullopt;
  const Result<std::vector<Score>> there = read_scores(options.score);
  return there ? std::nullopt : std::optional<Error>(there.error());
}

int play(PlayOptions options) {
  end_at_interrupts();
  Progress progress;
  const std::unique_ptr<HeadsetView> headset = find_headset(options, progress);
  if (headset) options.controllers = headset->link();
  const bool headless = is_film(options, headset != nullptr, progress);
  if (const std::optional<Error> missing = no_film(options, headless)) return fail(*missing, progress);
  Result<Prepared> prepared = prepare(options, headless, progress);
  if (!prepared) return fail(prepared.error(), progress);
  const Prepared& p = prepared.value();
  if (const std::optional<Error> problem = no_score(options, p.scene)) return fail(*problem, progress);
  const MakeRun make_run = [&]() -> Result<std::unique_ptr<LiveRun>> {
    Result<DeviceSet> devices = make_devices(p.scene, options.devices, !headless, options.controllers);
    if (!devices) return devices.error();
    if (headless) progress.phase(p.scene.settle > 0.0 ? "settling" : "starting");
    const double film_rate = options.render ? options.frames_per_second : 0.0;
    auto run =
        LocalRun::create(p, std::move(devices.value()), headless ? film_rate : kWindowSnapshotRate, progress);
    if (run) catch_interrupts();
    return run;
  };
  return show_run(p, make_run, options, headless, headset.get(), progress);
}

}  // namespace

void add_play(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb = app.add_subcommand("play", "Play a scene: feel it, see it, record it");
  auto o = std::make_shared<PlayOptions>();
  verb->add_option("SCENE", o->scene, "A shipped scene's name, or a .gltf or .glb file")
      ->capture_default_str();
  add_seconds_option(*verb, o->seconds, 0.01,
                     "Simulated seconds (the scene's duration; a window: until closed)");
  add_out_options(
      *verb, *o,
      "Folder for the results (headless: out/<scene>, or out/<scene>-2 and so on; a window: none)");
  add_show_options(*verb, *o, true);
  add_headset_options(*verb, *o);
  add_world_options(*verb, *o, "all but one; all with --no-render");
  verb->add_option("--device", o->devices,
                   "script, mouse, xr-left, xr-right, replay:FILE, spacemouse, gamepad, falcon, plugin:FILE "
                   "or operator; "
                   "one for all handles, or one "
                   "each; `slosh devices` lists what is there")
      ->allow_extra_args(false);
  add_guide_option(*verb, *o);
  verb->add_option(
      "--score", o->score,
      "Add a row to this table (CSV) at the end: what the run of the scene's guided task came to, "
      "told\nbeside the last runs; `slosh report task` draws it");
  verb->add_option("--record", o->record, "Keep the run's inputs and states in a file, for `slosh replay`");
  verb->add_flag("--unpaced", o->unpaced,
                 "As fast as the machine goes, bitwise identical each time; headless, for measuring");
  verb->add_option(
          "--step-rate", o->step_rate,
          "Steps a simulated second in which hands and world meet, each of as many of the scene's own as it\n"
          "takes: to feel what a slower host is like. A recording keeps the scene's own steps alone, and\n"
          "--unpaced has no loop of the hands that is faster")
      ->check(in_range(10.0, 10000.0))
      ->excludes("--record")
      ->excludes("--unpaced");
  add_measure_option(*verb, *o);
  add_export_options(*verb, *o);
  verb->footer(kPlayFooter + console_help(Console::kPlay) + kExamples);
  verb->callback([&chosen, o] { chosen = [o] { return play(*o); }; });
}

}  // namespace slosh
