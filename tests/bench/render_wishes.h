// What bench_render is asked for on its command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace slosh::bench {

struct Wishes {
  int width = 640;
  int height = 480;
  int particles = 5000;
  int frames = 30;
  int threads = 1;
  bool batter = false;
  bool juice = false;
  bool mix = false;
  bool hard = false;
  bool no_bodies = false;
  bool basin = false;
  bool caustics = false;
  bool table = false;
  bool text = false;
  bool srgb = false;
  bool paper = false;
  bool full = false;
  bool flow = false;
  bool hud = false;
  bool stereo = false;
  bool on_gpu = false;
  bool bucket = false;
  bool moving = false;
  int detail = 0;
  int warm = 0;
  std::string pixels = "both";
  int reference = 0;
  std::string environment;
  std::string out;
};

/// The command line's options, with their ranges and defaults, into `wishes`, which must outlive `app`.
void say_options(CLI::App& app, Wishes& wishes);

}  // namespace slosh::bench
