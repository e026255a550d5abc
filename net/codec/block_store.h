// What a peer has of an epoch: of every block the last few frames that came.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "net/codec/block_code.h"
#include "net/codec/piece.h"

namespace slosh::codec {

constexpr std::uint64_t kKeptFrames = 4;  ///< also how late a piece may come and still be of use

class BlockStore {
 public:
  BlockStore(std::uint32_t epoch, std::uint32_t run, const EpochHead& head)
      : epoch_(epoch),
        run_(run),
        head_(head),
        histories_(block_count(head.particles)),
        known_since_(histories_.size(), head.first_frame) {}

  std::uint32_t epoch() const { return epoch_; }
  std::uint32_t run() const { return run_; }
  const EpochHead& head() const { return head_; }
  std::uint32_t blocks() const { return static_cast<std::uint32_t>(histories_.size()); }

  /// Null: that frame of the block did not come, or is forgotten.
  const Block* find(std::uint32_t block, std::uint64_t frame) const;
  /// The newest up to `frame`, else the oldest after it; null when there is none. `found` gets its frame.
  const Block* nearest(std::uint32_t block, std::uint64_t frame, std::uint64_t& found) const;
  /// Newest frame that came of the block; false when none did.
  bool newest(std::uint32_t block, std::uint64_t& frame) const;
  /// Takes `content` and gives an old block's memory, or none, in its place. False, and nothing taken: it was
  /// there, or is too old to be kept.
  bool put(std::uint32_t block, std::uint64_t frame, std::unique_ptr<Block>& content);
  /// The epoch has `blocks` in `frame`, as a piece tells.
  void grow(std::uint32_t blocks, std::uint64_t frame);
  /// Whether the block is known to be there in `frame`.
  bool is_there(std::uint32_t block, std::uint64_t frame) const { return known_since_[block] <= frame; }
  /// True when the temporal coding of `frame` can be read.
  bool can_follow(std::uint32_t block, std::uint64_t frame) const {
    if (frame <= head_.first_frame) return false;
    const Block* last = find(block, frame - 1);
    return last && (last->born || find(block, frame - 2));
  }

 private:
  struct Entry {
    std::uint64_t frame = 0;
    std::unique_ptr<Block> block;  // null: nothing came
  };
  using History = std::array<Entry, kKeptFrames>;

  std::uint32_t epoch_, run_;
  EpochHead head_;
  std::vector<std::unique_ptr<History>> histories_;  // of a block, from its first piece on
  std::vector<std::uint64_t> known_since_;           // frame, of each block
};

/// Points of `from` for the particles of `to` alone, both of one block; in `space` where some have retired.
const BlockPoints* match_points(const Block& to, const Block& from, BlockPoints& space);

}  // namespace slosh::codec
