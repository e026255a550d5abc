// Who is in an epoch of which only the shell is sent, as the shell changes: who comes in, who leaves.
//
// Much flickers at the surface, and whoever comes in costs several times what a member does. So most wait
// until two looks on end have seen them, and are missing meanwhile where other members hide that. Where no
// member is near, a hole would show, such as a drop that is not there: the first one there comes in at once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/snapshot.h"

namespace slosh::codec {

class ShellMembers {
 public:
  /// `spacing` of the particles, m.
  explicit ShellMembers(double spacing);

  /// Empty, and so it stays, where the whole fluid is sent or the snapshot tells no shell.
  void begin(const Snapshot& snapshot, bool shell_only, std::span<const std::uint32_t> ids);
  /// Whether there is a shell to follow in this snapshot.
  bool follows(const Snapshot& snapshot) const {
    return !member_.empty() && snapshot.shell.size() == member_.size();
  }
  /// Whether members are looked at in the epoch's frame so many after its first.
  bool looks(const Snapshot& snapshot, std::uint64_t frames) const;
  void remove(std::uint32_t id) {
    if (id < member_.size()) member_[id] = 0;
  }
  void add(std::span<const std::uint32_t> ids);
  /// 1 for everybody who must not come in now. For each frame that follows; `looks` as above.
  const std::vector<std::uint8_t>& choose(const Snapshot& snapshot, bool looks);

 private:
  void find_places(const Snapshot& snapshot);

  double per_cell_;
  std::vector<std::uint8_t> member_;       // 1 or 0, one a particle of the snapshot
  std::vector<std::uint8_t> seen_before_;  // the shell of the look before
  std::vector<std::uint8_t> stay_out_;
  std::vector<std::uint16_t> place_;   // one a particle: a hash of its cell
  std::vector<std::uint8_t> covered_;  // by place: a member is there
};

}  // namespace slosh::codec
