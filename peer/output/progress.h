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
  /// A line of its own that stays, e.g. a choice that was made.
  void note(const std::string& text);

 private:
  void end_line();

  bool terminal_;
  std::int64_t between_ns_;
  std::int64_t last_line_ns_ = 0;
  std::string phase_;
  bool line_open_ = false;
};

/// Columns that UTF-8 text takes on a terminal, counting every code point as one.
std::size_t columns(const std::string& text);

}  // namespace slosh
