// Where the sources and the build of this run are. In one file, so that no other test's object depends on a
// path and a compiler cache serves every checkout.
#pragma once

#include <filesystem>

namespace slosh::test {

std::filesystem::path source_dir();  ///< the top of the repository
std::filesystem::path build_dir();   ///< of the preset that the test was built with

}  // namespace slosh::test
