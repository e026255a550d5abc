#include <algorithm>
#include <cmath>

#include "net/codec/block_code.h"
#include "net/codec/cell_order.h"
#include "net/codec/piece.h"
#include "net/codec/snapshot_codec.h"

namespace slosh {

using namespace codec;

namespace {

constexpr std::size_t kSmallestPiece = 1100;  // a block of any content fits
constexpr int kKeepCuts = 30;                 // frames
constexpr double kFirstFill = 0.93;           // of a piece, so that it holds for some frames
constexpr std::uint64_t kLookEvery = 3;       // frames: a shell epoch's members change
constexpr int kLooksInside = 1;               // then a member leaves
constexpr std::size_t kSlack = 12;            // bytes that the size's estimate may be off
constexpr std::uint32_t kMendGroup = 4;       // blocks, aligned

struct Payload {
  std::uint32_t first = 0, blocks = 0;
  std::vector<std::uint8_t> bytes;
};

}  // namespace

struct SnapshotEncoder::Impl {
  explicit Impl(const CodecOptions& o)
      : options(o), step(2.0 * o.tolerance), max_piece(std::max(o.max_piece, kSmallestPiece)) {}

  CodecOptions options;
  double step;
  std::size_t max_piece;

  // The epoch.
  CellOrder order;                        // at its start
  std::vector<std::uint32_t> ids;         // in the snapshot, kBlock places a block
  std::vector<Block> blocks;              // newest points
  std::vector<BlockPoints> last, before;  // one and two frames ago, with the particles of those frames
  std::vector<std::uint8_t> gone;         // retired in this frame: of each block its list …
  std::vector<std::uint8_t> many;         // … and its length
  std::uint64_t first_frame = 0;
  double first_time = 0.0;
  std::uint32_t particles = 0;                      // at its start
  std::size_t later = 0;                            // particles that came since
  CellOrder more;                                   // those that come in this frame
  std::vector<std::uint8_t> is_member;              // of a shell's epoch, one a particle of the snapshot
  std::vector<std::uint8_t> seen_before, stay_out;  // the shell of the look before; who must not come in
  std::vector<std::uint8_t> sizes;                  // of the blocks, in their first frames
  std::vector<std::uint64_t> born;                  // and which those were
  bool full = false;                                // no more blocks fit in
  std::size_t snapshot_size = 0;
  bool started = false;

  // The frame.
  EncodedFrame out;
  std::uint32_t run = 0;
  std::uint64_t time_us = 0;
  BlockWriter writer;
  std::vector<Payload> payloads;
  std::size_t payload_count = 0;
  std::vector<std::uint32_t> cuts;  // blocks at which pieces start
  int cuts_age = 0;
  std::vector<std::vector<Piece>> mended;  // by group

  /// Whether this frame is one in which an epoch's members change with the shell.
  bool looks(const Snapshot& snapshot) const {
    return !is_member.empty() && snapshot.shell.size() == is_member.size() &&
           (out.frame - first_frame) % kLookEvery == 0;
  }
  /// A member that has been inside for so many looks goes: it costs more than it shows.
  bool leaves(std::uint32_t id, bool seen) {
    is_member[id] = seen ? std::uint8_t{1} : static_cast<std::uint8_t>(is_member[id] + 1);
    return is_member[id] > kLooksInside;
  }
  void take_positions(const Snapshot& snapshot);
  void temporal_pieces(const Snapshot& snapshot, bool ends);
  void grow(const Snapshot& snapshot);
  void add_blocks(const Snapshot& snapshot, const CellOrder& from);
  void hand_out_new(std::uint32_t first);
  void key_pieces(const Snapshot& snapshot);
  template <class Code>
  void cut(std::size_t room, bool keep_cuts, double fill, Code&& code);
  void hand_out(PieceKind kind);
  wire::Bytes head(PieceKind kind, std::uint32_t first, std::uint32_t count, std::uint32_t piece,
                   std::uint32_t of) const;
  std::size_t room(PieceKind kind) const {
    // The number of blocks may take a byte more by the time that the head is written.
    return max_piece - head(kind, kMaxBlocks - 1, 127, 127, 127).size() - 1;
  }
  void mend_group(std::uint32_t first, std::uint32_t end, std::vector<Piece>& to);
};

wire::Bytes SnapshotEncoder::Impl::head(PieceKind kind, std::uint32_t first, std::uint32_t count,
                                        std::uint32_t piece, std::uint32_t of) const {
  PieceHead head;
  head.stream = options.stream;
  head.kind = kind;
  head.run = run;
  head.epoch = out.epoch;
  head.frame = out.frame;
  head.time_us = time_us;
  head.pieces = of;
  head.piece = piece;
  head.first_block = first;
  head.blocks = count;
  head.all_blocks = std::max(1u, static_cast<std::uint32_t>(blocks.size()));
  wire::Bytes bytes{static_cast<std::uint8_t>(wire::DatagramType::kSnapshotPiece)};
  wire::encode(head, bytes);
  if (kind == PieceKind::kTemporal) return bytes;
  EpochHead epoch;
  epoch.particles = particles;
  epoch.first_frame = first_frame;
  epoch.tolerance = options.tolerance;
  for (int a = 0; a < 3; ++a)
    epoch.origin[a] = static_cast<std::uint32_t>(order.origin[a] + kCoordinateLimit);
  wire::encode(epoch, bytes);
  return bytes;
}

/// Fills pieces block by block: a piece ends where its room does, and at the kept cuts.
template <class Code>
void SnapshotEncoder::Impl::cut(std::size_t room, bool keep_cuts, double fill, Code&& code) {
  payload_count = 0;
  const auto count = static_cast<std::uint32_t>(blocks.size());
  const auto limit = static_cast<std::size_t>(fill * static_cast<double>(room - kSlack));
  std::size_t next_cut = 0;
  for (std::uint32_t first = 0; first < count;) {
    while (keep_cuts && next_cut < cuts.size() && cuts[next_cut] <= first) ++next_cut;
    std::uint32_t end = keep_cuts && next_cut < cuts.size() ? cuts[next_cut] : count;
    if (payloads.size() <= payload_count) payloads.emplace_back();
    Payload& payload = payloads[payload_count++];
    do {
      writer.start();
      std::uint32_t at = first;
      for (; at < end; ++at) {
        const BlockWriter::Mark mark = writer.mark();
        code(at, false);
        if (writer.size() <= (at == first ? room - kSlack : limit)) continue;
        writer.back_to(mark);
        if (at > first) break;
        code(at, true);  // by itself a block always fits
      }
      payload.bytes.clear();
      writer.finish(payload.bytes);
      payload.first = first;
      payload.blocks = at - first;
      end = at - 1;
    } while (payload.bytes.size() > room && payload.blocks > 1);
    first += payload.blocks;
  }
}

void SnapshotEncoder::Impl::hand_out(PieceKind kind) {
  for (std::size_t i = 0; i < payload_count; ++i) {
    const Payload& payload = payloads[i];
    auto bytes =
        std::make_shared<wire::Bytes>(head(kind, payload.first, payload.blocks, static_cast<std::uint32_t>(i),
                                           static_cast<std::uint32_t>(payload_count)));
    bytes->insert(bytes->end(), payload.bytes.begin(), payload.bytes.end());
    out.bytes += bytes->size();
    out.pieces.push_back({payload.first, payload.blocks, out.epoch, std::move(bytes)});
  }
}

/// Moves the epoch's particles on to the snapshot.
void SnapshotEncoder::Impl::take_positions(const Snapshot& snapshot) {
  const double per_step = 1.0 / step;
  std::swap(before, last);
  const bool look = looks(snapshot);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    Block& block = blocks[b];
    last[b] = block.points;
    block.born = false;
    std::uint8_t* list = gone.data() + b * kBlock;
    int lost = 0;
    for (int i = 0; i < block.count; ++i) {
      // Neighbours in the order lie far apart in the snapshot: the memory has to be told ahead.
      const std::size_t ahead = b * kBlock + static_cast<std::size_t>(i) + 24;
      if (ahead < ids.size()) __builtin_prefetch(&snapshot.positions[ids[ahead]]);
      const std::uint32_t id = ids[b * kBlock + block.slot[i]];
      std::int32_t point[3];
      if (!is_drawn(snapshot, id) || !to_lattice(snapshot.positions[id], per_step, point) ||
          (look && leaves(id, snapshot.shell[id] != 0))) {
        list[lost++] = static_cast<std::uint8_t>(i);
        if (id < is_member.size()) is_member[id] = 0;
        continue;
      }
      for (int a = 0; a < 3; ++a) block.points.at[a][i] = point[a];
    }
    many[b] = static_cast<std::uint8_t>(lost);
    if (lost > 0) remove_particles(list, lost, block);
  }
}

void SnapshotEncoder::Impl::temporal_pieces(const Snapshot& snapshot, bool ends) {
  const bool second = out.frame == first_frame + 1;
  // A peer that lacks a piece lacks what it reaches into: pieces keep to the same blocks for a while.
  const bool keep = !second && cuts_age > 0 && cuts_age < kKeepCuts;
  cut(room(PieceKind::kTemporal), keep, second || keep ? 1.0 : kFirstFill, [&](std::uint32_t b, bool packed) {
    writer.temporal(blocks[b], last[b], born[b] + 1 == out.frame ? nullptr : &before[b],
                    gone.data() + b * kBlock, many[b], packed);
  });
  const auto known = static_cast<std::uint32_t>(blocks.size());
  if (!ends) grow(snapshot);  // before the heads are written: they tell how many blocks there are
  hand_out(PieceKind::kTemporal);
  // Pieces that have become small are cut anew in the next frame.
  const std::size_t space = room(PieceKind::kTemporal) * payload_count;
  const bool wasteful = payload_count > 1 && out.bytes * 20 < space * 17;
  if (known < blocks.size()) hand_out_new(known);
  cuts_age = second || wasteful ? 0 : keep ? cuts_age + 1 : 1;
  cuts.clear();
  for (std::size_t i = 0; i < payload_count; ++i) cuts.push_back(payloads[i].first);
  // Where a particle has gone, the frame before loses it too: the next frame compares those that are left.
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (many[b] > 0) remove_points(gone.data() + b * kBlock, many[b], blocks[b].count + many[b], last[b]);
  }
}

/// New blocks behind the last one: `from` in its order.
void SnapshotEncoder::Impl::add_blocks(const Snapshot& snapshot, const CellOrder& from) {
  const auto many_new = static_cast<std::uint32_t>(from.ids.size());
  const std::size_t known = blocks.size();
  const std::size_t count = known + block_count(many_new);
  blocks.resize(count);
  last.resize(count);
  before.resize(count);
  gone.resize(count * kBlock);
  many.resize(count);
  sizes.resize(count);
  born.resize(count);
  ids.resize(count * kBlock);
  for (std::uint32_t n = 0; known + n < count; ++n) {
    const std::size_t b = known + n;
    Block& block = blocks[b];
    block.count = block_size(many_new, n);
    block.born = true;
    born[b] = out.frame;
    sizes[b] = static_cast<std::uint8_t>(block.count);
    many[b] = 0;
    for (int i = 0; i < block.count; ++i) {
      const std::size_t at = std::size_t{n} * kBlock + static_cast<std::size_t>(i);
      block.slot[i] = static_cast<std::uint8_t>(i);
      const std::uint32_t id = from.ids[at];
      ids[b * kBlock + static_cast<std::size_t>(i)] = id;
      if (id < is_member.size()) is_member[id] = 1;
      block.fluid[i] = id < snapshot.fluid_index.size() ? snapshot.fluid_index[id] : std::uint8_t{0};
      for (int a = 0; a < 3; ++a) block.points.at[a][i] = from.at[a][at];
    }
  }
}

/// Takes in what has come to the surface since the epoch's start.
void SnapshotEncoder::Impl::grow(const Snapshot& snapshot) {
  if (particles == 0 || !looks(snapshot)) return;
  // Much flickers at the surface: who comes in has been seen in two looks on end.
  stay_out = is_member;
  if (seen_before.size() == stay_out.size()) {
    for (std::size_t id = 0; id < stay_out.size(); ++id) stay_out[id] |= seen_before[id] == 0;
  }
  seen_before = snapshot.shell;
  more.sort(snapshot, 1.0 / step, true, stay_out);
  if (more.ids.empty()) return;
  const auto many_new = static_cast<std::uint32_t>(more.ids.size());
  full = blocks.size() + block_count(many_new) > most_blocks(particles);
  if (full) return;
  later += many_new;
  add_blocks(snapshot, more);
}

/// For everybody, by the coding that mends: these blocks have no past.
void SnapshotEncoder::Impl::hand_out_new(std::uint32_t first) {
  const std::size_t pieces = out.pieces.size();
  mend_group(first, static_cast<std::uint32_t>(blocks.size()), out.pieces);
  for (std::size_t i = pieces; i < out.pieces.size(); ++i) out.bytes += out.pieces[i].bytes->size();
}

void SnapshotEncoder::Impl::key_pieces(const Snapshot& snapshot) {
  order.sort(snapshot, 1.0 / step, options.shell_only);
  particles = static_cast<std::uint32_t>(order.ids.size());
  blocks.clear();
  later = 0;
  full = false;
  is_member.clear();
  if (options.shell_only && snapshot.shell.size() == snapshot.positions.size())
    is_member.resize(snapshot.positions.size());
  ids.clear();
  add_blocks(snapshot, order);
  first_frame = out.frame;
  first_time = snapshot.rigid.time;
  snapshot_size = snapshot.positions.size();
  started = true;
  cuts_age = 0;
  cut(room(PieceKind::kKey), false, 1.0, [&](std::uint32_t b, bool) { writer.key(blocks[b], order.origin); });
  hand_out(PieceKind::kKey);
}

void SnapshotEncoder::Impl::mend_group(std::uint32_t first, std::uint32_t end, std::vector<Piece>& to) {
  const std::size_t space = room(PieceKind::kMend) - kSlack;
  writer.start();
  std::uint32_t at = first;
  for (; at < end; ++at) {
    const BlockWriter::Mark mark = writer.mark();
    writer.mend(blocks[at], sizes[at], at >= block_count(particles));
    if (at == first || writer.size() <= space) continue;
    writer.back_to(mark);
    break;
  }
  auto bytes = std::make_shared<wire::Bytes>(head(PieceKind::kMend, first, at - first, 0, 0));
  writer.finish(*bytes);
  to.push_back({first, at - first, out.epoch, std::move(bytes)});
  if (at < end) mend_group(at, end, to);
}

SnapshotEncoder::SnapshotEncoder(const CodecOptions& options) : impl_(std::make_unique<Impl>(options)) {}
SnapshotEncoder::~SnapshotEncoder() = default;
SnapshotEncoder::SnapshotEncoder(SnapshotEncoder&&) noexcept = default;
SnapshotEncoder& SnapshotEncoder::operator=(SnapshotEncoder&&) noexcept = default;

const EncodedFrame& SnapshotEncoder::encode(const Snapshot& snapshot, std::uint32_t run, bool new_epoch) {
  Impl& i = *impl_;
  const double time = snapshot.rigid.time;
  const bool other_world = !i.started || run != i.run || snapshot.positions.size() != i.snapshot_size;
  i.out.pieces.clear();
  i.out.bytes = 0;
  if (i.started) ++i.out.frame;
  i.run = run;
  i.time_us = static_cast<std::uint64_t>(std::clamp(std::round(time * 1e6), 0.0, 1e13));
  if (!other_world) {
    i.take_positions(snapshot);
  }
  i.out.key = other_world || new_epoch || i.full || time - i.first_time >= i.options.epoch_seconds - 1e-9 ||
              time < i.first_time;
  if (!other_world) i.temporal_pieces(snapshot, i.out.key);
  if (i.out.key) {
    if (i.started) ++i.out.epoch;
    i.key_pieces(snapshot);
  }
  i.out.blocks = static_cast<std::uint32_t>(i.blocks.size());
  i.out.particles = i.particles + i.later;
  i.mended.assign((i.blocks.size() + kMendGroup - 1) / kMendGroup, {});
  return i.out;
}

void SnapshotEncoder::mend(std::span<const wire::BlockRange> ranges, std::vector<Piece>& out) {
  Impl& i = *impl_;
  const auto count = static_cast<std::uint32_t>(i.blocks.size());
  std::vector<bool> asked(i.mended.size());
  for (const wire::BlockRange& range : ranges) {
    const std::uint64_t end = std::min<std::uint64_t>(std::uint64_t{range.first} + range.count, count);
    for (std::uint64_t b = range.first; b < end; ++b) asked[b / kMendGroup] = true;
  }
  for (std::uint32_t g = 0; g < asked.size(); ++g) {
    if (!asked[g]) continue;
    std::vector<Piece>& pieces = i.mended[g];
    if (pieces.empty()) i.mend_group(g * kMendGroup, std::min((g + 1) * kMendGroup, count), pieces);
    out.insert(out.end(), pieces.begin(), pieces.end());
  }
}

}  // namespace slosh
