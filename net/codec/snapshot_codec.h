// Particles on the wire: cell order, an integer lattice of a stated tolerance, blocks that code themselves
// alone (intra) or from the block's last frames (temporal), pieces of a datagram's size.
//
// A stream is one encoder's output at one rate, tolerance and content. It runs through epochs: at the start
// of each the particles are ordered anew by cell, cut into blocks and sent intra, all of them (a key frame);
// up to the next, a block is the same particles, so that frame k is coded as what differs from k−1 and k−2.
// Where only the shell is sent, particles that come to the surface within an epoch come in as new blocks
// behind its last one, and those that have gone inside retire. Both codings give bitwise identical lattice
// points, so that a block that a peer missed is mended for that peer alone by its intra coding, and goes on
// temporal.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "net/wire/messages.h"
#include "sim/snapshot.h"

namespace slosh {

struct CodecOptions {
  std::uint8_t stream = 0;   ///< number that pieces carry
  double tolerance = 0.001;  ///< m: a decoded coordinate is off by at most this
  double spacing = 0.01;     ///< m between particles; how far a shell's member hides that others are missing
  std::size_t max_piece = 1100;  ///< bytes of a piece, type byte included
  double epoch_seconds = 1.0;    ///< simulated s between key frames
  bool shell_only = false;       ///< only what is seen from outside (Snapshot::shell)
};

struct Piece {
  std::uint32_t first_block = 0;
  std::uint32_t blocks = 1;
  std::uint32_t epoch = 0;                                 ///< that the blocks are numbered in
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;  ///< a whole datagram
};

struct EncodedFrame {
  std::uint64_t frame = 0;  ///< rises by one with every encode()
  std::uint32_t epoch = 0;
  bool key = false;           ///< starts an epoch
  std::uint32_t blocks = 0;   ///< of the epoch so far
  std::size_t particles = 0;  ///< sent
  std::size_t bytes = 0;      ///< of all pieces
  std::vector<Piece> pieces;
};

/// One thread. encode() takes about half a millisecond for 32 768 particles and does not allocate in the
/// steady state but for the pieces that it hands out.
class SnapshotEncoder {
 public:
  explicit SnapshotEncoder(const CodecOptions& options);
  ~SnapshotEncoder();
  SnapshotEncoder(SnapshotEncoder&&) noexcept;
  SnapshotEncoder& operator=(SnapshotEncoder&&) noexcept;

  /// The next frame. `new_epoch` asks for a key frame now (somebody joined); a change of `run` or of the
  /// number of particles makes one by itself. Valid until the next call. At an epoch's start the frame is
  /// given in both orders (its last temporal one, and the new key), so that a viewer can interpolate up to it
  /// and on from it.
  const EncodedFrame& encode(const Snapshot& snapshot, std::uint32_t run, bool new_epoch = false);

  /// Intra pieces of the newest frame for these blocks, each coded at most once a frame whoever asks. A peer
  /// that lost a block needs it in two frames on end, then temporal pieces do again.
  void mend(std::span<const wire::BlockRange> blocks, std::vector<Piece>& out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One instant as a peer has it.
struct DecodedFrame {
  std::uint64_t frame = 0;
  std::uint32_t epoch = 0;
  std::uint32_t run = 0;
  double time = 0.0;                 ///< simulated s
  double complete = 0.0;             ///< share of the particles that are of this frame; the rest carried on
  std::vector<glm::vec3> positions;  ///< the epoch's order; later frames of it may have more, behind
  std::vector<std::uint8_t> fluid_index;  ///< 255 = retired
};

/// One thread. Takes pieces in any order, late ones are dropped, damaged ones refused.
class SnapshotDecoder {
 public:
  SnapshotDecoder();
  ~SnapshotDecoder();
  SnapshotDecoder(SnapshotDecoder&&) noexcept;
  SnapshotDecoder& operator=(SnapshotDecoder&&) noexcept;

  /// One datagram (type byte included). A fault leaves everything as it was.
  wire::Fault take(std::span<const std::uint8_t> datagram);

  /// The newest instant of which all pieces came, or that is older than the newest piece's frame by at least
  /// `patience` frames, and that was not given yet; in order. Blocks whose piece is missing are carried on by
  /// their last motion.
  std::optional<DecodedFrame> next(std::uint32_t patience = 1);

  /// What to tell the host now; resets its counters.
  wire::SnapshotFeedback feedback();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace slosh
