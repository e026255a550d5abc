// Where the program keeps what it learned from run to run.
#pragma once

#include <cstdlib>
#include <string>

namespace slosh {

/// $XDG_STATE_HOME/slosh, else ~/.local/state/slosh; empty where neither is known. May not exist yet.
inline std::string state_folder() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  if (state && *state == '/') return std::string(state) + "/slosh";
  const char* const home = std::getenv("HOME");
  return home && *home == '/' ? std::string(home) + "/.local/state/slosh" : std::string();
}

}  // namespace slosh
