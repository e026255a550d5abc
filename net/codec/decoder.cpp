#include <algorithm>
#include <deque>
#include <utility>

#include "net/codec/block_store.h"
#include "net/codec/piece_read.h"
#include "net/codec/snapshot_codec.h"

namespace slosh {

using namespace codec;

namespace {

constexpr std::size_t kMaxWaiting = 256;  // pieces that came before what they build on
constexpr std::size_t kMaxFrames = 16;    // not yet given
constexpr double kCarrySeconds = 0.3;     // a lost block moves on for so long, then stands

struct Instant {
  std::uint64_t frame = 0;
  std::uint32_t epoch = 0;
  double time = 0.0;
  std::uint32_t came = 0;    // blocks
  std::uint32_t blocks = 0;  // of the epoch in this frame
  auto key() const { return std::pair(frame, epoch); }
};

}  // namespace

struct SnapshotDecoder::Impl {
  std::vector<std::unique_ptr<BlockStore>> stores;  // newest last, at most two
  std::deque<Instant> instants;                     // not yet given, in order
  std::pair<std::uint64_t, std::uint32_t> given{0, 0};
  bool any_given = false;
  double given_time = 0.0;
  double frame_seconds = 1.0 / 60.0;

  struct Waiting {
    std::vector<std::uint8_t> bytes;
    PieceHead head;
  };
  std::vector<Waiting> waiting;
  BlockList blocks;            // of the piece being read
  std::uint64_t progress = 0;  // blocks that came, ever

  // For feedback.
  std::uint32_t stream = 0;
  std::uint64_t newest_frame = 0;
  std::uint32_t newest_epoch = 0;
  bool any = false;
  std::uint32_t pieces = 0, pieces_sent = 0;

  BlockStore* store_of(std::uint32_t epoch) {
    for (auto& store : stores) {
      if (store->epoch() == epoch) return store.get();
    }
    return nullptr;
  }
  wire::Fault read(const PieceView& piece, std::span<const std::uint8_t> datagram, bool may_wait);
  void count(const PieceHead& head);
  void commit(const PieceView& piece, BlockStore& store);
  void follow_up(std::uint32_t epoch, std::uint64_t frame);
  void keep(const PieceHead& head, std::span<const std::uint8_t> datagram);
  void fill(const Instant& instant, const BlockStore& store, DecodedFrame& out) const;
};

wire::Fault SnapshotDecoder::Impl::read(const PieceView& piece, std::span<const std::uint8_t> datagram,
                                        bool may_wait) {
  const PieceHead& head = piece.head;
  BlockStore* store = store_of(head.epoch);
  std::unique_ptr<BlockStore> fresh;
  if (!store) {
    if (!stores.empty() && head.epoch < stores.back()->epoch()) return {};  // late
    if (head.kind == PieceKind::kTemporal) {
      if (may_wait) keep(head, datagram);
      return {};
    }
    fresh = std::make_unique<BlockStore>(head.epoch, head.run, piece.epoch);
    store = fresh.get();
  }
  if (wire::Fault fault = check_fits(piece, *store)) return fault;
  if (wire::Fault fault = read_blocks(piece, *store, blocks)) return fault;
  if (fresh) {
    if (stores.size() == 2) stores.erase(stores.begin());
    stores.push_back(std::move(fresh));
    std::erase_if(instants, [&](const Instant& i) { return !store_of(i.epoch); });
  }
  if (may_wait) count(head);
  const bool whole = blocks.size() == head.blocks;
  commit(piece, *store);
  if (!whole && may_wait) keep(head, datagram);
  return {};
}

void SnapshotDecoder::Impl::count(const PieceHead& head) {
  if (head.kind == PieceKind::kMend) {
    if (!any) newest_frame = head.frame, newest_epoch = head.epoch;
    any = true;
    return;
  }
  stream = head.stream;
  ++pieces;
  const bool newer_frame = !any || head.frame > newest_frame;
  if (newer_frame || head.epoch > newest_epoch) {
    // Frames of which nothing came had about as many pieces as this one.
    const std::uint64_t between =
        any && newer_frame ? std::min<std::uint64_t>(head.frame - newest_frame - 1, 100) : 0;
    pieces_sent += static_cast<std::uint32_t>((between + 1) * std::min(head.pieces, 10000u));
  }
  newest_frame = any ? std::max(newest_frame, head.frame) : head.frame;
  newest_epoch = any ? std::max(newest_epoch, head.epoch) : head.epoch;
  any = true;
}

void SnapshotDecoder::Impl::commit(const PieceView& piece, BlockStore& store) {
  const PieceHead& head = piece.head;
  store.grow(head.all_blocks, head.frame);
  std::uint32_t fresh = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i)
    fresh += store.put(head.first_block + static_cast<std::uint32_t>(i), head.frame, blocks[i]);
  progress += fresh;
  if (fresh == 0) return;
  const auto key = std::pair(head.frame, head.epoch);
  if (!any_given || key > given) {
    auto at = std::lower_bound(instants.begin(), instants.end(), key,
                               [](const Instant& i, const auto& k) { return i.key() < k; });
    if (at == instants.end() || at->key() != key)
      at = instants.insert(at, {head.frame, head.epoch, 1e-6 * static_cast<double>(head.time_us), 0, 0});
    at->came += fresh;
    at->blocks = std::max(at->blocks, head.all_blocks);
    if (instants.size() > kMaxFrames) instants.pop_front();
  }
  follow_up(head.epoch, head.frame);
}

void SnapshotDecoder::Impl::keep(const PieceHead& head, std::span<const std::uint8_t> datagram) {
  if (any && head.frame + kKeptFrames < newest_frame) return;
  for (const Waiting& w : waiting) {
    if (w.head.frame == head.frame && w.head.epoch == head.epoch && w.head.first_block == head.first_block)
      return;
  }
  if (waiting.size() >= kMaxWaiting) waiting.erase(waiting.begin());
  waiting.push_back({{datagram.begin(), datagram.end()}, head});
}

/// What waited for this frame of these blocks may be read now.
void SnapshotDecoder::Impl::follow_up(std::uint32_t epoch, std::uint64_t frame) {
  std::erase_if(waiting, [&](const Waiting& w) { return w.head.frame + kKeptFrames < newest_frame; });
  for (std::size_t i = 0; i < waiting.size(); ++i) {
    const PieceHead& head = waiting[i].head;
    if (head.epoch != epoch || head.frame <= frame || head.frame > frame + 2) continue;
    BlockStore* store = store_of(epoch);
    if (!store) return;
    bool more = false;  // only when a block that stopped it no longer does
    bool all = true;
    if (std::uint64_t{head.first_block} + head.blocks > store->blocks()) continue;
    for (std::uint32_t b = head.first_block; b < head.first_block + head.blocks; ++b) {
      if (!store->can_follow(b, head.frame)) {
        all = false;
        break;
      }
      more |= store->find(b, head.frame) == nullptr;
    }
    if (!more) continue;
    const std::vector<std::uint8_t> bytes = all ? std::move(waiting[i].bytes) : waiting[i].bytes;
    if (all) waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(i));
    const std::uint64_t before = progress;
    PieceView piece;
    if (!read_heads(bytes, piece)) read(piece, bytes, false);
    // The list may have changed. Without progress nobody looks again: a damaged piece must not keep us here.
    if (progress == before) return;
    i = static_cast<std::size_t>(-1);
  }
}

SnapshotDecoder::SnapshotDecoder() : impl_(std::make_unique<Impl>()) {}
SnapshotDecoder::~SnapshotDecoder() = default;
SnapshotDecoder::SnapshotDecoder(SnapshotDecoder&&) noexcept = default;
SnapshotDecoder& SnapshotDecoder::operator=(SnapshotDecoder&&) noexcept = default;

wire::Fault SnapshotDecoder::take(std::span<const std::uint8_t> datagram) {
  PieceView piece;
  if (wire::Fault fault = read_heads(datagram, piece)) return fault;
  return impl_->read(piece, datagram, true);
}

void SnapshotDecoder::Impl::fill(const Instant& instant, const BlockStore& store, DecodedFrame& out) const {
  const EpochHead& head = store.head();
  const double step = 2.0 * head.tolerance;
  out.frame = instant.frame;
  out.epoch = instant.epoch;
  out.run = store.run();
  out.time = instant.time;
  const std::uint32_t at_start = block_count(head.particles);
  const std::size_t places =
      instant.blocks > at_start ? std::size_t{instant.blocks} * kBlock : std::size_t{head.particles};
  out.positions.assign(places, glm::vec3(0.0f));
  out.fluid_index.assign(places, kRetired);
  std::uint64_t exact = 0, all = 0;
  for (std::uint32_t b = 0; b < instant.blocks; ++b) {
    const auto size = static_cast<std::uint64_t>(b < at_start ? block_size(head.particles, b) : kBlock);
    all += size;
    std::uint64_t found = 0;
    const Block* block = store.nearest(b, instant.frame, found);
    if (!block) continue;
    BlockPoints space;
    const BlockPoints* earlier = nullptr;
    double ahead = 0.0;  // frames
    if (found == instant.frame) {
      exact += size;
    } else if (found < instant.frame) {
      if (const Block* previous = found > 0 ? store.find(b, found - 1) : nullptr) {
        earlier = match_points(*block, *previous, space);
        ahead = std::min(static_cast<double>(instant.frame - found), kCarrySeconds / frame_seconds);
      }
    }
    const std::size_t base = std::size_t{b} * kBlock;
    for (int i = 0; i < block->count; ++i) {
      const std::size_t to = base + block->slot[i];
      out.fluid_index[to] = block->fluid[i];
      for (int a = 0; a < 3; ++a) {
        double at = block->points.at[a][i];
        if (ahead > 0.0) at += ahead * (at - earlier->at[a][i]);
        out.positions[to][a] = static_cast<float>(step * at);
      }
    }
  }
  out.complete = static_cast<double>(exact) / static_cast<double>(all);
}

std::optional<DecodedFrame> SnapshotDecoder::next(std::uint32_t patience) {
  Impl& i = *impl_;
  if (i.instants.empty()) return std::nullopt;
  const Instant instant = i.instants.front();
  const BlockStore* store = i.store_of(instant.epoch);
  if (instant.came < instant.blocks && i.newest_frame < instant.frame + patience) return std::nullopt;
  i.instants.pop_front();
  if (i.any_given && instant.frame > i.given.first && instant.time > i.given_time)
    i.frame_seconds =
        std::max(1e-4, (instant.time - i.given_time) / static_cast<double>(instant.frame - i.given.first));
  i.given = instant.key();
  i.given_time = instant.time;
  i.any_given = true;
  DecodedFrame out;
  i.fill(instant, *store, out);
  return out;
}

wire::SnapshotFeedback SnapshotDecoder::feedback() {
  Impl& i = *impl_;
  wire::SnapshotFeedback out;
  out.stream = i.stream;
  out.frame = i.newest_frame;
  out.pieces = std::exchange(i.pieces, 0);
  out.pieces_sent = std::exchange(i.pieces_sent, 0);
  if (i.stores.empty()) return out;
  const BlockStore& store = *i.stores.back();
  out.epoch = store.epoch();
  // Up to this frame nothing more is waited for.
  const std::uint64_t first = store.head().first_frame;
  std::uint64_t closed = i.any_given && i.given.second == store.epoch() ? i.given.first : first;
  closed = std::max(closed, i.newest_frame >= first + 2 ? i.newest_frame - 2 : first);
  if (closed == first && i.newest_frame < first + 1 && !(i.any_given && i.given.second == store.epoch()))
    return out;
  for (std::uint32_t b = 0; b < store.blocks(); ++b) {
    std::uint64_t newest = 0;
    if (!store.is_there(b, closed)) continue;
    const bool follows = store.newest(b, newest) && newest >= closed &&
                         (store.find(b, newest)->born || store.find(b, newest - 1) != nullptr);
    if (follows) continue;
    if (!out.missing.empty() && out.missing.back().first + out.missing.back().count == b) {
      ++out.missing.back().count;
    } else if (out.missing.size() == 256) {
      break;
    } else {
      out.missing.push_back({b, 1});
    }
  }
  return out;
}

}  // namespace slosh
