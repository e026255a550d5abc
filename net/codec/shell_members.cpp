#include "net/codec/shell_members.h"

namespace slosh::codec {

namespace {

constexpr std::uint64_t kLookEvery = 3;  // frames
constexpr int kLooksInside = 1;          // then a member leaves: it costs more than it shows

}  // namespace

void ShellMembers::begin(const Snapshot& snapshot, bool shell_only, std::span<const std::uint32_t> ids) {
  member_.clear();
  if (!shell_only || snapshot.shell.size() != snapshot.positions.size()) return;
  member_.resize(snapshot.positions.size(), kOutside);
  add(ids);
}

bool ShellMembers::looks(const Snapshot& snapshot, std::uint64_t frames) const {
  return !member_.empty() && snapshot.shell.size() == member_.size() && frames % kLookEvery == 0;
}

bool ShellMembers::leaves(std::uint32_t id, bool seen) {
  member_[id] = seen ? std::uint8_t{1} : static_cast<std::uint8_t>(member_[id] + 1);
  return member_[id] > kLooksInside;
}

void ShellMembers::add(std::span<const std::uint32_t> ids) {
  if (member_.empty()) return;
  for (const std::uint32_t id : ids) member_[id] = 1;
}

const std::vector<std::uint8_t>& ShellMembers::choose(const Snapshot& snapshot) {
  // Much flickers at the surface: who comes in has been seen in two looks on end.
  stay_out_ = member_;
  if (seen_before_.size() == stay_out_.size()) {
    for (std::size_t id = 0; id < stay_out_.size(); ++id) stay_out_[id] |= seen_before_[id] == 0;
  }
  seen_before_ = snapshot.shell;
  return stay_out_;
}

}  // namespace slosh::codec
