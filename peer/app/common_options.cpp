#include "peer/app/common_options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "peer/output/export/export_options.h"
#include "peer/output/plot.h"
#include "peer/settings/key_bindings.h"
#include "sim/math/format.h"

namespace slosh {

CLI::Validator in_range(double least, double most) {
  const std::string range = format("%g to %g", least, most);
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0.0;
        const char* end = text.data() + text.size();
        const auto [at, code] = std::from_chars(text.data(), end, value);
        const bool fine = code == std::errc() && at == end && value >= least && value <= most;
        return fine ? std::string() : "'" + text + "' is not a number from " + range;
      },
      "from " + range);
}

CLI::Validator whole_number() {
  return CLI::Validator(
      [](std::string& text) {
        double value = 0.0;
        const char* end = text.data() + text.size();
        const auto [at, code] = std::from_chars(text.data(), end, value);
        if (code != std::errc() || at != end || value != std::floor(value) || std::abs(value) > 1e15)
          return "'" + text + "' is not a whole number, as 20000 or 1e6";
        text = std::to_string(static_cast<long long>(value));
        return std::string();
      },
      "");
}

void add_seconds_option(CLI::App& verb, double& seconds, double least, const std::string& text) {
  verb.add_option("--seconds", seconds, text)->check(in_range(least, 1e6));
}

void add_out_options(CLI::App& verb, ShowOptions& options, const std::string& text) {
  CLI::Option* out = verb.add_option("--out", options.out, text);
  verb.add_flag("--overwrite", options.overwrite, "What an earlier run left in --out may be lost")
      ->needs(out);
}

void add_never_a_window_option(CLI::App& verb, const std::string& text) {
  verb.add_flag("--headless", text);
}

void add_show_options(CLI::App& verb, ShowOptions& options, bool has_window) {
  if (has_window) verb.add_flag("--headless", options.headless, "No window, even with a display");
  verb.add_option("--size", options.size, "Picture in pixels, WxH (1280x720)");
  verb.add_option(
      "--ghost", options.ghost,
      "Show the tools of an earlier run too, translucent, where its hands had them by then, or at that "
      "point\nof the task, whose steps it does as you do: its folder, or its poses.csv");
  verb.add_flag("--stereo", options.stereo,
                "A film in both eyes, side by side, each of that size (a headset's films are so anyway)");
  verb.add_option("--fps", options.frames_per_second, "Pictures a second of the film")
      ->check(in_range(1.0, 240.0))
      ->capture_default_str();
  verb.add_option("--surface", options.surface,
                  "How particles become a fluid's surface: ours, the paper's section 5 as it stands, or ours "
                  "with the\n"
                  "curvature flow of van der Laan 2009")
      ->check(CLI::IsMember({"ours", "paper", "flow"}))
      ->capture_default_str();
  verb.add_option(
          "--quality", options.quality,
          "What is spent on looks: full has softer shadows and the bodies mirrored in the fluid; auto is "
          "fast\n"
          "where a processor draws, else full")
      ->check(CLI::IsMember({"auto", "fast", "full"}))
      ->capture_default_str();
  verb.add_flag(
      "--caustics", options.caustics,
      "Light that the fluid's surface gathers on what lies below it. Asks for --quality full; not with\n"
      "--quality fast or --surface paper");
  verb.add_option("--bilateral", options.bilateral,
                  "Iterations of the paper's filter; 0: particles stay the balls they are, with any surface")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  verb.add_option(
      "--ocio", options.ocio,
      "OpenColorIO configuration that makes the picture of the light ($OCIO; none: the built-in ACES)");
  verb.add_option("--display", options.display, "Display of that configuration, by name (its first)");
  verb.add_option("--view", options.view, "View of that display, by name (its first)");
  verb.add_option("--environment", options.environment,
                  "Room that lights the scene and is mirrored: a Radiance picture (.hdr), or studio (one of "
                  "our own with soft boxes)")
      ->check(CLI::Validator(
          [](std::string& room) {
            std::error_code code;
            const bool there =
                room.empty() || room == "studio" || std::filesystem::is_regular_file(room, code);
            return there ? std::string() : "there is no file '" + room + "'";
          },
          ""));
  verb.add_option(
          "--render-gpu", options.render_gpu,
          "GPU that draws the film, as `nvidia-smi -L` lists them; a window is drawn by its display's")
      ->check(CLI::Range(0, 63));
  verb.add_option("--font-scale", options.font_scale, "Letters of the HUD, times their size")
      ->check(in_range(0.5, 4.0))
      ->capture_default_str();
  if (has_window) {
    verb.add_option(
            "--rows", options.row_rate,
            "Rows a simulated second of poses.csv and wrenches.csv; 1000: one each tick of the device loop")
        ->check(in_range(1.0, 1000.0))
        ->capture_default_str();
    verb.add_flag(
        "--signals", options.signals,
        "Write signals.csv, too: each tick of the device loop with its period, the device's own pose, the "
        "hand's, and the force by stages: coupled, guarded, wanted, sent, rendered");
    verb.add_option(
            "--keys", options.keys,
            "Keys of the window by your choice, ACTION=KEY, with commas between; ACTION=A+B for two keys,\n"
            "ACTION= for none. `slosh settings` lists the actions")
        ->delimiter(',')
        ->check(CLI::Validator(
            [](std::string& word) {
              const Result<KeyChoice> choice = parse_key_choice(word);
              return choice ? std::string() : choice.error().what + ". " + choice.error().mend;
            },
            "ACTION=KEY"));
    verb.add_option("--runs", options.runs,
                    "Folder in which runs get numbered folders where --out is not given")
        ->capture_default_str();
  }
  verb.add_option("--plot", options.plot, "Format of the sheet of forces: png, svg or pdf")
      ->check(CLI::IsMember(plot_formats()))
      ->capture_default_str();
  verb.add_option(
          "--curves", options.curves,
          "What the sheet shows, a panel each, with commas between: force, fx, fy, fz, torque, tx, ty, tz\n"
          "(both magnitudes, and of each the liveliest component)")
      ->delimiter(',')
      ->check(CLI::IsMember(plot_quantities()));
  verb.add_flag("!--no-render", options.render, "No picture at all");
}

void add_guide_option(CLI::App& verb, ShowOptions& options) {
  verb.add_option("--guide", options.guide,
                  "Newtons, at most, that lead a hand to where the ghost's is: a force that never gives more "
                  "energy\nthan it took (of devices that give force)")
      ->check(in_range(0.0, 20.0));
}

void add_headset_options(CLI::App& verb, ShowOptions& options, bool has_hands) {
  CLI::Option* vr = verb.add_flag(
      "--vr", options.vr,
      std::string(
          "In a headset, by OpenXR; beside it a window, where there is a display, shows the left eye") +
          (has_hands ? ".\nIts controllers: --device xr-left --device xr-right" : ""));
  vr->excludes("--no-render");
  verb.add_option("--vr-scale", options.headset.scale, "How many times as large as it is the world looks")
      ->check(in_range(0.1, 10.0))
      ->capture_default_str()
      ->needs(vr);
  verb.add_option("--vr-height", options.headset.height,
                  "Metres above the floor of what hands go to (0.35 m below the eyes)")
      ->check(in_range(0.0, 3.0))
      ->needs(vr);
  verb.add_option("--vr-resolution", options.headset.resolution,
                  "Of the picture size that the headset asks for, a side: less where drawing is slow")
      ->check(in_range(0.1, 2.0))
      ->capture_default_str()
      ->needs(vr);
}

CLI::Option* add_measure_option(CLI::App& verb, ShowOptions& options) {
  return verb
      .add_option(
          "--measure", options.measure,
          "Simulated seconds between rows of bodies.csv and probes.csv, 0 for none (0.01 where the scene has "
          "gauges, regions or measured bodies)")
      ->check(in_range(0.0, 1e3));
}

void add_export_options(CLI::App& verb, ShowOptions& options) {
  CLI::Option* what =
      verb.add_option("--export", options.exports,
                      "Also write frames for other programs, into DIR/frames; again for more:\n"
                      "particles:ply, particles:vtu (ParaView), surface:vdb, surface:ply, surface:glb. "
                      "Metres; .ply and .vdb\n"
                      "z up as Blender, .vtu and .glb y up; with velocity, pressure and which fluid")
          ->allow_extra_args(false)
          ->check(CLI::Validator(
              [](std::string& word) {
                const Result<std::vector<ExportKind>> kinds = parse_exports({word});
                return kinds ? std::string() : kinds.error().what + ". " + kinds.error().mend;
              },
              "WHAT:FORMAT"));
  verb.add_option("--export-rate", options.export_rate, "Of these, frames a simulated second")
      ->check(in_range(0.01, 10000.0))
      ->capture_default_str()
      ->needs(what);
}

void add_backend_options(CLI::App& verb, std::string& backend, int& gpu, const std::string& text) {
  verb.add_option("--backend", backend, text)
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}))
      ->capture_default_str();
  verb.add_option("--sim-gpu", gpu, "GPU that simulates, as `nvidia-smi -L` lists them")
      ->check(CLI::Range(0, 63))
      ->capture_default_str();
}

void add_world_options(CLI::App& verb, PlayOptions& options, const std::string& all_cores) {
  add_backend_options(verb, options.backend, options.gpu, "What the simulation runs on");
  verb.add_option("--spacing", options.spacing,
                  "Metres between particles, or auto: measures the finest in real time (kept once it was)");
  verb.add_option("--particles", options.particles,
                  "Fluid particles to aim at, in place of a spacing: 20000, or 1e6")
      ->transform(whole_number())
      ->check(CLI::Range(1, 20000000))
      ->excludes("--spacing");
  verb.add_option("--threads", options.threads, "Cores for the simulation (" + all_cores + ")")
      ->check(CLI::Range(1, 1024));
  verb.add_flag("--yes", options.agreed, "Do not ask, and do not refuse, when it is going to take long");
}

}  // namespace slosh
