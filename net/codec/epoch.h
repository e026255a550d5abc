// The particles of an epoch as the encoder has them: who is in which block, and where they were in the newest
// three frames.
#pragma once

#include <cstdint>
#include <vector>

#include "net/codec/block_code.h"
#include "net/codec/cell_order.h"
#include "net/codec/piece.h"
#include "net/codec/shell_members.h"
#include "sim/snapshot.h"

namespace slosh::codec {

class Epoch {
 public:
  /// `step`: the lattice's, m.
  Epoch(double step, double spacing) : per_step_(1.0 / step), shell_(spacing) {}

  /// Starts anew with what the snapshot shows, or its shell alone, in cell order.
  void begin(const Snapshot& snapshot, std::uint64_t frame, bool shell_only);
  /// Moves on to the snapshot. What is no longer shown retires, and of a shell in a frame that `looks` what
  /// has gone inside.
  void follow(const Snapshot& snapshot, bool looks);
  /// After the frame is coded: the frame before loses who retired, so that the next compares those left.
  void forget_retired();
  /// New blocks behind the last one with what has come to the surface, in a frame that `looks` also where
  /// that hardly shows; false when no more fit in.
  bool grow(const Snapshot& snapshot, std::uint64_t frame, bool looks);

  std::uint32_t count() const { return static_cast<std::uint32_t>(members_.size()); }
  std::uint32_t particles() const { return particles_; }  ///< at the start
  std::size_t sent() const { return particles_ + later_; }
  std::uint64_t born(std::uint32_t block) const { return born_[block]; }  ///< its first frame
  std::uint64_t first_frame() const { return first_frame_; }
  const std::int32_t* origin() const { return order_.origin; }
  const ShellMembers& shell() const { return shell_; }

  void write_temporal(std::uint32_t block, std::uint64_t frame, bool packed, BlockWriter& writer) const {
    writer.temporal(members_[block], now_[block], last_[block],
                    born_[block] + 1 == frame ? nullptr : &before_[block], retired_.data() + at(block),
                    retired_count_[block], packed);
  }
  void write_key(std::uint32_t block, BlockWriter& writer) const {
    writer.key(members_[block], now_[block], order_.origin);
  }
  void write_mend(std::uint32_t block, BlockWriter& writer) const {
    writer.mend(members_[block], now_[block], sizes_[block], block >= block_count(particles_));
  }

 private:
  static std::size_t at(std::size_t block) { return block * kBlock; }
  void add_blocks(const Snapshot& snapshot, const CellOrder& from, std::uint64_t frame);
  bool place(const Snapshot& snapshot, std::size_t block);
  void retire(const Snapshot& snapshot, std::size_t block, bool looks);

  double per_step_;
  CellOrder order_;                 // at its start
  std::vector<std::uint32_t> ids_;  // in the snapshot, kBlock places a block
  std::vector<BlockMembers> members_;
  std::vector<BlockPoints> now_, last_, before_;  // with the particles of those frames
  std::vector<std::uint8_t> retired_;             // in this frame: of each block its list …
  std::vector<std::uint8_t> retired_count_;       // … and its length
  std::vector<std::uint8_t> sizes_;               // of the blocks in their first frames
  std::vector<std::uint64_t> born_;               // and which those were
  std::uint64_t first_frame_ = 0;
  std::uint32_t particles_ = 0;
  std::size_t later_ = 0;  // particles that came since the start
  ShellMembers shell_;
  CellOrder more_;  // those that come in this frame
};

}  // namespace slosh::codec
