// What checkpoints and recordings are made of: chunks that each say what they are and prove that they are
// whole.
//
// Sixteen bytes of head (type, coding, two zero bytes, bytes that follow, bytes unpacked, CRC-32 (zlib's) of
// the head before it and of what follows), then the content, zstd where that is smaller. Little-endian.
#pragma once

#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh::keep {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

constexpr std::size_t kChunkHead = 16;
/// Bytes of one chunk, packed or not: a state of eight million particles.
constexpr std::size_t kLargestChunk = std::size_t{1} << 28;
/// A chunk that unpacks to more times its size is not written packed and not believed.
constexpr std::size_t kMaxExpansion = 64;

/// Appends one chunk. `content` is at most kLargestChunk.
void append_chunk(std::uint8_t type, ByteView content, Bytes& out);

struct Chunk {
  std::uint8_t type = 0;
  Bytes content;
};

enum class ChunkOutcome : std::uint8_t {
  kChunk,
  kEnd,      ///< nothing follows
  kCutOff,   ///< the bytes end within this chunk
  kDamaged,  ///< what is there contradicts itself
};

/// Reads chunks from a file one by one, holding one at a time.
class ChunkReader {
 public:
  /// From the file's current place to its end; the file stays the caller's.
  explicit ChunkReader(std::FILE* file);
  ChunkOutcome next(Chunk& chunk);
  bool at_end() const { return next_ >= size_; }  ///< nothing follows the chunk of the last call
  std::uint64_t at() const { return at_; }  ///< bytes into the file: where the chunk of the last call begins
  const std::string& problem() const { return problem_; }

 private:
  ChunkOutcome damaged(std::string problem);

  std::FILE* file_;
  std::uint64_t size_ = 0;
  std::uint64_t at_ = 0;
  std::uint64_t next_ = 0;
  std::string problem_;
  Bytes packed_;
};

}  // namespace slosh::keep
