// Where a frame's blocks are cut into pieces.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "net/codec/block_code.h"

namespace slosh::codec {

struct Payload {
  std::uint32_t first = 0, blocks = 0;
  std::vector<std::uint8_t> bytes;  ///< the entropy-coded stream
};

constexpr std::size_t kSlack = 12;  ///< bytes that the writer's size may be off

class PieceCutter {
 public:
  explicit PieceCutter(BlockWriter& writer) : writer_(writer) {}

  /// The next frame's cuts start from nothing.
  void forget() { age_ = 0; }
  /// Whether the cuts are old enough to be left, or none are kept. A peer that lacks a piece lacks what it
  /// reaches into: pieces keep to the same blocks for a while.
  bool keeps() const { return age_ > 0 && age_ < kKeepFrames; }
  /// After a frame: its cuts are the next one's, unless `anew`.
  void keep(bool anew) {
    age_ = anew ? 0 : keeps() ? age_ + 1 : 1;
    cuts_.clear();
    for (const Payload& payload : payloads()) cuts_.push_back(payload.first);
  }

  /// Fills payloads of at most `room` bytes block by block with code(block, packed): one ends where `fill` of
  /// its room is taken, and at the kept cuts.
  template <class Code>
  void cut(std::uint32_t count, std::size_t room, bool at_kept, double fill, Code&& code);
  std::span<const Payload> payloads() const { return {payloads_.data(), used_}; }

 private:
  static constexpr int kKeepFrames = 30;

  BlockWriter& writer_;
  std::vector<Payload> payloads_;  // the first used_ of them
  std::size_t used_ = 0;
  std::vector<std::uint32_t> cuts_;  // blocks at which pieces start
  int age_ = 0;                      // frames; 0: no cuts are kept
};

template <class Code>
void PieceCutter::cut(std::uint32_t count, std::size_t room, bool at_kept, double fill, Code&& code) {
  used_ = 0;
  const auto limit = static_cast<std::size_t>(fill * static_cast<double>(room - kSlack));
  std::size_t next_cut = 0;
  for (std::uint32_t first = 0; first < count;) {
    while (at_kept && next_cut < cuts_.size() && cuts_[next_cut] <= first) ++next_cut;
    std::uint32_t end = at_kept && next_cut < cuts_.size() ? cuts_[next_cut] : count;
    if (payloads_.size() <= used_) payloads_.emplace_back();
    Payload& payload = payloads_[used_++];
    do {
      writer_.start();
      std::uint32_t block = first;
      for (; block < end; ++block) {
        const BlockWriter::Mark mark = writer_.mark();
        code(block, false);
        if (writer_.size() <= (block == first ? room - kSlack : limit)) continue;
        writer_.back_to(mark);
        if (block > first) break;
        code(block, true);  // by itself a block always fits
      }
      payload.bytes.clear();
      writer_.finish(payload.bytes);
      payload.first = first;
      payload.blocks = block - first;
      end = block - 1;
    } while (payload.bytes.size() > room && payload.blocks > 1);
    first += payload.blocks;
  }
}

}  // namespace slosh::codec
