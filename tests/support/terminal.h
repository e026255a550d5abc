// A program at a terminal of its own, as a person has it before them.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace slosh::test {

class Terminal {
 public:
  /// Starts the program in `folder` (made when it is not there) with the terminal as all three streams.
  Terminal(const std::vector<std::string>& arguments, const std::filesystem::path& folder);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void type(const std::string& keys) const;
  /// Everything that was written there so far.
  const std::string& screen();
  /// Waits until `text` is written after the first `from` bytes; false when that takes four minutes or the
  /// program ends first.
  bool shows(const std::string& text, std::size_t from = 0);
  /// Whether the terminal itself echoes and edits lines, as a shell finds it.
  bool echoes() const;
  /// Waits for the program's end; its exit code, 128 + signal when one ended it.
  int wait();

 private:
  bool read_some(int wait_ms);
  int fd_ = -1;
  pid_t pid_ = -1;
  bool over_ = false;
  std::string screen_;
};

}  // namespace slosh::test
