#include <algorithm>
#include <cmath>

#include "net/codec/block_code.h"
#include "net/codec/epoch.h"
#include "net/codec/piece.h"
#include "net/codec/piece_cut.h"
#include "net/codec/snapshot_codec.h"

namespace slosh {

using namespace codec;

namespace {

constexpr std::size_t kSmallestPiece = 1100;  // a block of any content fits
constexpr double kFirstFill = 0.93;           // of a piece, so that it holds for some frames
constexpr double kWastefulFill = 0.85;        // of all pieces
constexpr std::uint32_t kMendGroup = 4;       // blocks, aligned
constexpr std::uint64_t kAskedAgo = 30;       // frames that what is asked for may be on its way

}  // namespace

struct SnapshotEncoder::Impl {
  explicit Impl(const CodecOptions& o)
      : options(o),
        max_piece(std::max(o.max_piece, kSmallestPiece)),
        epoch(2.0 * o.tolerance, o.spacing),
        cutter(writer) {}

  CodecOptions options;
  std::size_t max_piece;
  Epoch epoch;
  double first_time = 0.0;  // s, of the epoch
  bool full = false;        // no more blocks fit into the epoch
  std::size_t present = 0;  // particles in the newest frame
  std::size_t snapshot_size = 0;
  bool started = false;

  // The frame.
  EncodedFrame out;
  std::uint32_t run = 0;
  std::uint64_t time_us = 0;
  BlockWriter writer;
  PieceCutter cutter;
  std::vector<std::vector<Piece>> mended;  // by group

  void temporal_pieces(const Snapshot& snapshot, bool grows, bool looks);
  void key_pieces(const Snapshot& snapshot);
  void hand_out(PieceKind kind);
  void hand_out_new(std::uint32_t first);
  void mend_group(std::uint32_t first, std::uint32_t end, std::vector<Piece>& to);
  std::uint32_t end_of_piece(std::uint32_t block) const;
  wire::Bytes head(PieceKind kind, std::uint32_t first, std::uint32_t count, std::uint32_t piece,
                   std::uint32_t of) const;
  std::size_t room(PieceKind kind) const {
    // The number of blocks may take a byte more by the time that the head is written.
    return max_piece - head(kind, kMaxBlocks - 1, 127, 127, 127).size() - 1;
  }
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
  head.all_blocks = std::max(1u, epoch.count());
  wire::Bytes bytes{static_cast<std::uint8_t>(wire::DatagramType::kSnapshotPiece)};
  wire::encode(head, bytes);
  if (kind == PieceKind::kTemporal) return bytes;
  EpochHead of_epoch;
  of_epoch.particles = epoch.particles();
  of_epoch.first_frame = epoch.first_frame();
  of_epoch.tolerance = options.tolerance;
  for (int a = 0; a < 3; ++a)
    of_epoch.origin[a] = static_cast<std::uint32_t>(epoch.origin()[a] + kCoordinateLimit);
  wire::encode(of_epoch, bytes);
  return bytes;
}

void SnapshotEncoder::Impl::hand_out(PieceKind kind) {
  const std::span<const Payload> payloads = cutter.payloads();
  const auto count = static_cast<std::uint32_t>(payloads.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const Payload& payload = payloads[i];
    auto bytes = std::make_shared<wire::Bytes>(head(kind, payload.first, payload.blocks, i, count));
    bytes->insert(bytes->end(), payload.bytes.begin(), payload.bytes.end());
    out.bytes += bytes->size();
    out.pieces.push_back({payload.first, payload.blocks, out.epoch, std::move(bytes)});
  }
}

void SnapshotEncoder::Impl::temporal_pieces(const Snapshot& snapshot, bool grows, bool looks) {
  const bool second = out.frame == epoch.first_frame() + 1;
  const bool at_kept = !second && cutter.keeps();
  const std::uint32_t known = epoch.count();
  cutter.cut(known, room(PieceKind::kTemporal), at_kept, second || at_kept ? 1.0 : kFirstFill,
             [&](std::uint32_t b, bool packed) { epoch.write_temporal(b, out.frame, packed, writer); });
  // Before the heads are written: they tell how many blocks there are.
  if (grows) full = !epoch.grow(snapshot, out.frame, looks);
  hand_out(PieceKind::kTemporal);
  // Pieces that have become small are cut anew in the next frame, where that makes them fewer.
  const auto pieces = static_cast<double>(cutter.payloads().size());
  const auto filled = static_cast<double>(out.bytes) / static_cast<double>(room(PieceKind::kTemporal));
  const bool wasteful = filled < kWastefulFill * pieces && filled < kFirstFill * (pieces - 1.0);
  cutter.keep(second || wasteful);
  if (known < epoch.count()) hand_out_new(known);
  epoch.forget_retired();
}

/// For everybody, by the coding that mends: these blocks have no past.
void SnapshotEncoder::Impl::hand_out_new(std::uint32_t first) {
  const std::size_t pieces = out.pieces.size();
  mend_group(first, epoch.count(), out.pieces);
  for (std::size_t i = pieces; i < out.pieces.size(); ++i) out.bytes += out.pieces[i].bytes->size();
}

void SnapshotEncoder::Impl::key_pieces(const Snapshot& snapshot) {
  epoch.begin(snapshot, out.frame, options.shell_only);
  first_time = snapshot.rigid.time;
  snapshot_size = snapshot.positions.size();
  full = false;
  started = true;
  cutter.cut(epoch.count(), room(PieceKind::kKey), false, 1.0,
             [&](std::uint32_t b, bool) { epoch.write_key(b, writer); });
  hand_out(PieceKind::kKey);
  cutter.forget();
}

void SnapshotEncoder::Impl::mend_group(std::uint32_t first, std::uint32_t end, std::vector<Piece>& to) {
  const std::size_t space = room(PieceKind::kMend) - kSlack;
  writer.start();
  std::uint32_t block = first;
  for (; block < end; ++block) {
    const BlockWriter::Mark mark = writer.mark();
    epoch.write_mend(block, writer);
    if (block == first || writer.size() <= space) continue;
    writer.back_to(mark);
    break;
  }
  auto bytes = std::make_shared<wire::Bytes>(head(PieceKind::kMend, first, block - first, 0, 0));
  writer.finish(*bytes);
  to.push_back({first, block - first, out.epoch, std::move(bytes)});
  if (block < end) mend_group(block, end, to);
}

/// Behind the last block that shares the temporal piece of this one in the next frame, as far as known.
std::uint32_t SnapshotEncoder::Impl::end_of_piece(std::uint32_t block) const {
  for (const Payload& payload : cutter.payloads()) {
    if (payload.first > block) return payload.first;
  }
  return epoch.count();
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
  // An epoch has no place for who comes while it lasts.
  const auto present = static_cast<std::size_t>(snapshot.fluid_index.size() -
                                                std::ranges::count(snapshot.fluid_index, std::uint8_t{255}));
  const bool came = present > i.present;
  i.present = present;
  i.out.key = other_world || new_epoch || came || i.full ||
              time - i.first_time >= i.options.epoch_seconds - 1e-9 || time < i.first_time;
  if (!other_world) {
    const bool looks = i.epoch.shell().looks(snapshot, i.out.frame - i.epoch.first_frame());
    i.epoch.follow(snapshot, looks);
    i.temporal_pieces(snapshot, !i.out.key && i.epoch.shell().follows(snapshot), looks);
  }
  if (i.out.key) {
    if (i.started) ++i.out.epoch;
    i.key_pieces(snapshot);
  }
  i.out.blocks = i.epoch.count();
  i.out.particles = i.epoch.sent();
  i.mended.assign((i.out.blocks + kMendGroup - 1) / kMendGroup, {});
  return i.out;
}

void SnapshotEncoder::mend(std::span<const wire::BlockRange> ranges, std::vector<Piece>& out) {
  Impl& i = *impl_;
  const std::uint32_t count = i.epoch.count();
  std::vector<bool> asked(i.mended.size());
  for (const wire::BlockRange& range : ranges) {
    const std::uint64_t end = std::min<std::uint64_t>(std::uint64_t{range.first} + range.count, count);
    for (std::uint64_t b = range.first; b < end; ++b) asked[b / kMendGroup] = true;
    if (range.first >= end) continue;
    // A piece is read up to the first block whose past is missing. Blocks that came behind it meanwhile have
    // been stuck since, and by the time that they are asked for, others are.
    const std::uint32_t piece_end = i.end_of_piece(static_cast<std::uint32_t>(end - 1));
    for (auto b = static_cast<std::uint32_t>(end); b < piece_end; ++b) {
      if (i.epoch.born(b) > i.epoch.first_frame() && i.epoch.born(b) + kAskedAgo >= i.out.frame)
        asked[b / kMendGroup] = true;
    }
  }
  for (std::uint32_t g = 0; g < asked.size(); ++g) {
    if (!asked[g]) continue;
    std::vector<Piece>& pieces = i.mended[g];
    if (pieces.empty()) i.mend_group(g * kMendGroup, std::min((g + 1) * kMendGroup, count), pieces);
    out.insert(out.end(), pieces.begin(), pieces.end());
  }
}

}  // namespace slosh
