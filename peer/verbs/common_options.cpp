#include "peer/verbs/common_options.h"

#include <CLI/CLI.hpp>

namespace slosh {

void add_show_options(CLI::App& verb, ShowOptions& options, bool has_window) {
  if (has_window) verb.add_flag("--headless", options.headless, "No window, even with a display");
  verb.add_option("--size", options.size,
                  has_window ? "Picture in pixels, WxH (640x480 headless, 1280x720 in a window)"
                             : "Picture in pixels, WxH (640x480)");
  verb.add_option("--fps", options.frames_per_second, "Pictures a second of the film")
      ->check(CLI::Range(1.0, 240.0))
      ->capture_default_str();
  verb.add_option("--bilateral", options.bilateral, "Iterations of the fluid surface's filter")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  verb.add_flag("!--no-render", options.render, "No picture at all");
}

void add_backend_option(CLI::App& verb, std::string& backend, const std::string& text) {
  verb.add_option("--backend", backend, text)
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}))
      ->capture_default_str();
}

void add_world_options(CLI::App& verb, PlayOptions& options, const std::string& all_cores) {
  add_backend_option(verb, options.backend, "What the simulation runs on");
  verb.add_option("--spacing", options.spacing, "Metres between particles, or auto: the finest in real time");
  verb.add_option("--particles", options.particles, "Fluid particles to aim at, in place of a spacing")
      ->check(CLI::Range(1, 100000000))
      ->excludes("--spacing");
  verb.add_option("--threads", options.threads, "Cores for the simulation (" + all_cores + ")")
      ->check(CLI::Range(1, 1024));
}

}  // namespace slosh
