// What `slosh play` was asked for.
#pragma once

#include <string>
#include <vector>

namespace slosh {

struct PlayOptions {
  std::string scene = "bucket";
  double seconds = 0.0;  ///< simulated; 0 = the scene's duration (a window: until closed)
  std::string out;       ///< folder; empty = out/<scene> when headless, nothing with a window
  bool headless = false;
  std::string backend = "auto";      ///< auto, cpu, cuda
  std::vector<std::string> devices;  ///< none, one for all, or one a grip
  std::string spacing;               ///< "", "auto" or metres
  std::size_t particles = 0;         ///< 0 = not asked for
  int threads = 0;                   ///< 0 = chosen
  std::string size;                  ///< "WxH"; empty = chosen
  double frames_per_second = 30.0;
  int bilateral = 4;
  bool render = true;
};

}  // namespace slosh
