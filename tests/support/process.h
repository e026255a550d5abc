// Running a program as a user would, and looking at what it said.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace slosh::test {

struct Outcome {
  int code = -1;  ///< exit code; 128 + signal when a signal ended it
  std::string out;
  std::string err;
  long peak_kb = 0;  ///< most memory that it ever held, kB
};

/// A program with its output going to files in a folder of its own, without a terminal or a display.
class Process {
 public:
  /// `folder` is the working directory, made when it is not there.
  Process(const std::vector<std::string>& arguments, const std::filesystem::path& folder);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const;
  pid_t pid() const { return pid_; }
  bool running();
  Outcome wait();

 private:
  std::filesystem::path folder_;
  pid_t pid_ = -1;
  int status_ = 0;
  bool ended_ = false;
  long peak_kb_ = 0;
};

std::string read_text(const std::filesystem::path& file);

}  // namespace slosh::test
