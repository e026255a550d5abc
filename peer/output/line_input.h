// Lines that a person types at a running program, beside a status line that is kept up to date.
#pragma once

#include <termios.h>

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "net/console_words.h"

namespace slosh {

/// Keys to lines: what a terminal's own line editing does, for who switched that off. What is typed beyond
/// kMaxConsoleLine bytes is left out. Pure.
class LineEditor {
 public:
  /// Bytes as they come from the keyboard. Backspace takes away a character, Ctrl-U the line, Ctrl-W a word;
  /// arrows and other keys do nothing.
  void feed(std::string_view bytes);
  /// Complete lines since the last call, without their line feed.
  std::vector<std::string> take_lines();
  /// What is typed so far of the next one.
  const std::string& text() const { return text_; }

 private:
  void key(char c);
  enum class Escape { kNone, kBegun, kSequence };
  std::string text_;
  std::vector<std::string> lines_;
  Escape escape_ = Escape::kNone;
};

/// Standard input: a terminal, a pipe or nothing. One at a time, one thread. A program in the background
/// reads nothing, for the terminal would stop it.
class LineInput {
 public:
  /// `shares_terminal`: a status line is shown on the same terminal (Progress::terminal()). Then the terminal
  /// neither echoes nor edits until this object goes: typed() says what to show.
  explicit LineInput(bool shares_terminal);
  ~LineInput();
  LineInput(const LineInput&) = delete;
  LineInput& operator=(const LineInput&) = delete;

  /// What to poll for input; −1 when there is nothing to wait for.
  int fd() const;
  /// Waits for input at most so long.
  void wait(std::chrono::milliseconds patience) const;
  /// Complete lines that came; does not wait.
  std::vector<std::string> read();
  /// What is typed so far and echoed by nobody; empty where the terminal echoes.
  std::string typed() const { return edits_ ? editor_.text() : std::string(); }
  bool edits() const { return edits_; }

 private:
  void take_terminal();
  LineEditor editor_;
  std::string partial_;  // where the terminal, or nobody, edits
  termios before_{};
  bool wants_terminal_ = false;
  bool edits_ = false;
  bool over_ = false;
};

}  // namespace slosh
