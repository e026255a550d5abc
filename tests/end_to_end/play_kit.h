// What tests of `slosh play` share: a folder of their own, and what ffprobe says of a film.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "process.h"

namespace slosh::test {

class PlayTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(test_folder()); }
  std::filesystem::path out(const std::string& name = "out") const { return test_folder() / name; }
};

/// One value of ffprobe's about the first video stream.
inline std::string probe(const std::filesystem::path& film, const std::string& entry) {
  const Outcome outcome = Process({"ffprobe", "-v", "error", "-count_frames", "-select_streams", "v:0",
                                   "-show_entries", "stream=" + entry, "-of", "csv=p=0", film.string()},
                                  test_folder() / "ffprobe")
                              .wait();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return outcome.out.substr(0, outcome.out.find_first_of("\n,"));
}

}  // namespace slosh::test
