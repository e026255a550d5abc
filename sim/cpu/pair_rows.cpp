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

void PairRows::Writer::make_room() {
  row_ = rows_ + group_.count;
  if (count_ + 2 * kLanes <= row_->other.size()) return;
  const std::size_t room = std::max<std::size_t>(256, 2 * row_->other.size());
  row_->other.resize(room);
  row_->weight.resize(room);
}

// The rows of up to four particles, as long as the longest: what fills them up is nobody's pair.
void PairRows::Writer::put_group() {
  if (group_.count == 0) return;
  std::size_t longest = 0;
  for (std::uint32_t a = 0; a < group_.count; ++a) longest = std::max(longest, rows_[a].count);
  const std::size_t whole = kTogether * longest;
  if (chunk_.size + whole > chunk_.pairs.size())
    chunk_.pairs.resize(std::max<std::size_t>({4096, 2 * chunk_.pairs.size(), chunk_.size + whole}));
  Pair* const pairs = chunk_.pairs.data() + chunk_.size;
  for (std::uint32_t a = 0; a < kTogether; ++a) {
    const std::size_t count = a < group_.count ? rows_[a].count : 0;
    for (std::size_t k = 0; k < count; ++k)
      pairs[kTogether * k + a] = {rows_[a].weight[k], rows_[a].other[k]};
    for (std::size_t k = count; k < longest; ++k)
      pairs[kTogether * k + a] = {0.0f, static_cast<std::int32_t>(group_.first)};
  }
  group_.begin = static_cast<std::uint32_t>(chunk_.size);
  group_.end = static_cast<std::uint32_t>(chunk_.size + whole);
  chunk_.groups.push_back(group_);
  chunk_.size += whole;
  group_ = {};
}

}  // namespace slosh
