#include "net/codec/piece_read.h"

#include <algorithm>

namespace slosh::codec {

wire::Fault read_heads(std::span<const std::uint8_t> datagram, PieceView& out) {
  if (datagram.empty()) return {"type", "ends too early"};
  if (datagram[0] != static_cast<std::uint8_t>(wire::DatagramType::kSnapshotPiece))
    return {"type", std::to_string(datagram[0]) + " is no snapshot piece"};
  wire::Reader reader(datagram.subspan(1));
  visit(reader, out.head);
  const PieceHead& head = out.head;
  if (reader.ok() && head.kind != PieceKind::kTemporal) visit(reader, out.epoch);
  if (!reader.ok()) return reader.fault();
  out.payload = datagram.last(reader.left());
  if (head.kind == PieceKind::kMend ? head.pieces != 0 || head.piece != 0 : head.piece >= head.pieces)
    return {"piece", std::to_string(head.piece) + " is not below pieces"};
  if (head.kind == PieceKind::kTemporal) return {};
  const bool key = head.kind == PieceKind::kKey;
  if (key ? head.frame != out.epoch.first_frame : head.frame < out.epoch.first_frame)
    return {"first_frame",
            std::to_string(out.epoch.first_frame) + " does not go with frame " + std::to_string(head.frame)};
  return {};
}

wire::Fault check_fits(const PieceView& piece, const BlockStore& store) {
  const PieceHead& head = piece.head;
  const EpochHead& known = store.head();
  const std::uint32_t at_start = block_count(known.particles);
  const std::uint32_t most = head.kind == PieceKind::kKey ? at_start : most_blocks(known.particles);
  if (head.all_blocks < at_start || head.all_blocks > most)
    return {"all_blocks",
            std::to_string(head.all_blocks) + " do not go with the epoch's " + std::to_string(at_start)};
  if (std::uint64_t{head.first_block} + head.blocks > head.all_blocks)
    return {"blocks", std::to_string(head.first_block + head.blocks) + " are more than the epoch's " +
                          std::to_string(head.all_blocks)};
  if (head.run != store.run()) return {"run", "is another than the epoch's"};
  if (head.kind == PieceKind::kTemporal) {
    if (head.frame <= known.first_frame) return {"frame", "is before the epoch's second"};
    return {};
  }
  if (piece.epoch.particles != known.particles || piece.epoch.first_frame != known.first_frame ||
      piece.epoch.tolerance != known.tolerance ||
      !std::equal(known.origin, known.origin + 3, piece.epoch.origin))
    return {"epoch", "its pieces contradict each other"};
  return {};
}

wire::Fault read_blocks(const PieceView& piece, const BlockStore& store, BlockList& out) {
  const PieceHead& head = piece.head;
  out.clear();
  BlockReader reader(piece.payload);
  if (!reader.started()) return {"blocks", "the coded part is too short or damaged"};
  std::int32_t origin[3];
  for (int a = 0; a < 3; ++a)
    origin[a] = static_cast<std::int32_t>(store.head().origin[a]) - kCoordinateLimit;
  for (std::uint32_t b = head.first_block; b < head.first_block + head.blocks; ++b) {
    const bool later = b >= block_count(store.head().particles);
    const int size = later ? 0 : block_size(store.head().particles, b);
    const char* problem = nullptr;
    if (head.kind == PieceKind::kTemporal) {
      if (!store.can_follow(b, head.frame)) return {};
      Block& block = out.add();
      block = *store.find(b, head.frame - 1);
      BlockPoints space;
      const BlockPoints* before = nullptr;
      if (!block.born) before = match_points(block, *store.find(b, head.frame - 2), space);
      block.born = false;
      problem = reader.temporal(block, before);
    } else {
      Block& block = out.add();
      block.born = head.frame == store.head().first_frame;
      problem =
          head.kind == PieceKind::kKey ? reader.key(block, size, origin) : reader.mend(block, size, later);
    }
    if (problem) {
      out.clear();
      return {"block " + std::to_string(b), problem};
    }
  }
  if (!reader.ended()) {
    out.clear();
    return {"end", "the coded part is damaged"};
  }
  return {};
}

}  // namespace slosh::codec
