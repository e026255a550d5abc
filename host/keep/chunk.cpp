#include "host/keep/chunk.h"

#include <zlib.h>
#include <zstd.h>

#include <cstring>

namespace slosh::keep {
namespace {

enum Coding : std::uint8_t { kStored, kZstd };

// Fast: what is kept is mostly noise of the last digits.
constexpr int kZstdLevel = 1;

struct Head {
  std::uint8_t type = 0;
  std::uint8_t coding = kStored;
  std::uint16_t zero = 0;
  std::uint32_t packed = 0;
  std::uint32_t unpacked = 0;
  std::uint32_t crc = 0;
};
static_assert(sizeof(Head) == kChunkHead);

std::uint32_t crc_of(const Head& head, ByteView content) {
  std::uint8_t raw[kChunkHead];
  std::memcpy(raw, &head, sizeof head);
  const uLong before = ::crc32_z(0, raw, kChunkHead - sizeof head.crc);
  // To zlib a null pointer is the wish to begin anew.
  if (content.empty()) return static_cast<std::uint32_t>(before);
  return static_cast<std::uint32_t>(::crc32_z(before, content.data(), content.size()));
}

}  // namespace

void append_chunk(std::uint8_t type, ByteView content, Bytes& out) {
  const std::size_t begin = out.size();
  Head head{type, kZstd, 0, 0, static_cast<std::uint32_t>(content.size()), 0};
  out.resize(begin + kChunkHead + ZSTD_compressBound(content.size()));
  const std::size_t packed = ZSTD_compress(out.data() + begin + kChunkHead, out.size() - begin - kChunkHead,
                                           content.data(), content.size(), kZstdLevel);
  const bool smaller = !ZSTD_isError(packed) && packed < content.size();
  if (smaller && content.size() <= kMaxExpansion * packed) {
    head.packed = static_cast<std::uint32_t>(packed);
  } else {
    head.coding = kStored;
    head.packed = head.unpacked;
    if (!content.empty()) std::memcpy(out.data() + begin + kChunkHead, content.data(), content.size());
  }
  out.resize(begin + kChunkHead + head.packed);
  head.crc = crc_of(head, ByteView(out).subspan(begin + kChunkHead));
  std::memcpy(out.data() + begin, &head, sizeof head);
}

ChunkReader::ChunkReader(std::FILE* file) : file_(file) {
  const long here = std::ftell(file_);
  std::fseek(file_, 0, SEEK_END);
  const long end = std::ftell(file_);
  std::fseek(file_, here, SEEK_SET);
  if (here >= 0 && end >= here) {
    next_ = at_ = static_cast<std::uint64_t>(here);
    size_ = static_cast<std::uint64_t>(end);
  }
}

ChunkOutcome ChunkReader::damaged(std::string problem) {
  problem_ = std::move(problem) + " at byte " + std::to_string(at_);
  return ChunkOutcome::kDamaged;
}

ChunkOutcome ChunkReader::next(Chunk& chunk) {
  at_ = next_;
  if (at_ >= size_) return ChunkOutcome::kEnd;
  if (size_ - at_ < kChunkHead) return ChunkOutcome::kCutOff;
  Head head;
  if (std::fread(&head, 1, sizeof head, file_) != sizeof head) return ChunkOutcome::kCutOff;
  if (head.coding > kZstd || head.zero != 0 || head.packed > kLargestChunk || head.unpacked > kLargestChunk)
    return damaged("there is no chunk");
  if (head.coding == kStored ? head.unpacked != head.packed
                             : head.unpacked > kMaxExpansion * std::size_t{head.packed}) {
    return damaged("a chunk's sizes contradict each other");
  }
  if (size_ - at_ - kChunkHead < head.packed) return ChunkOutcome::kCutOff;
  packed_.resize(head.packed);
  if (std::fread(packed_.data(), 1, packed_.size(), file_) != packed_.size()) return ChunkOutcome::kCutOff;
  if (crc_of(head, packed_) != head.crc) return damaged("a chunk does not have its checksum");
  chunk.type = head.type;
  if (head.coding == kStored) {
    chunk.content.swap(packed_);
  } else {
    chunk.content.resize(head.unpacked);
    const std::size_t size =
        ZSTD_decompress(chunk.content.data(), chunk.content.size(), packed_.data(), packed_.size());
    if (ZSTD_isError(size) || size != head.unpacked) return damaged("a chunk does not unpack");
  }
  next_ = at_ + kChunkHead + head.packed;
  return ChunkOutcome::kChunk;
}

}  // namespace slosh::keep
