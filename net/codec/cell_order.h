// The order of an epoch: particles along a Morton curve, so that neighbours in memory are neighbours in
// space.
#pragma once

#include <cstdint>
#include <vector>

#include "net/codec/lattice.h"
#include "net/wire/messages.h"
#include "sim/snapshot.h"

namespace slosh::codec {

struct CellOrder {
  std::vector<std::uint32_t> ids;   ///< indices into the snapshot, in Morton order
  std::vector<std::int32_t> at[3];  ///< lattice points, the same order
  std::int32_t origin[3] = {};      ///< the smallest coordinate of each axis

  /// Takes what is to be sent: not retired, finite, on the lattice, and of the shell if so asked and known.
  /// At most kMaxParticles.
  /// Of `without` (empty, or one a particle) those that are 1 stay out.
  void sort(const Snapshot& snapshot, double per_step, bool shell_only,
            const std::vector<std::uint8_t>& without = {});

 private:
  struct Entry {
    std::uint64_t code;
    std::uint32_t id;
  };
  std::vector<Entry> entries_, spare_;
  std::vector<std::uint32_t> spare_ids_;
  std::vector<std::int32_t> raw_[3];
};

/// False for a particle that must not be sent.
inline bool is_drawn(const Snapshot& snapshot, std::size_t id) {
  return id >= snapshot.fluid_index.size() || snapshot.fluid_index[id] < wire::kMaxFluids;
}

}  // namespace slosh::codec
