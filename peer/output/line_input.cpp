#include "peer/output/line_input.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <thread>
#include <utility>

#include "peer/output/progress.h"

namespace slosh {
namespace {

bool in_foreground() {
  return tcgetpgrp(STDIN_FILENO) == getpgrp();
}

}  // namespace

void LineEditor::feed(std::string_view bytes) {
  for (const char c : bytes) key(c);
}

void LineEditor::key(char c) {
  constexpr char kBackspace = '\b', kDelete = '\x7f', kEscape = '\x1b', kCtrlU = '\x15', kCtrlW = '\x17';
  // ESC x, or ESC [ numbers letter.
  if (escape_ == Escape::kBegun) {
    escape_ = c == '[' || c == 'O' ? Escape::kSequence : Escape::kNone;
    return;
  }
  if (escape_ == Escape::kSequence) {
    if (c >= '@' && c <= '~') escape_ = Escape::kNone;
    return;
  }
  if (c == kEscape) {
    escape_ = Escape::kBegun;
  } else if (c == '\n' || c == '\r') {
    lines_.push_back(std::exchange(text_, {}));
  } else if (c == kBackspace || c == kDelete) {
    while (!text_.empty() && !begins_character(text_.back())) text_.pop_back();
    if (!text_.empty()) text_.pop_back();
  } else if (c == kCtrlU) {
    text_.clear();
  } else if (c == kCtrlW) {
    while (!text_.empty() && text_.back() == ' ') text_.pop_back();
    while (!text_.empty() && text_.back() != ' ') text_.pop_back();
  } else if (text_.size() < kMaxConsoleLine && (static_cast<unsigned char>(c) >= ' ' || c == '\t')) {
    text_ += c == '\t' ? ' ' : c;
  }
}

std::vector<std::string> LineEditor::take_lines() {
  return std::exchange(lines_, {});
}

LineInput::LineInput(bool shares_terminal)
    : wants_terminal_(shares_terminal && isatty(STDIN_FILENO) != 0 &&
                      tcgetattr(STDIN_FILENO, &before_) == 0) {
  take_terminal();
}

// Also after the program was stopped and brought back: shells set a terminal as they like it meanwhile.
void LineInput::take_terminal() {
  termios now{};
  if (!wants_terminal_ || !in_foreground() || tcgetattr(STDIN_FILENO, &now) != 0) return;
  const tcflag_t off = ICANON | ECHO;  // Ctrl-C and Ctrl-Z go on to be signals
  if (edits_ && (now.c_lflag & off) == 0) return;
  now.c_lflag &= ~off;
  now.c_cc[VMIN] = 1;
  now.c_cc[VTIME] = 0;
  edits_ = tcsetattr(STDIN_FILENO, TCSANOW, &now) == 0;
}

LineInput::~LineInput() {
  if (edits_ && in_foreground()) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

int LineInput::fd() const {
  if (over_ || (isatty(STDIN_FILENO) != 0 && !in_foreground())) return -1;
  return STDIN_FILENO;
}

void LineInput::wait(std::chrono::milliseconds patience) const {
  pollfd waiting{fd(), POLLIN, 0};
  if (waiting.fd < 0)
    std::this_thread::sleep_for(patience);
  else
    (void)poll(&waiting, 1, static_cast<int>(patience.count()));
}

std::vector<std::string> LineInput::read() {
  take_terminal();
  while (fd() >= 0) {
    pollfd waiting{STDIN_FILENO, POLLIN, 0};
    if (poll(&waiting, 1, 0) <= 0) break;
    char buffer[512];
    const ssize_t got = ::read(STDIN_FILENO, buffer, sizeof buffer);
    if (got <= 0) {
      over_ = got == 0 || (errno != EAGAIN && errno != EINTR);
      break;
    }
    const std::string_view bytes(buffer, static_cast<std::size_t>(got));
    if (edits_)
      editor_.feed(bytes);
    else
      partial_ += bytes;
  }
  std::vector<std::string> lines = editor_.take_lines();
  for (std::size_t end = partial_.find('\n'); end != std::string::npos; end = partial_.find('\n')) {
    lines.push_back(partial_.substr(0, end));
    partial_.erase(0, end + 1);
  }
  if (partial_.size() > kMaxConsoleLine) partial_.clear();
  return lines;
}

}  // namespace slosh
