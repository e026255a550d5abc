#include "peer/remote/link_source.h"

#include <poll.h>
#include <signal.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>

#include "net/link.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxFile = 256 * kMaxLinkText;  // bytes: a host has at most 256 links
constexpr int kMorePasted = 100;                      // ms in which the next line of something pasted comes

volatile sig_atomic_t signalled = 0;

extern "C" void note_signal_at_prompt(int signal_number) {
  signalled = signal_number;
}

/// A terminal that shows nothing of what is typed. A signal ends the reading, and acts when the terminal is
/// as it was.
class Unseen {
 public:
  Unseen() {
    signalled = 0;
    struct sigaction action{};
    action.sa_handler = note_signal_at_prompt;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &actions_[i]);
    if (tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios now = before_;
    now.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    changed_ = tcsetattr(STDIN_FILENO, TCSANOW, &now) == 0;
  }
  ~Unseen() {
    if (changed_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
    std::fputc('\n', stderr);
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &actions_[i], nullptr);
    if (signalled != 0) raise(signalled);
  }
  Unseen(const Unseen&) = delete;
  Unseen& operator=(const Unseen&) = delete;

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGQUIT};
  std::array<struct sigaction, kSignals.size()> actions_{};
  termios before_{};
  bool changed_ = false;
};

/// Byte by byte: what follows the line is for whoever reads standard input next. False at the end of it.
bool read_line(std::string& line) {
  char c = 0;
  while (line.size() <= kMaxLinkText && signalled == 0) {
    const ssize_t got = read(STDIN_FILENO, &c, 1);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    if (c == '\n' && !line.empty()) return true;
    if (c != '\n') line.push_back(c);
  }
  return false;
}

/// Mail breaks links, and a terminal gives what is pasted line by line.
std::string from_terminal() {
  const Unseen unseen;
  std::fputs("Paste or type the link that the host printed (it is not shown here): ", stderr);
  std::string text;
  bool more = read_line(text);
  while (more && text.size() <= kMaxLinkText && !parse_link(text)) {
    pollfd waiting{STDIN_FILENO, POLLIN, 0};
    if (poll(&waiting, 1, kMorePasted) <= 0) break;
    std::string line;
    more = read_line(line);
    text += "\n" + line;
  }
  return text;
}

Result<std::string> from_standard_input() {
  const bool terminal = isatty(STDIN_FILENO) != 0;
  signalled = 0;
  std::string line;
  if (terminal)
    line = from_terminal();
  else
    read_line(line);
  if (line.empty())
    return Error{"link", terminal ? "none was typed" : "standard input gave none",
                 "Give it at the prompt of `slosh join`, or by --link-file FILE, or: slosh join < FILE"};
  return line;
}

struct LinkLine {
  std::string role, link, name;
};

std::optional<LinkLine> parse_line(const std::string& line) {
  const std::size_t first = line.find(' ');
  LinkLine parsed{line.substr(0, first), {}, {}};
  if (first == std::string::npos || (parsed.role != "hold" && parsed.role != "run" && parsed.role != "watch"))
    return std::nullopt;
  const std::size_t second = line.find(' ', first + 1);
  parsed.link = line.substr(first + 1, second == std::string::npos ? second : second - first - 1);
  if (second != std::string::npos) parsed.name = line.substr(second + 1);
  return parsed;
}

Result<std::string> from_file(const std::string& file_name, wire::Role role, const std::string& name) {
  std::ifstream file(file_name, std::ios::binary);
  if (!file) return Error{file_name, std::strerror(errno), "Give the file that holds the link"};
  std::string text;
  std::array<char, 4096> buffer{};
  while (file.read(buffer.data(), buffer.size()) || file.gcount() > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > kMaxFile)
      return Error{file_name, "is too large to be a link", "Give the file that holds the link"};
  }
  const bool holds = role == wire::Role::kParticipant;
  bool listed = false;
  std::string best;
  int best_rank = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::optional<LinkLine> one = parse_line(line);
    listed = listed || one;
    if (!one || (one->role == "watch") == holds) continue;
    const int rank = !name.empty() && one->name == name ? 4
                     : !one->name.empty()               ? 1
                     : one->role == "run"               ? 2
                                                        : 3;
    if (rank <= best_rank) continue;
    best_rank = rank;
    best = one->link;
  }
  if (best_rank > 0) return best;
  if (listed)
    return Error{file_name, holds ? "has no link to hold" : "has no link to watch",
                 holds ? "Use `slosh watch`" : "Use `slosh join`"};
  return text;
}

}  // namespace

Result<std::string> read_link_text(const std::string& given, const std::string& file, wire::Role role,
                                   const std::string& name) {
  if (!given.empty() && !file.empty())
    return Error{"link", "there are two", "Give one: at the prompt, by --link-file FILE, or as LINK"};
  if (!file.empty()) return from_file(file, role, name);
  if (given.empty() || given == "-") return from_standard_input();
  if (given.starts_with('@')) return from_file(given.substr(1), role, name);
  return given;
}

void hide_links(int count, char** words) {
  constexpr std::string_view kScheme = "slosh://";
  for (int i = 0; i < count; ++i) {
    char* const end = words[i] + std::strlen(words[i]);
    char* const scheme = std::search(words[i], end, kScheme.begin(), kScheme.end(), [](char a, char b) {
      return (a >= 'A' && a <= 'Z' ? a + ('a' - 'A') : a) == b;
    });
    if (scheme != end) std::fill(scheme + kScheme.size(), end, '*');
  }
}

}  // namespace slosh
