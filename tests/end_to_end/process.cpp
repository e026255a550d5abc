#include "process.h"

#include <gtest/gtest.h>

#include "tests/support/places.h"

namespace slosh::test {

std::string program() {
  return SLOSH_PROGRAM;
}

std::filesystem::path test_folder() {
  const ::testing::TestInfo* info = ::testing::UnitTest::GetInstance()->current_test_info();
  return build_dir() / "end_to_end" / (std::string(info->test_suite_name()) + "." + info->name());
}

void empty_folder() {
  std::filesystem::remove_all(test_folder());
}

Outcome slosh(const std::vector<std::string>& arguments) {
  std::vector<std::string> all{program()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return Process(all, test_folder()).wait();
}

}  // namespace slosh::test
