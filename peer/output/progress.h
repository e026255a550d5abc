// What the program is doing, on stderr: one line kept up to date on a terminal, else a line now and then.
#pragma once

#include <cstdint>
#include <string>

namespace slosh {

/// For one thread.
class Progress {
 public:
  Progress();
  /// With the choices made, for tests. Lines go to stderr.
  Progress(bool terminal, double seconds_between_lines);
  ~Progress();

  /// A new phase, e.g. "loading". Ends the line before.
  void phase(const std::string& name, const std::string& detail = {});
  /// `fraction` 0–1, or negative when it is not known.
  void update(double fraction, const std::string& text);
  /// Ends the line that is kept up to date, where there is one: what follows is somebody else's.
  void end() { end_line(); }
  /// A line of its own that stays, e.g. a choice that was made.
  void note(const std::string& text);

  /// Whether there is a status line on a terminal.
  bool terminal() const { return terminal_; }
  /// What a person has typed so far of a line (LineInput::typed): while that is something it stands where the
  /// status line was.
  void typed(const std::string& text);
  /// The answer to a line that was typed: `line` (when nobody has echoed it) and `text` on stdout, either may
  /// be empty.
  void answer(const std::string& line, const std::string& text);

 private:
  void end_line();
  void clear_line();
  void show();

  bool terminal_;
  std::int64_t between_ns_;
  std::int64_t last_line_ns_ = 0;
  std::string phase_;
  std::string status_;  // the newest, for when nothing is typed any more
  std::string typed_;
  bool line_open_ = false;
  bool line_moves_ = false;  // it is kept up to date
};

/// Whether a byte of UTF-8 text is the first of its character.
inline bool begins_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
}
/// Columns that UTF-8 text takes on a terminal, counting every code point as one.
std::size_t columns(const std::string& text);

}  // namespace slosh
