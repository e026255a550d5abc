// What this program runs on, for the summary.
#pragma once

#include <string>

namespace slosh {

struct Machine {
  std::string cpu;     ///< model name
  int cores = 1;       ///< that this process may use
  std::string system;  ///< e.g. "Debian GNU/Linux 12 (bookworm)"
};

Machine this_machine();

}  // namespace slosh
