// What `slosh host` was asked for.
#pragma once

#include <string>
#include <vector>

#include "peer/app/play_options.h"

namespace slosh {

struct HostVerbOptions : PlayOptions {
  std::string listen;                  ///< ADDR:PORT; empty = every address, port 4433 (or the resumed run's)
  std::vector<std::string> addresses;  ///< ADDR:PORT that links carry in place of this machine's own
  std::vector<std::string> names;      ///< a personal link to hold each
  std::vector<std::string> runners;    ///< a personal link to run the world each
  std::string expires;                 ///< of all links made at the start; empty = never
  std::string links_file;
  bool show_links = false;  ///< whole, also where standard output is no terminal
  std::string record;
  std::string checkpoint;           ///< file, "none", or empty = chosen
  double checkpoint_seconds = 0.5;  ///< wall s between two checkpoints
  std::string resume;
  std::size_t watchers = 150;
  bool lock_parameters = false;
  int wait = 1;  ///< grips that must be held before the world starts
  bool supervised = true;
  int restarts = 0;  ///< times that its supervisor has started it again
};

/// The verb from its options to its exit code.
int host_world(const HostVerbOptions& options);

}  // namespace slosh
