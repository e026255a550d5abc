// One block's bits, both ways. net/WIRE_FORMAT.md, "Snapshot piece", has the layout.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "net/codec/entropy.h"
#include "net/codec/lattice.h"
#include "net/codec/models.h"
#include "net/codec/motion.h"

namespace slosh::codec {

constexpr int kFirstClass = 5;  ///< what a piece's first block is compared with

/// Who is in a block.
struct BlockMembers {
  std::uint8_t slot[kBlock];   ///< their places in the block at the epoch's start, ascending
  std::uint8_t fluid[kBlock];  ///< Snapshot::fluid_index
  int count = 0;
  bool born = false;  ///< its first frame: the next one's coding has no velocities
};

/// What is known of a block before its bits are read, and what they change.
struct Block : BlockMembers {
  BlockPoints points;  ///< of the particles that are still there, in the epoch's order
};

enum class BlockMode : std::uint8_t { kRest, kMoved, kMovedSomeRetired, kPacked };

/// Removes the `gone` (indices into the block's present particles, ascending, `many` of them).
void remove_members(const std::uint8_t* gone, int many, BlockMembers& block);
void remove_points(const std::uint8_t* gone, int many, int count, BlockPoints& points);

/// Blocks of one piece in turn.
class BlockWriter {
 public:
  BlockWriter();
  void start();
  /// Bytes so far, to within a few.
  std::size_t size() const { return out_.size(); }
  struct Mark {
    EntropyEncoder::Mark out;
    int class_before[3];
  };
  Mark mark() const { return {out_.mark(), {class_before_[0], class_before_[1], class_before_[2]}}; }
  void back_to(const Mark& mark) {
    out_.back_to(mark.out);
    std::copy(mark.class_before, mark.class_before + 3, class_before_);
  }

  /// `block` and its points `now` are without the `gone`; `last` and `before` (null in a block's second
  /// frame) still have them.
  void temporal(const BlockMembers& block, const BlockPoints& now, const BlockPoints& last,
                const BlockPoints* before, const std::uint8_t* gone, int many, bool packed);
  /// Points in rising Morton order from `origin`.
  void key(const BlockMembers& block, const BlockPoints& now, const std::int32_t origin[3]);
  /// Any points; `size` is the block's in its first frame. A `later` block came after the epoch's start and
  /// tells its size and whether it is born in this frame.
  void mend(const BlockMembers& block, const BlockPoints& now, int size, bool later);
  void finish(std::vector<std::uint8_t>& out) { out_.finish(out); }

 private:
  void moved(int count, const BlockPoints& now, const BlockPoints& last, const BlockPoints* before);
  void choose_blend(int count, const BlockPoints& displaced, BlockMotion& motion, std::uint32_t scatter[3]);
  void choose_drift(int count, const BlockPoints& displaced, BlockMotion& motion, std::uint32_t scatter[3]);
  void axis(int a, int count, const std::int32_t* displaced, const std::int32_t* predicted,
            std::uint32_t scatter);
  void wide_axis(const std::int32_t* displaced, const std::int32_t* predicted, int count, int klass);
  void beyond(std::int32_t residual);
  void points(int count, const BlockPoints& now);
  void fluids(const BlockMembers& block);
  void retired(const std::uint8_t* gone, int many);

  EntropyEncoder out_;
  int class_before_[3] = {};
};

/// The other way. Each returns null or what is wrong in words; the block is then not to be used.
class BlockReader {
 public:
  explicit BlockReader(std::span<const std::uint8_t> in);
  bool started() const { return in_.started(); }
  bool ended() const { return in_.ended(); }

  /// `block` is as in the frame before; `before`, with the same particles, is null in a block's second frame.
  const char* temporal(Block& block, const BlockPoints* before);
  const char* key(Block& block, int size, const std::int32_t origin[3]);
  const char* mend(Block& block, int size, bool later);

 private:
  const char* moved(Block& block, const BlockPoints* before);
  bool axis(const std::int32_t* predicted, int count, int klass, std::int32_t* at);
  std::int32_t residual_of(int symbol);
  const char* points(Block& block);
  const char* fluids(Block& block);
  const char* retired(Block& block, const BlockPoints*& before, BlockPoints& space);

  EntropyDecoder in_;
  int class_before_[3] = {};
};

}  // namespace slosh::codec
