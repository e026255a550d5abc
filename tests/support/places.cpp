#include "tests/support/places.h"

namespace slosh::test {

std::filesystem::path source_dir() {
  return SLOSH_SOURCE_DIR;
}

std::filesystem::path build_dir() {
  return SLOSH_BINARY_DIR;
}

}  // namespace slosh::test
