#include "net/console_verbs.h"

#include <algorithm>

#include "net/text/nearest.h"
#include "net/wire/text.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr unsigned kAtHost = 1, kAtPeer = 2, kAtPlay = 4, kAtWatch = 8;
constexpr unsigned kAtPeers = kAtPeer | kAtWatch, kAtBoth = kAtHost | kAtPeer, kAtAll = kAtBoth | kAtPlay;
constexpr std::size_t kAny = 1000;  // words: the command's own rules say more
constexpr std::size_t kHelpColumn = 34;

struct Command {
  ConsoleVerb verb;
  const char* word;
  unsigned where;
  std::size_t least, most;  // words after the first
  const char* needs;        // what to say where there are fewer or more; null = it stands alone
  const char* form;         // in the help; null = it stands in another command's line
  const char* does;
};

constexpr Command kCommands[] = {
    {ConsoleVerb::kHelp, "help", kAtAll | kAtWatch, 0, 0, nullptr, nullptr, nullptr},
    {ConsoleVerb::kWho, "who", kAtBoth | kAtWatch, 0, 0, nullptr, "who", "who is here and holds what"},
    {ConsoleVerb::kLinks, "links", kAtHost, 0, 0, nullptr, "links",
     "every link: id, for whom, until when, used by"},
    {ConsoleVerb::kLink, "link", kAtHost, 0, kAny, nullptr, "link [NAME] [watch|run] [for 30m]",
     "a new link, to hold, to watch, or to run the world too"},
    {ConsoleVerb::kRevoke, "revoke", kAtHost, 1, 1, "needs the id of a link, as `links` shows it",
     "revoke ID", "end a link and whoever came in by it"},
    {ConsoleVerb::kExpire, "expire", kAtHost, 0, kAny, nullptr, "expire ID 10m|never",
     "from then on it admits nobody new; who is in stays in"},
    {ConsoleVerb::kRole, "role", kAtHost, 0, kAny, nullptr, "role ID hold|run",
     "whether those who come by a link may run the world"},
    {ConsoleVerb::kTake, "take", kAtPeer, 0, 1, "needs one grip or none", "take [GRIP]",
     "take hold of a grip, or of the first free one"},
    {ConsoleVerb::kRelease, "release", kAtHost, 1, 1, "needs a grip's name or number", "release GRIP",
     "take a grip away from its holder"},
    {ConsoleVerb::kRelease, "release", kAtPeer, 0, 1, "needs one grip or none", "release [GRIP]",
     "let go of a grip, or of all that you hold"},
    {ConsoleVerb::kKick, "kick", kAtHost, 0, kAny, nullptr, "kick NAME [for 10m]",
     "close somebody's connection, and keep their key out for a time"},
    {ConsoleVerb::kUnban, "unban", kAtHost, 1, 1, "needs a person's name, as `who` shows it", "unban NAME",
     "let somebody in again before that time is over"},
    {ConsoleVerb::kPause, "pause", kAtHost | kAtPlay, 0, 0, nullptr, "pause, continue, reset", "the world"},
    {ConsoleVerb::kPause, "pause", kAtPeer, 0, 0, nullptr, "pause, continue, reset",
     "the world, for everybody; this, viscosity and gravity by a link to run it"},
    {ConsoleVerb::kContinue, "continue", kAtAll, 0, 0, nullptr, nullptr, nullptr},
    {ConsoleVerb::kReset, "reset", kAtAll, 0, 0, nullptr, nullptr, nullptr},
    {ConsoleVerb::kSet, "set", kAtAll, 0, kAny, nullptr, "set viscosity [FLUID] X",
     "Pa·s, while the world runs"},
    {ConsoleVerb::kSet, "set", kAtAll, 0, kAny, nullptr, "set gravity X", "times the scene's, 0 to 2"},
    {ConsoleVerb::kSet, "set", kAtHost | kAtPlay, 0, kAny, nullptr, "set stiffness [GRIP] X",
     "of the hold on it: times the scene's, 0.05 to 4"},
    {ConsoleVerb::kSet, "set", kAtPeer, 0, kAny, nullptr, "set stiffness [GRIP] X",
     "of your hold on it: times the scene's, 0.05 to 4"},
    {ConsoleVerb::kBring, "bring", kAtHost | kAtPlay, 1, 1, "needs the name of a body or fluid", "bring NAME",
     "a body that is away appears, a fluid is filled up"},
    {ConsoleVerb::kRemove, "remove", kAtHost | kAtPlay, 1, 1, "needs the name of a body or fluid",
     "remove NAME", "a body or a fluid leaves the world"},
    {ConsoleVerb::kStatus, "status", kAtHost, 0, 0, nullptr, "status", "how the world and the links do"},
    {ConsoleVerb::kLog, "log", kAtHost, 0, 0, nullptr, "log", "who did what lately, and when"},
    {ConsoleVerb::kStatus, "status", kAtPeers, 0, 0, nullptr, "status", "how the network and the world do"},
    {ConsoleVerb::kStatus, "status", kAtPlay, 0, 0, nullptr, "status", "how the world does"},
    {ConsoleVerb::kQuit, "quit", kAtPlay, 0, 0, nullptr, "quit", "end the run"},
    {ConsoleVerb::kQuit, "quit", kAtHost, 0, 0, nullptr, "quit", "end the run for everybody"},
    {ConsoleVerb::kQuit, "quit", kAtPeers, 0, 0, nullptr, "quit", "leave"},
};

bool is_at(const Command& command, Console console) {
  switch (console) {
    case Console::kHost:
      return (command.where & kAtHost) != 0;
    case Console::kPeer:
      return (command.where & kAtPeer) != 0;
    case Console::kWatch:
      return (command.where & kAtWatch) != 0;
    case Console::kPlay:
      return (command.where & kAtPlay) != 0;
  }
  return false;
}

}  // namespace

Result<ConsoleVerb> console_verb(Console console, const std::vector<std::string>& words) {
  constexpr char kHelp[] = "Type help for what may be said";
  if (words.empty()) return ConsoleVerb::kNothing;
  for (const Command& command : kCommands) {
    if (!is_at(command, console) || words[0] != command.word) continue;
    const std::size_t more = words.size() - 1;
    if (more >= command.least && more <= command.most) return command.verb;
    if (command.needs == nullptr) return Error{"", words[0] + " stands alone", kHelp};
    return Error{"", words[0] + " " + command.needs, "Put a name of several words in quotes"};
  }
  std::vector<std::string> known;
  for (const Command& command : kCommands)
    if (is_at(command, console)) known.emplace_back(command.word);
  return Error{"", format("'%s' means nothing here", wire::clean_text(words[0], 40).c_str()),
               did_you_mean(words[0], known) + kHelp};
}

std::string console_help(Console console) {
  std::string help;
  for (const Command& command : kCommands) {
    if (!is_at(command, console) || command.form == nullptr) continue;
    std::string line = command.form;
    line.append(std::max(line.size() + 1, kHelpColumn) - line.size(), ' ');
    help += (help.empty() ? "" : "\n") + line + command.does;
  }
  return help;
}

}  // namespace slosh
