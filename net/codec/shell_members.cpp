#include "net/codec/shell_members.h"

#include "net/codec/cell_order.h"
#include "net/codec/lattice.h"

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

/// Two cells may share a place: then one waits that need not. Whatever a position is, it has some place.
void ShellMembers::find_places(const Snapshot& snapshot) {
  place_.resize(snapshot.positions.size());
  for (std::size_t id = 0; id < place_.size(); ++id) {
    const glm::vec3& at = snapshot.positions[id];
    const auto cell = [&](float x) {
      return static_cast<std::uint32_t>(nearest(static_cast<double>(x) * per_cell_ - 0.5));
    };
    const std::uint32_t hash = (cell(at.x) * 73856093u + cell(at.y)) * 73856093u + cell(at.z);
    place_[id] = static_cast<std::uint16_t>(hash * 2654435769u >> (32 - kHashBits));
  }
}

const std::vector<std::uint8_t>& ShellMembers::choose(const Snapshot& snapshot, bool looks) {
  find_places(snapshot);
  covered_.assign(std::size_t{1} << kHashBits, 0);
  for (std::size_t id = 0; id < member_.size(); ++id) {
    covered_[place_[id]] |= member_[id];
  }
  if (seen_before_.size() != member_.size()) seen_before_.assign(member_.size(), 0);
  stay_out_.assign(member_.size(), 1);
  for (std::size_t id = 0; id < member_.size(); ++id) {
    if (member_[id] != 0 || snapshot.shell[id] == 0 || !is_drawn(snapshot, id)) continue;
    std::uint8_t& near = covered_[place_[id]];
    if (near != 0 && !(looks && seen_before_[id] != 0)) continue;
    near = 1;
    stay_out_[id] = 0;
  }
  if (looks) seen_before_ = snapshot.shell;
  return stay_out_;
}

}  // namespace slosh::codec
