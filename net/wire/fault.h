// Bytes, and what may be wrong with them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace slosh::wire {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// What is wrong with a message; `problem` is empty while all is well.
struct Fault {
  std::string field;    ///< e.g. "samples.grip"
  std::string problem;  ///< "70 is above 63", "ends too early"
  explicit operator bool() const { return !problem.empty(); }
  std::string text() const { return field + ": " + problem; }
};

}  // namespace slosh::wire
