// The head of a snapshot piece; what follows it is one entropy-coded stream to the datagram's end.
#pragma once

#include <cstdint>

#include "net/codec/lattice.h"
#include "net/wire/messages.h"

namespace slosh::codec {

enum class PieceKind : std::uint8_t {
  kTemporal,  ///< blocks by what changed since the two frames before
  kKey,       ///< an epoch's first frame
  kMend,      ///< blocks of the newest frame by themselves, for one peer
};
constexpr std::uint64_t kPieceKinds = 3;

struct PieceHead {
  std::uint32_t stream = 0;
  PieceKind kind = PieceKind::kTemporal;
  std::uint32_t run = 0;
  std::uint32_t epoch = 0;
  std::uint64_t frame = 0;
  std::uint64_t time_us = 0;  ///< simulated time, µs
  std::uint32_t pieces = 1;   ///< of this frame in this epoch; 0 in a mending piece
  std::uint32_t piece = 0;    ///< which of them
  std::uint32_t first_block = 0;
  std::uint32_t blocks = 1;
  std::uint32_t all_blocks = 1;  ///< of the epoch in this frame; it may grow from frame to frame
};
template <class V>
void visit(V& v, PieceHead& m) {
  v.natural("stream", m.stream, 0, 255);
  v.choice("kind", m.kind, kPieceKinds);
  v.natural("run", m.run, 0, 0xffffffff);
  v.natural("epoch", m.epoch, 0, 0xffffffff);
  v.natural("frame", m.frame, 0, wire::kMaxTick);
  v.natural("time_us", m.time_us, 0, 10'000'000'000'000);
  v.natural("pieces", m.pieces, 0, kMaxBlocks);
  v.natural("piece", m.piece, 0, kMaxBlocks - 1);
  v.natural("first_block", m.first_block, 0, kMaxBlocks - 1);
  v.natural("blocks", m.blocks, 1, kMaxBlocks);
  v.natural("all_blocks", m.all_blocks, 1, kMaxBlocks);
}

/// Follows the head of key and mending pieces: all that a peer needs to begin with this piece.
struct EpochHead {
  std::uint32_t particles = 1;    ///< at the epoch's start
  std::uint64_t first_frame = 0;  ///< of the epoch
  double tolerance = 0.001;       ///< m
  std::uint32_t origin[3] = {};   ///< corner of the cell order, lattice coordinate + 2^18
};
template <class V>
void visit(V& v, EpochHead& m) {
  v.natural("particles", m.particles, 1, kMaxParticles);
  v.natural("first_frame", m.first_frame, 0, wire::kMaxTick);
  v.real64("tolerance", m.tolerance, 1e-7, 1.0);
  v.natural("origin_x", m.origin[0], 0, (1u << kCoordinateBits) - 1);
  v.natural("origin_y", m.origin[1], 0, (1u << kCoordinateBits) - 1);
  v.natural("origin_z", m.origin[2], 0, (1u << kCoordinateBits) - 1);
}

/// Of an epoch of so many particles, at its start.
constexpr std::uint32_t block_count(std::uint32_t particles) {
  return (particles + kBlock - 1) / kBlock;
}
/// An epoch grows no further than this: what a peer keeps is bounded by how the epoch began.
constexpr std::uint32_t most_blocks(std::uint32_t particles) {
  const std::uint32_t grown = 2 * block_count(particles) + 64;
  return grown < kMaxBlocks ? grown : kMaxBlocks;
}
/// Of the epoch's first blocks; later ones carry their size.
constexpr int block_size(std::uint32_t particles, std::uint32_t block) {
  const std::uint32_t left = particles - block * kBlock;
  return left < kBlock ? static_cast<int>(left) : kBlock;
}

}  // namespace slosh::codec
