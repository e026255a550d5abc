// Stream bytes on their way out: kept, at a fixed address, until the other side has acknowledged them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "net/quic/compat.h"

namespace slosh::quic {

class StreamOutbox {
 public:
  /// Copies `bytes` in. False when `limit` bytes a connection would be passed, or after an end.
  bool push(std::int64_t stream, std::span<const std::uint8_t> bytes, bool end, std::size_t limit);

  /// The same without a copy: holds on to `bytes` until they are acknowledged.
  bool push(std::int64_t stream, std::shared_ptr<const std::vector<std::uint8_t>> bytes, bool end,
            std::size_t limit);

  /// A stream that has something to send and is not blocked, taking turns; -1 = none.
  std::int64_t next() const;
  bool pending() const { return next() >= 0; }
  /// Nothing unsent, nothing unacknowledged.
  bool settled() const { return held_ == 0 && !pending_end(); }

  /// Points `out` at the unsent bytes of `stream`; `end` when they reach its end. Returns how many of `out`
  /// are used.
  std::size_t gather(std::int64_t stream, std::span<ngtcp2_vec> out, bool& end) const;
  void sent(std::int64_t stream, std::size_t count, bool with_end);
  void acknowledged(std::int64_t stream, std::uint64_t count);
  void block(std::int64_t stream);
  void unblock_all();
  /// The other side wants no more of it: the bytes stay where they are until drop().
  void abandon(std::int64_t stream);
  /// The library is done with the stream.
  void drop(std::int64_t stream);

 private:
  static constexpr std::size_t kChunk = 16 << 10;  // bytes; small writes share one
  struct Chunk {
    std::unique_ptr<std::uint8_t[]> own;
    std::shared_ptr<const std::vector<std::uint8_t>> shared;  // in place of `own`; always full
    const std::uint8_t* data() const { return shared ? shared->data() : own.get(); }
    std::size_t size = 0;
    std::size_t capacity = 0;
  };
  struct Stream {
    std::deque<Chunk> chunks;
    std::size_t freed = 0;      // acknowledged bytes of the first chunk
    std::size_t in_flight = 0;  // sent, not acknowledged
    std::size_t unsent = 0;
    bool end = false;
    bool end_sent = false;
    bool blocked = false;
  };
  static bool wants(const Stream& stream) {
    return !stream.blocked && (stream.unsent > 0 || (stream.end && !stream.end_sent));
  }
  bool pending_end() const;

  std::map<std::int64_t, Stream> streams_;
  std::size_t held_ = 0;    // bytes, all streams
  std::int64_t last_ = -1;  // whose turn it was
};

}  // namespace slosh::quic
