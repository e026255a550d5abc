#include "peer/verbs/link_source.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

#include "net/link.h"

namespace slosh {
namespace {

constexpr std::size_t kMostFile = 256 * kMaxLinkText;  // bytes: a host has at most 256 links

// Byte by byte: what follows the line is for whoever reads standard input next.
Result<std::string> from_standard_input() {
  if (isatty(STDIN_FILENO)) std::fprintf(stderr, "link: ");
  std::string line;
  char c = 0;
  ssize_t got = 0;
  while (line.size() <= kMaxLinkText) {
    got = read(STDIN_FILENO, &c, 1);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0 || (c == '\n' && !line.empty())) break;
    if (c != '\n') line.push_back(c);
  }
  if (line.empty())
    return Error{"link", "standard input gave none", "As in: slosh join - < FILE, or: … | slosh join -"};
  return line;
}

Result<std::string> from_file(const std::string& name, wire::Role role) {
  std::ifstream file(name, std::ios::binary);
  if (!file) return Error{name, std::strerror(errno), "Give the file that holds the link"};
  std::string text;
  std::array<char, 4096> buffer{};
  while (file.read(buffer.data(), buffer.size()) || file.gcount() > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > kMostFile)
      return Error{name, "is too large to be a link", "Give the file that holds the link"};
  }
  const std::string wanted = role == wire::Role::kParticipant ? "hold " : "watch ";
  bool listed = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    // Behind the link stands whom it is for.
    if (line.starts_with(wanted))
      return line.substr(wanted.size(), line.find(' ', wanted.size()) - wanted.size());
    listed = listed || line.starts_with("hold ") || line.starts_with("watch ");
  }
  if (listed)
    return Error{name, "has no link to " + wanted.substr(0, wanted.size() - 1),
                 role == wire::Role::kParticipant ? "Use `slosh watch`" : "Use `slosh join`"};
  return text;
}

}  // namespace

Result<std::string> read_link_text(const std::string& given, const std::string& file, wire::Role role) {
  if (given.empty() == file.empty()) {
    return Error{"link", given.empty() ? "there is none" : "there are two",
                 "Give LINK, or - for one line of standard input, or @FILE, or --link-file FILE"};
  }
  if (!file.empty()) return from_file(file, role);
  if (given == "-") return from_standard_input();
  if (given.starts_with('@')) return from_file(given.substr(1), role);
  return given;
}

}  // namespace slosh
