#include "net/codec/shell_members.h"

#include <cmath>

#include "net/codec/cell_order.h"

namespace slosh::codec {

namespace {

constexpr std::uint64_t kLookEvery = 6;  // frames
constexpr double kCellWidth = 1.96;      // spacings: a member hides what is missing so far around it
constexpr int kHashBits = 16;

}  // namespace

ShellMembers::ShellMembers(double spacing) : per_cell_(1.0 / (kCellWidth * spacing)) {}

void ShellMembers::begin(const Snapshot& snapshot, bool shell_only, std::span<const std::uint32_t> ids) {
  member_.clear();
  if (!shell_only || snapshot.shell.size() != snapshot.positions.size()) return;
  member_.resize(snapshot.positions.size());
  add(ids);
}

bool ShellMembers::looks(const Snapshot& snapshot, std::uint64_t frames) const {
  return follows(snapshot) && frames % kLookEvery == 0;
}

void ShellMembers::add(std::span<const std::uint32_t> ids) {
  if (member_.empty()) return;
  for (const std::uint32_t id : ids) member_[id] = 1;
}

/// Two cells may share a place: then one waits that need not.
std::uint8_t& ShellMembers::covered(const glm::vec3& position) {
  std::uint32_t hash = 0;
  for (int a = 0; a < 3; ++a) {
    // Whatever the position is, the cell is a number; far ones are not sent anyway.
    const double cell = std::floor(static_cast<double>(position[a]) * per_cell_);
    const double limited = cell > -1e9 && cell < 1e9 ? cell : 0.0;
    hash = hash * 73856093u + static_cast<std::uint32_t>(static_cast<std::int32_t>(limited));
  }
  return covered_[hash * 2654435769u >> (32 - kHashBits)];
}

const std::vector<std::uint8_t>& ShellMembers::choose(const Snapshot& snapshot, bool looks) {
  covered_.assign(std::size_t{1} << kHashBits, 0);
  for (std::size_t id = 0; id < member_.size(); ++id) {
    if (member_[id] != 0) covered(snapshot.positions[id]) = 1;
  }
  if (seen_before_.size() != member_.size()) seen_before_.assign(member_.size(), 0);
  stay_out_.assign(member_.size(), 1);
  for (std::size_t id = 0; id < member_.size(); ++id) {
    if (member_[id] != 0 || snapshot.shell[id] == 0 || !is_drawn(snapshot, id)) continue;
    std::uint8_t& near = covered(snapshot.positions[id]);
    if (near != 0 && !(looks && seen_before_[id] != 0)) continue;
    near = 1;
    stay_out_[id] = 0;
  }
  if (looks) seen_before_ = snapshot.shell;
  return stay_out_;
}

}  // namespace slosh::codec
