// What `slosh play` and its kin were asked for.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "peer/view/headset_view.h"

namespace slosh {

/// How a run is shown and written, wherever its world is.
struct ShowOptions {
  double seconds = 0.0;     ///< simulated; 0 = chosen
  std::string out;          ///< folder; empty = default_out when headless, nothing with a window
  std::string default_out;  ///< folder in `runs`, numbered where it is taken; empty = <scene>
  std::string runs = "out";
  bool overwrite = false;  ///< an earlier run in `out` may be lost
  bool headless = false;
  std::vector<std::string> devices;  ///< none, one for all, or one a grip
  std::string size;                  ///< "WxH"; empty = chosen
  bool stereo = false;               ///< a film without a display has both eyes
  double frames_per_second = 30.0;
  int bilateral = 4;
  std::string surface = "ours";   ///< how particles become a surface: ours, paper, flow
  std::string quality = "auto";   ///< of looks: auto, fast, full
  bool caustics = false;          ///< at full quality
  std::string ocio;               ///< file of an OpenColorIO configuration; empty = $OCIO; "none" = ours
  std::string display;            ///< of that configuration, by name; empty = its first
  std::string view;               ///< of that display, by name; empty = its first
  std::string environment;        ///< a Radiance picture of a room, or "studio"; empty = the formula's room
  std::vector<std::string> keys;  ///< of the window: "ACTION=KEY" (KeyBindings::make)
  double font_scale = 1.0;        ///< of the HUD's letters
  bool render = true;
  int render_gpu = -1;  ///< that draws without a window; -1 = any
  bool vr = false;      ///< a headset is asked for
  HeadsetWish headset;
  std::shared_ptr<HeadsetLink> controllers;  ///< of the headset that was found; null without one
  std::string ghost;                         ///< folder or poses.csv of an earlier run; empty = none
  double guide = 0.0;                        ///< N, the most that leads a hand to where the ghost's is
  std::string score;                         ///< table that a run of a task adds a row to; empty = none
  std::string plot = "png";                  ///< of plot_formats()
  std::vector<std::string> curves;           ///< of plot_quantities(); empty = chosen
  double measure =
      -1.0;  ///< simulated s between rows of the instruments; 0 = none, below 0 = as the scene asks
  std::vector<std::string> exports;  ///< of kExportNames
  double export_rate = 30.0;         ///< frames a simulated second
  double row_rate = 500.0;           ///< of hands' files, rows a simulated second
  bool signals = false;              ///< signals.csv, too
};

struct PlayOptions : ShowOptions {
  std::string scene = "bucket";
  std::string backend = "auto";  ///< auto, cpu, cuda
  int gpu = 0;                   ///< that simulates
  std::string spacing;           ///< "", "auto" or metres
  std::size_t particles = 0;     ///< 0 = not asked for
  int threads = 0;               ///< 0 = chosen
  std::string record;            ///< file for a recording; empty = none
  bool agreed = false;           ///< --yes: a run may take as long as it takes
  double step_rate = 0.0;  ///< steps a simulated s that hands meet, of as many of the plan's; 0 = the plan's
  bool unpaced = false;    ///< as fast as it goes, bitwise identical each time
};

}  // namespace slosh
