// Every command that may be typed at a host, at a peer or at a world of one's own: one table, for all
// consoles and their help.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh {

enum class ConsoleVerb : std::uint8_t {
  kNothing,  ///< an empty line
  kHelp,
  kWho,
  kLinks,
  kLink,
  kRevoke,
  kExpire,
  kRole,
  kTake,
  kRelease,
  kKick,
  kUnban,
  kPause,
  kContinue,
  kReset,
  kSet,
  kBring,
  kRemove,
  kStatus,
  kLog,
  kQuit,
};

enum class Console : std::uint8_t {
  kHost,
  kPeer,
  kWatch,  ///< who looks on: a peer's commands but for what the host refuses them
  kPlay,   ///< a world in this process, with nobody else in it
};

/// Which command the words are: the first one's, once there are as many words after it as it takes. What
/// these say is the console's to find out. Errors: no command of this console, or too few or many words.
Result<ConsoleVerb> console_verb(Console console, const std::vector<std::string>& words);

/// What `help` prints: a line a command, without a line feed at the end.
std::string console_help(Console console);

}  // namespace slosh
