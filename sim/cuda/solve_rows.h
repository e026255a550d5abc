// The pairs of a solve in one launch: written down once a sub-step, read in each iteration.
#pragma once

#include <span>
#include <vector>

#include "sim/cuda/kernels.h"

namespace slosh::cuda {

inline constexpr int kSolveThreads = 256;  // entries that one partial sum is over

/// The pairs in which each entry meets another, a vector each, and in its last four bytes the other's entry.
/// Row k of entry e lies where the rows k of a warp's 32 entries are one run of memory.
struct PairRows {
  std::uint32_t room = 0;  ///< pairs of an entry; who has more walks the neighbours anew each iteration
  float4* pairs = nullptr;
  std::uint32_t* counts = nullptr;  ///< of pairs, written or not

  SLOSH_HD std::size_t at(std::uint32_t entry, std::uint32_t k) const {
    return (std::size_t{entry / 32} * room + k) * 32 + entry % 32;
  }
  /// Places for `entries` entries with `room` pairs each.
  static std::size_t places(std::size_t entries, std::uint32_t room) {
    return (entries + 31) / 32 * 32 * room;
  }
};

/// Pairs that an entry's row has room for: half again as many as particles of a lattice within reach, in
/// whole eights. Few have more.
std::uint32_t row_room(const Plan& plan);

/// A body's particles in local order; none where it does not move.
struct BodyRange {
  std::uint32_t begin = 0, end = 0;
};
/// One a body. `moving` is body by body.
std::vector<BodyRange> ranges_of(std::span<const SurfaceParticle> moving, std::size_t body_count);

}  // namespace slosh::cuda
