// What a device was sent, write by write: whether it was struck, and when it had nothing left.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace slosh::test {

struct WrittenForce {
  std::int64_t ns = 0;  ///< steady clock
  glm::dvec3 force{0.0};
};

inline std::vector<WrittenForce> written_since(const std::vector<WrittenForce>& all, std::int64_t from_ns,
                                               std::int64_t to_ns = INT64_MAX) {
  std::vector<WrittenForce> found;
  for (const WrittenForce& write : all)
    if (write.ns >= from_ns && write.ns < to_ns) found.push_back(write);
  return found;
}

/// The largest change from a write to the next over what a device of `rate` N/s and 1 kHz may be given at
/// once: in the shorter of the times that it and the write before it took, a ms at least. A thread that stood
/// still has no more to give for it.
inline double steepest(const std::vector<WrittenForce>& writes, double rate) {
  double most = 0.0;
  for (std::size_t i = 1; i < writes.size(); ++i) {
    const double took = 1e-9 * static_cast<double>(writes[i].ns - writes[i - 1].ns);
    const double before = i > 1 ? 1e-9 * static_cast<double>(writes[i - 1].ns - writes[i - 2].ns) : 0.001;
    const double allowed = rate * std::max(std::min(took, before), 0.001);
    most = std::max(most, glm::length(writes[i].force - writes[i - 1].force) / allowed);
  }
  return most;
}

/// s from `ns` to the write from which on all are zero; 1e9 where the last is not.
inline double zero_after(const std::vector<WrittenForce>& writes, std::int64_t ns) {
  double zero = 1e9;
  for (std::size_t i = writes.size(); i-- > 0 && writes[i].force == glm::dvec3(0.0);)
    zero = 1e-9 * static_cast<double>(writes[i].ns - ns);
  return zero;
}

}  // namespace slosh::test
