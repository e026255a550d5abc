#include <algorithm>
#include <bit>

#include "net/codec/block_code.h"

namespace slosh::codec {

namespace {

int bit_count(std::uint64_t value) {
  return std::bit_width(value);
}

bool at_rest(const BlockPoints& now, const BlockPoints& last, int count) {
  for (int a = 0; a < 3; ++a) {
    if (!std::equal(now.at[a], now.at[a] + count, last.at[a])) return false;
  }
  return true;
}

}  // namespace

void remove_points(const std::uint8_t* gone, int many, int count, BlockPoints& points) {
  int kept = 0;
  for (int i = 0, next = 0; i < count; ++i) {
    if (next < many && gone[next] == i) {
      ++next;
      continue;
    }
    for (auto& axis : points.at) axis[kept] = axis[i];
    ++kept;
  }
}

void remove_members(const std::uint8_t* gone, int many, BlockMembers& block) {
  int kept = 0;
  for (int i = 0, next = 0; i < block.count; ++i) {
    if (next < many && gone[next] == i) {
      ++next;
      continue;
    }
    block.slot[kept] = block.slot[i];
    block.fluid[kept++] = block.fluid[i];
  }
  block.count = kept;
}

BlockWriter::BlockWriter() : out_(Models::get().steps) {}

void BlockWriter::start() {
  out_.clear();
  std::fill(class_before_, class_before_ + 3, kFirstClass);
}

void BlockWriter::retired(const std::uint8_t* gone, int many) {
  out_.bits(static_cast<std::uint64_t>(many - 1), 7);
  for (int i = 0; i < many; ++i) out_.bits(gone[i], 7);
}

void BlockWriter::temporal(const BlockMembers& block, const BlockPoints& now, const BlockPoints& last,
                           const BlockPoints* before, const std::uint8_t* gone, int many, bool packed) {
  if (many == 0 && at_rest(now, last, block.count)) {
    out_.bits(static_cast<std::uint64_t>(BlockMode::kRest), 2);
    return;
  }
  if (packed) {
    out_.bits(static_cast<std::uint64_t>(BlockMode::kPacked), 2);
    out_.bits(many > 0, 1);
    if (many > 0) retired(gone, many);
    points(block.count, now);
    return;
  }
  out_.bits(static_cast<std::uint64_t>(many > 0 ? BlockMode::kMovedSomeRetired : BlockMode::kMoved), 2);
  if (many == 0) {
    moved(block.count, now, last, before);
    return;
  }
  retired(gone, many);
  if (block.count == 0) return;
  const int count = block.count + many;
  BlockPoints kept_last = last, kept_before;
  remove_points(gone, many, count, kept_last);
  if (before) {
    kept_before = *before;
    remove_points(gone, many, count, kept_before);
    before = &kept_before;
  }
  moved(block.count, now, kept_last, before);
}

void BlockWriter::points(int count, const BlockPoints& now) {
  int width[3];
  std::int32_t least[3];
  for (int a = 0; a < 3; ++a) {
    const auto* at = now.at[a];
    least[a] = count > 0 ? *std::min_element(at, at + count) : 0;
    const std::int32_t most = count > 0 ? *std::max_element(at, at + count) : 0;
    width[a] = bit_count(static_cast<std::uint64_t>(most - least[a]));
    out_.bits(static_cast<std::uint64_t>(least[a] + kCoordinateLimit), kCoordinateBits);
    out_.bits(static_cast<std::uint64_t>(width[a]), 5);
  }
  for (int i = 0; i < count; ++i) {
    for (int a = 0; a < 3; ++a) out_.bits(static_cast<std::uint64_t>(now.at[a][i] - least[a]), width[a]);
  }
}

void BlockWriter::fluids(const BlockMembers& block) {
  const auto [least, most] = std::minmax_element(block.fluid, block.fluid + block.count);
  const int lowest = block.count > 0 ? *least : 0;
  const int width = block.count > 0 ? bit_count(static_cast<std::uint64_t>(*most - *least)) : 0;
  out_.bits(static_cast<std::uint64_t>(lowest), 8);
  out_.bits(static_cast<std::uint64_t>(width), 4);
  for (int i = 0; width > 0 && i < block.count; ++i)
    out_.bits(static_cast<std::uint64_t>(block.fluid[i] - lowest), width);
}

void BlockWriter::key(const BlockMembers& block, const BlockPoints& now, const std::int32_t origin[3]) {
  std::uint64_t codes[kBlock] = {};
  for (int i = 0; i < block.count; ++i) {
    const std::int32_t at[3] = {now.at[0][i], now.at[1][i], now.at[2][i]};
    codes[i] = morton(at, origin);
  }
  const int n = block.count;
  const int first = bit_count(codes[0]);
  const int typical = n > 1 ? bit_count((codes[n - 1] - codes[0]) / static_cast<std::uint64_t>(n - 1)) : 0;
  // A few far particles make the mean distance say little: then plain coordinates are shorter.
  int sorted_bits = 0;
  int width_bits = 24 * 3;
  for (int i = 1; i < n; ++i) sorted_bits += bit_count(codes[i] - codes[i - 1]) + 2;
  for (int a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax_element(now.at[a], now.at[a] + n);
    width_bits += n * bit_count(static_cast<std::uint64_t>(*high - *low));
  }
  const bool packed = width_bits < sorted_bits;
  out_.bits(packed, 1);
  if (packed) {
    points(block.count, now);
  } else {
    out_.bits(static_cast<std::uint64_t>(first), 6);
    out_.bits(codes[0], first);
    out_.bits(static_cast<std::uint64_t>(typical), 6);
    const Table& table = Models::get().code_distance;
    for (int i = 1; i < n; ++i) {
      const std::uint64_t distance = codes[i] - codes[i - 1];
      const int length = bit_count(distance);
      const int symbol = std::clamp(length - typical + 10, 0, 15);
      out_.symbol(table, symbol);
      if (symbol == 0 || symbol == 15) out_.bits(static_cast<std::uint64_t>(length), 6);
      if (length > 1) out_.bits(distance & ((std::uint64_t{1} << (length - 1)) - 1), length - 1);
    }
  }
  fluids(block);
}

void BlockWriter::mend(const BlockMembers& block, const BlockPoints& now, int size, bool later) {
  if (later) {
    out_.bits(static_cast<std::uint64_t>(size - 1), 7);
    out_.bits(block.born, 1);
  }
  const bool whole = block.count == size;
  out_.bits(!whole, 1);
  for (int slot = 0, i = 0; !whole && slot < size; ++slot) {
    const bool here = i < block.count && block.slot[i] == slot;
    out_.bits(here, 1);
    i += here;
  }
  points(block.count, now);
  fluids(block);
}

}  // namespace slosh::codec
