// The fixture of what a host and its peers do as programs: a folder for each, a home for all, the host's
// links.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "process.h"

namespace slosh::test {

/// A port of loopback that nobody listens on now; 0 when there is no loopback.
int free_port();

class HostedTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;
  /// Where the program with this name runs, below the test's own folder.
  std::filesystem::path folder(const std::string& name) const { return test_folder() / name; }
  /// The built program with these arguments, and with its own idea of where a user's files are.
  std::vector<std::string> command(const std::vector<std::string>& arguments) const;
  /// One of the links that the program "host" wrote to links.txt: "hold" or "watch"; empty while there is
  /// none.
  std::string link(const std::string& kind) const;
  /// Starts the built program with these arguments in the folder of that name.
  std::unique_ptr<Process> run(const std::string& name, const std::vector<std::string>& arguments) const;
  /// Waits until the program "host" has written its links; false when it ended before.
  bool hosting(Process& host) const;

 private:
  std::filesystem::path home_;
};

}  // namespace slosh::test
