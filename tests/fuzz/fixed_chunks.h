// Files of chunks (host/keep/chunk.h) whose damage is behind their checksums: each chunk is made to say of
// itself what is there, so that what is wrong in it reaches whoever decodes it.
#pragma once

#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "host/keep/chunk.h"

namespace slosh::test {

/// Where in a chunk's head: its coding, its zeros, how long it is packed and unpacked, its checksum.
constexpr std::size_t kCodingAt = 1, kZerosAt = 2, kPackedAt = 4, kUnpackedAt = 8, kChecksumAt = 12;

inline void put_number(keep::Bytes& bytes, std::size_t at, std::size_t number) {
  const auto value = static_cast<std::uint32_t>(number);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// A chunk as it is, not packed: damage reaches its fields and not only zstd.
inline void append_stored(std::uint8_t type, keep::ByteView content, keep::Bytes& out) {
  const std::size_t at = out.size();
  out.resize(at + keep::kChunkHead);
  out[at] = type;
  put_number(out, at + kPackedAt, content.size());
  out.insert(out.end(), content.begin(), content.end());
}

/// Of the chunks behind the first `begin` bytes.
inline void fix_chunks(keep::Bytes& bytes, std::size_t begin) {
  for (std::size_t at = begin; at + keep::kChunkHead <= bytes.size();) {
    const std::size_t rest = bytes.size() - at - keep::kChunkHead;
    std::uint32_t packed = 0;
    std::memcpy(&packed, bytes.data() + at + kPackedAt, sizeof packed);
    const std::size_t length = std::min<std::size_t>(packed, rest);
    bytes[at + kCodingAt] &= 1;
    bytes[at + kZerosAt] = bytes[at + kZerosAt + 1] = 0;
    put_number(bytes, at + kPackedAt, length);
    if (bytes[at + kCodingAt] == 0) put_number(bytes, at + kUnpackedAt, length);
    uLong crc = ::crc32_z(0, bytes.data() + at, kChecksumAt);
    if (length > 0) crc = ::crc32_z(crc, bytes.data() + at + keep::kChunkHead, length);
    put_number(bytes, at + kChecksumAt, crc);
    at += keep::kChunkHead + length;
  }
}

}  // namespace slosh::test
