// A virtual display, for tests of the window.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "process.h"

namespace slosh::test {

bool installed(const std::string& program);

/// A virtual display of its own, and what is done there.
class Display {
 public:
  explicit Display(const std::filesystem::path& folder);
  ~Display();
  bool there() { return server_.running() && name_.size() > 1; }
  /// The program there.
  std::vector<std::string> on(std::vector<std::string> arguments) const;
  /// What a person does, in xdotool's words; what it prints.
  std::string act(std::vector<std::string> words) const;

 private:
  std::filesystem::path folder_;
  Process server_;
  std::string name_;
};

}  // namespace slosh::test
