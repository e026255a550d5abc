// Who is in an epoch of which only the shell is sent, as the shell changes: who comes in, who leaves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/snapshot.h"

namespace slosh::codec {

class ShellMembers {
 public:
  /// Empty, and so it stays, where the whole fluid is sent or the snapshot tells no shell.
  void begin(const Snapshot& snapshot, bool shell_only, std::span<const std::uint32_t> ids);
  /// Whether members change in the epoch's frame so many after its first.
  bool looks(const Snapshot& snapshot, std::uint64_t frames) const;
  /// Of a member in such a frame; `seen`: it is of the shell now.
  bool leaves(std::uint32_t id, bool seen);
  void remove(std::uint32_t id) {
    if (id < member_.size()) member_[id] = kOutside;
  }
  void add(std::span<const std::uint32_t> ids);
  /// 1 for everybody who must not come in now. Once in each frame that looks.
  const std::vector<std::uint8_t>& choose(const Snapshot& snapshot);

 private:
  static constexpr std::uint8_t kOutside = 0;  // else 1 + looks on end in which the member was inside
  std::vector<std::uint8_t> member_;           // one a particle of the snapshot
  std::vector<std::uint8_t> seen_before_;      // the shell of the look before
  std::vector<std::uint8_t> stay_out_;
};

}  // namespace slosh::codec
