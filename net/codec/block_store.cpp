#include "net/codec/block_store.h"

namespace slosh::codec {

const Block* BlockStore::find(std::uint32_t block, std::uint64_t frame) const {
  if (block >= blocks() || !histories_[block]) return nullptr;
  const Entry& entry = (*histories_[block])[frame % kKeptFrames];
  return entry.block && entry.frame == frame ? entry.block.get() : nullptr;
}

const Block* BlockStore::nearest(std::uint32_t block, std::uint64_t frame, std::uint64_t& found) const {
  const Entry* best = nullptr;
  if (block >= blocks() || !histories_[block]) return nullptr;
  for (const Entry& entry : *histories_[block]) {
    if (!entry.block) continue;
    const bool before = entry.frame <= frame;
    if (!best || (before && (best->frame > frame || entry.frame > best->frame)) ||
        (!before && best->frame > frame && entry.frame < best->frame))
      best = &entry;
  }
  if (!best) return nullptr;
  found = best->frame;
  return best->block.get();
}

bool BlockStore::newest(std::uint32_t block, std::uint64_t& frame) const {
  return nearest(block, ~std::uint64_t{0}, frame) != nullptr;
}

bool BlockStore::put(std::uint32_t block, std::uint64_t frame, std::unique_ptr<Block>& content) {
  if (!histories_[block]) histories_[block] = std::make_unique<History>();
  Entry& entry = (*histories_[block])[frame % kKeptFrames];
  if (entry.block && entry.frame >= frame) return false;
  entry.frame = frame;
  entry.block.swap(content);
  return true;
}

void BlockStore::grow(std::uint32_t blocks, std::uint64_t frame) {
  if (blocks > histories_.size()) {
    histories_.resize(blocks);
    known_since_.resize(blocks, frame);
  }
  // Pieces come in any order: an earlier frame may tell of it later.
  for (std::uint32_t b = blocks; b-- > 0 && known_since_[b] > frame;) known_since_[b] = frame;
}

const BlockPoints* match_points(const Block& to, const Block& from, BlockPoints& space) {
  if (to.count == from.count) return &from.points;
  // A particle that is there now was there before: retired ones do not come back within an epoch.
  int at = 0;
  for (int i = 0; i < to.count; ++i) {
    while (at + 1 < from.count && from.slot[at] < to.slot[i]) ++at;
    for (int a = 0; a < 3; ++a) space.at[a][i] = from.count > 0 ? from.points.at[a][at] : to.points.at[a][i];
  }
  return &space;
}

}  // namespace slosh::codec
