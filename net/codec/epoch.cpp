#include "net/codec/epoch.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace slosh::codec {

void Epoch::begin(const Snapshot& snapshot, std::uint64_t frame, bool shell_only) {
  order_.sort(snapshot, per_step_, shell_only);
  particles_ = static_cast<std::uint32_t>(order_.ids.size());
  first_frame_ = frame;
  later_ = 0;
  members_.clear();
  shell_.begin(snapshot, shell_only, order_.ids);
  add_blocks(snapshot, order_, frame);
}

void Epoch::add_blocks(const Snapshot& snapshot, const CellOrder& from, std::uint64_t frame) {
  const auto many = static_cast<std::uint32_t>(from.ids.size());
  const std::size_t known = members_.size();
  const std::size_t count = known + block_count(many);
  members_.resize(count);
  now_.resize(count);
  last_.resize(count);
  before_.resize(count);
  retired_.resize(at(count));
  retired_count_.resize(count);
  sizes_.resize(count);
  born_.resize(count);
  ids_.resize(at(count));
  for (std::uint32_t n = 0; known + n < count; ++n) {
    const std::size_t b = known + n;
    BlockMembers& block = members_[b];
    block.count = block_size(many, n);
    block.born = true;
    born_[b] = frame;
    sizes_[b] = static_cast<std::uint8_t>(block.count);
    retired_count_[b] = 0;
    for (int i = 0; i < block.count; ++i) {
      const std::size_t source = at(n) + static_cast<std::size_t>(i);
      const std::uint32_t id = from.ids[source];
      ids_[at(b) + static_cast<std::size_t>(i)] = id;
      block.slot[i] = static_cast<std::uint8_t>(i);
      block.fluid[i] = id < snapshot.fluid_index.size() ? snapshot.fluid_index[id] : std::uint8_t{0};
      for (int a = 0; a < 3; ++a) now_[b].at[a][i] = from.at[a][source];
    }
  }
}

void Epoch::follow(const Snapshot& snapshot, bool looks) {
  std::swap(before_, last_);
  std::swap(last_, now_);
  // The order jumps about in the snapshot: all of it comes near first, which is quick in a row.
  const char* start = reinterpret_cast<const char*>(snapshot.positions.data());
  const std::size_t bytes = snapshot.positions.size() * sizeof(glm::vec3);
  if (sent() * 4 > snapshot.positions.size())
    for (std::size_t i = 0; i < bytes; i += 64) __builtin_prefetch(start + i);
  for (std::size_t b = 0; b < members_.size(); ++b) {
    members_[b].born = false;
    retired_count_[b] = 0;
    if (!place(snapshot, b) || looks) retire(snapshot, b, looks);
  }
}

/// The block's newest points. False when there is somebody who must not be sent.
bool Epoch::place(const Snapshot& snapshot, std::size_t block) {
  const BlockMembers& members = members_[block];
  const std::uint32_t* ids = ids_.data() + at(block);
  const bool has_fluids = snapshot.fluid_index.size() == snapshot.positions.size();
  float position[3][kBlock];
  std::uint8_t most = 0;
  for (int i = 0; i < members.count; ++i) {
    // Neighbours in the order lie far apart in the snapshot: the memory has to be told ahead.
    const std::size_t ahead = at(block) + static_cast<std::size_t>(i) + 24;
    if (ahead < ids_.size()) __builtin_prefetch(&snapshot.positions[ids_[ahead]]);
    const std::uint32_t id = ids[members.slot[i]];
    for (int a = 0; a < 3; ++a) position[a][i] = snapshot.positions[id][a];
    most = std::max(most, has_fluids ? snapshot.fluid_index[id] : kRetired);
  }
  bool good = most < wire::kMaxFluids;
  for (int a = 0; a < 3; ++a) {
    std::int32_t outside = 0;
    for (int i = 0; i < members.count; ++i) {
      const double scaled = static_cast<double>(position[a][i]) * per_step_;
      outside |= !(std::abs(scaled) < kCoordinateLimit - 1);
      now_[block].at[a][i] = nearest(scaled);
    }
    good &= outside == 0;
  }
  return good;
}

void Epoch::retire(const Snapshot& snapshot, std::size_t block, bool looks) {
  BlockMembers& members = members_[block];
  std::uint8_t* list = retired_.data() + at(block);
  int many = 0;
  for (int i = 0; i < members.count; ++i) {
    const std::uint32_t id = ids_[at(block) + members.slot[i]];
    std::int32_t point[3];
    if (is_drawn(snapshot, id) && to_lattice(snapshot.positions[id], per_step_, point) &&
        !(looks && snapshot.shell[id] == 0))
      continue;
    list[many++] = static_cast<std::uint8_t>(i);
    shell_.remove(id);
  }
  retired_count_[block] = static_cast<std::uint8_t>(many);
  if (many == 0) return;
  remove_points(list, many, members.count, now_[block]);
  remove_members(list, many, members);
}

void Epoch::forget_retired() {
  for (std::size_t b = 0; b < members_.size(); ++b) {
    const int many = retired_count_[b];
    if (many > 0) remove_points(retired_.data() + at(b), many, members_[b].count + many, last_[b]);
  }
}

bool Epoch::grow(const Snapshot& snapshot, std::uint64_t frame, bool looks) {
  if (particles_ == 0) return true;
  more_.sort(snapshot, per_step_, true, shell_.choose(snapshot, looks));
  if (more_.ids.empty()) return true;
  const auto many = static_cast<std::uint32_t>(more_.ids.size());
  if (count() + block_count(many) > most_blocks(particles_)) return false;
  later_ += many;
  shell_.add(more_.ids);
  add_blocks(snapshot, more_, frame);
  return true;
}

}  // namespace slosh::codec
