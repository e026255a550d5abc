// The built program, run from a test as a user would run it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace slosh::test {

/// The built program with these arguments, run to its end in a fresh folder named after the current test.
Outcome slosh(const std::vector<std::string>& arguments);
/// That folder.
std::filesystem::path test_folder();
/// Removes it: what an earlier run of the same test left there would be refused, as it should be.
void empty_folder();
/// A copy of this process's build of the program.
std::string program();

}  // namespace slosh::test
