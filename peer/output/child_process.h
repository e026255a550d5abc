// A program that is fed through its standard input: ffmpeg, gnuplot.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh {

/// Whether a program of that name is on the PATH.
bool program_there(const std::string& name);

/// Started in a process group of its own, so that Ctrl-C reaches this program alone and the child can finish
/// its file. What it says on stderr is kept and shown when it fails, what it writes to stdout is kept for
/// output(). No shell is between. SIGPIPE must be ignored by the process.
class ChildProcess {
 public:
  /// `arguments[0]` is looked up in PATH. Errors: it is not installed or cannot start.
  static Result<std::unique_ptr<ChildProcess>> start(const std::vector<std::string>& arguments);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Waits while the pipe is full. False when the child is gone.
  bool write(const void* data, std::size_t bytes);
  /// Whether it has ended; does not wait.
  bool over() const;
  /// Asks it to end (SIGTERM), which finish() then waits for.
  void ask_to_end() const;
  /// Closes its input, waits for its end. Errors: it failed; the end of what it said is in `what`.
  Result<bool> finish();
  /// After finish(): every byte of its standard output.
  const std::string& output() const { return output_; }

 private:
  ChildProcess(std::string name, pid_t pid, int input, int written, int said);
  std::string name_;
  std::string output_;
  pid_t pid_;
  int input_;
  int written_;  // its stdout, a file in memory
  int said_;     // its stderr, likewise
};

}  // namespace slosh
