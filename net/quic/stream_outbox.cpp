#include "net/quic/stream_outbox.h"

#include <algorithm>
#include <cstring>

namespace slosh::quic {

bool StreamOutbox::push(std::int64_t id, std::span<const std::uint8_t> bytes, bool end, std::size_t limit) {
  if (bytes.size() > limit || held_ > limit - bytes.size()) return false;
  Stream& stream = streams_[id];
  if (stream.end) return false;
  stream.end = end;
  stream.unsent += bytes.size();
  held_ += bytes.size();
  while (!bytes.empty()) {
    if (stream.chunks.empty() || stream.chunks.back().size == stream.chunks.back().capacity) {
      Chunk chunk;
      chunk.capacity = std::max(kChunk, bytes.size());
      chunk.own = std::make_unique_for_overwrite<std::uint8_t[]>(chunk.capacity);
      stream.chunks.push_back(std::move(chunk));
    }
    Chunk& chunk = stream.chunks.back();
    const std::size_t count = std::min(bytes.size(), chunk.capacity - chunk.size);
    std::memcpy(chunk.own.get() + chunk.size, bytes.data(), count);
    chunk.size += count;
    bytes = bytes.subspan(count);
  }
  return true;
}

bool StreamOutbox::push(std::int64_t id, std::shared_ptr<const std::vector<std::uint8_t>> bytes, bool end,
                        std::size_t limit) {
  const std::size_t size = bytes->size();
  if (size > limit || held_ > limit - size) return false;
  Stream& stream = streams_[id];
  if (stream.end) return false;
  stream.end = end;
  if (size == 0) return true;
  stream.unsent += size;
  held_ += size;
  // A chunk with room behind it would be taken for small writes, out of order.
  if (!stream.chunks.empty()) stream.chunks.back().capacity = stream.chunks.back().size;
  Chunk chunk;
  chunk.size = chunk.capacity = size;
  chunk.shared = std::move(bytes);
  stream.chunks.push_back(std::move(chunk));
  return true;
}

std::int64_t StreamOutbox::next() const {
  const auto after = streams_.upper_bound(last_);
  for (auto it = after; it != streams_.end(); ++it)
    if (wants(it->second)) return it->first;
  for (auto it = streams_.begin(); it != after; ++it)
    if (wants(it->second)) return it->first;
  return -1;
}

bool StreamOutbox::pending_end() const {
  return std::any_of(streams_.begin(), streams_.end(),
                     [](const auto& entry) { return entry.second.end && !entry.second.end_sent; });
}

std::size_t StreamOutbox::gather(std::int64_t id, std::span<ngtcp2_vec> out, bool& end) const {
  const Stream& stream = streams_.at(id);
  std::size_t skip = stream.freed + stream.in_flight;
  std::size_t used = 0;
  std::size_t covered = 0;
  for (const Chunk& chunk : stream.chunks) {
    if (skip >= chunk.size) {
      skip -= chunk.size;
      continue;
    }
    if (used == out.size()) break;
    // The library takes it without const and only reads.
    out[used].base = const_cast<std::uint8_t*>(chunk.data()) + skip;
    out[used].len = chunk.size - skip;
    covered += out[used].len;
    skip = 0;
    ++used;
  }
  end = stream.end && covered == stream.unsent;
  return used;
}

void StreamOutbox::sent(std::int64_t id, std::size_t count, bool with_end) {
  const auto it = streams_.find(id);
  if (it == streams_.end()) return;
  it->second.unsent -= count;
  it->second.in_flight += count;
  if (with_end && it->second.unsent == 0) it->second.end_sent = true;
  last_ = id;
}

void StreamOutbox::acknowledged(std::int64_t id, std::uint64_t count) {
  const auto it = streams_.find(id);
  if (it == streams_.end()) return;
  Stream& stream = it->second;
  const std::size_t bytes = std::min<std::size_t>(count, stream.in_flight);
  stream.in_flight -= bytes;
  stream.freed += bytes;
  held_ -= bytes;
  while (!stream.chunks.empty() && stream.freed >= stream.chunks.front().size &&
         stream.chunks.front().size > 0) {
    // The last chunk may still take small writes: it goes when it is full or another follows.
    Chunk& first = stream.chunks.front();
    if (stream.chunks.size() == 1 && first.size < first.capacity) break;
    stream.freed -= first.size;
    stream.chunks.pop_front();
  }
}

void StreamOutbox::block(std::int64_t id) {
  const auto it = streams_.find(id);
  if (it != streams_.end()) it->second.blocked = true;
}

void StreamOutbox::unblock_all() {
  for (auto& [id, stream] : streams_) stream.blocked = false;
}

void StreamOutbox::abandon(std::int64_t id) {
  const auto it = streams_.find(id);
  if (it == streams_.end()) return;
  held_ -= it->second.unsent;
  it->second.unsent = 0;
  it->second.end = it->second.end_sent = true;
}

void StreamOutbox::drop(std::int64_t id) {
  const auto it = streams_.find(id);
  if (it == streams_.end()) return;
  held_ -= it->second.in_flight + it->second.unsent;
  streams_.erase(it);
}

}  // namespace slosh::quic
