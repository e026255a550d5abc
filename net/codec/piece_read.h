// A piece's datagram: its head, checked, and its blocks as far as what a peer has allows.
#pragma once

#include <memory>
#include <vector>

#include "net/codec/block_store.h"
#include "net/codec/piece.h"
#include "net/wire/fields.h"

namespace slosh::codec {

struct PieceView {
  PieceHead head;
  EpochHead epoch;  ///< of key and mending pieces
  std::span<const std::uint8_t> payload;
};

/// Reads the heads and checks what they alone tell.
wire::Fault read_heads(std::span<const std::uint8_t> datagram, PieceView& out);
/// Whether the piece can be of the store's epoch.
wire::Fault check_fits(const PieceView& piece, const BlockStore& store);

/// Blocks whose memory is kept from piece to piece.
class BlockList {
 public:
  void clear() { used_ = 0; }
  std::size_t size() const { return used_; }
  /// One more, with anything in it.
  Block& add() {
    if (used_ == blocks_.size()) blocks_.emplace_back();
    std::unique_ptr<Block>& block = blocks_[used_++];
    if (!block) block = std::make_unique<Block>();
    return *block;
  }
  std::unique_ptr<Block>& operator[](std::size_t i) { return blocks_[i]; }

 private:
  std::vector<std::unique_ptr<Block>> blocks_;  // the first used_ of them
  std::size_t used_ = 0;
};

/// Decodes the blocks from the first on, up to one whose past is not there. The store stays as it is.
wire::Fault read_blocks(const PieceView& piece, const BlockStore& store, BlockList& out);

}  // namespace slosh::codec
