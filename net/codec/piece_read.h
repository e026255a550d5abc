// A piece's datagram: its head, checked, and its blocks as far as what a peer has allows.
#pragma once

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

/// Decodes the blocks from the first on, up to one whose past is not there. The store stays as it is.
wire::Fault read_blocks(const PieceView& piece, const BlockStore& store, std::vector<Block>& out);

}  // namespace slosh::codec
