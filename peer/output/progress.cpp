#include "peer/output/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "net/clock.h"
#include "net/text/clean.h"

namespace slosh {
namespace {

bool good_terminal() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) && term != nullptr && std::string_view(term) != "dumb";
}

std::size_t terminal_width() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 10) return size.ws_col;
  return 80;
}

/// The last `most` columns of UTF-8 text.
std::string tail(const std::string& text, std::size_t most) {
  const std::size_t all = columns(text);
  if (all <= most) return text;
  std::size_t at = 0;
  for (std::size_t seen = 0; at < text.size(); ++at) {
    if (begins_character(text[at]) && seen++ == all - most) break;
  }
  return text.substr(at);
}

/// The first `most` columns of UTF-8 text.
std::string cut(const std::string& text, std::size_t most) {
  std::size_t seen = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (begins_character(text[i]) && ++seen > most) return text.substr(0, i);
  }
  return text;
}

/// What is shown may have come from anywhere, a host's words or something pasted: a terminal obeys none of
/// it.
std::string fit(const std::string& text) {
  constexpr std::size_t kMax = 100'000;
  return clean_lines(text, kMax);
}

}  // namespace

std::size_t columns(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return begins_character(c); }));
}

Progress::Progress() : Progress(good_terminal(), 2.0) {}

Progress::Progress(bool terminal, double seconds_between_lines)
    : terminal_(terminal), between_ns_(to_nanoseconds(seconds_between_lines)) {}

Progress::~Progress() {
  end_line();
}

void Progress::end_line() {
  if (line_open_) std::fputc('\n', stderr);
  line_open_ = line_moves_ = false;
}

void Progress::clear_line() {
  if (line_open_) std::fputs("\r\033[K", stderr);
  line_open_ = line_moves_ = false;
}

/// What stands on the last line of the terminal.
void Progress::show() {
  constexpr char kPrompt[] = "> ";
  const std::string line = typed_.empty() ? cut(status_, terminal_width() - 1)
                                          : kPrompt + tail(fit(typed_), terminal_width() - sizeof kPrompt);
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
  line_open_ = line_moves_ = true;
}

void Progress::typed(const std::string& text) {
  if (!terminal_ || text == typed_) return;
  typed_ = text;
  show();
}

void Progress::answer(const std::string& line, const std::string& text) {
  clear_line();
  typed_.clear();
  if (!line.empty()) std::fprintf(stderr, "> %s\n", fit(line).c_str());
  std::fflush(stderr);
  if (!text.empty()) std::printf("%s\n", fit(text).c_str());
  std::fflush(stdout);
}

void Progress::phase(const std::string& name, const std::string& detail) {
  end_line();
  phase_ = name;
  status_ = name;
  const std::string line = fit(detail.empty() ? name : name + " " + detail);
  if (terminal_) {
    std::fprintf(stderr, "%s …", line.c_str());
    line_open_ = true;
  } else {
    std::fprintf(stderr, "%s\n", line.c_str());
  }
  std::fflush(stderr);
  last_line_ns_ = steady_now_ns();
}

void Progress::update(double fraction, const std::string& text) {
  const std::int64_t now_ns = steady_now_ns();
  if (!terminal_ && now_ns - last_line_ns_ < between_ns_) return;
  char percent[16] = "";
  if (fraction >= 0.0) std::snprintf(percent, sizeof percent, " %3.0f %%", 100.0 * std::min(fraction, 1.0));
  const std::string line = phase_ + percent + "  " + fit(text);
  if (terminal_) {
    status_ = line;
    if (typed_.empty()) show();
    return;
  }
  last_line_ns_ = now_ns;
  if (line == status_) return;  // in a log it would say nothing new
  status_ = line;
  std::fprintf(stderr, "%s\n", line.c_str());
  std::fflush(stderr);
}

void Progress::note(const std::string& text) {
  // What is kept up to date is shown again below; the name of a phase stays.
  if (line_moves_)
    clear_line();
  else
    end_line();
  std::fprintf(stderr, "%s\n", fit(text).c_str());
  std::fflush(stderr);
  if (!typed_.empty()) show();
}

}  // namespace slosh
