#include "sim/cpu/pair_rows.h"

#include <algorithm>

namespace slosh {

void PairRows::clear(std::size_t chunks) {
  used_ = chunks;
  if (chunks_.size() < chunks) chunks_.resize(chunks);
  for (Chunk& chunk : chunks_) {
    chunk.size = 0;
    chunk.groups.clear();
  }
}

void PairRows::Chunk::make_room(std::size_t more) {
  if (size + more > pairs.size()) pairs.resize(std::max<std::size_t>({4096, 2 * pairs.size(), size + more}));
}

void PairRows::Writer::make_room() {
  row_ = rows_ + group_.count;
  if (count_ + 2 * kLanes <= row_->other.size()) return;
  const std::size_t room = std::max<std::size_t>(256, 2 * row_->other.size());
  row_->other.resize(room);
  row_->weight.resize(room);
}

PairRows::Pair* PairRows::Writer::take(const Walk& walk) {
  if (waits()) put_group();
  taken_ = walk.pairs();
  chunk_.make_room(taken_);
  return chunk_.pairs.data() + chunk_.size;
}

// The rows of up to four particles, as long as the longest: what fills them up is nobody's pair.
void PairRows::Writer::put_group() {
  std::size_t longest = 0;
  for (std::uint32_t a = 0; a < group_.count; ++a) longest = std::max(longest, rows_[a].count);
  const std::size_t whole = kTogether * longest;
  chunk_.make_room(taken_ + whole);
  Pair* const pairs = chunk_.pairs.data() + chunk_.size + taken_;
  for (std::uint32_t a = 0; a < kTogether; ++a) {
    const std::size_t count = a < group_.count ? rows_[a].count : 0;
    for (std::size_t k = 0; k < count; ++k)
      pairs[kTogether * k + a] = {rows_[a].weight[k], rows_[a].other[k]};
    for (std::size_t k = count; k < longest; ++k)
      pairs[kTogether * k + a] = {0.0f, static_cast<std::int32_t>(group_.first)};
  }
  close_group(taken_ + whole);
}

}  // namespace slosh
