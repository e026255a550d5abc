#include <algorithm>
#include <bit>
#include <cstdlib>

#include "net/codec/block_code.h"

namespace slosh::codec {

namespace {

constexpr int kFirstClass = 5;  // what a piece's first block is compared with

int bit_count(std::uint64_t value) {
  return std::bit_width(value);
}

bool at_rest(const BlockPoints& now, const BlockPoints& last, int count) {
  for (int a = 0; a < 3; ++a) {
    if (!std::equal(now.at[a], now.at[a] + count, last.at[a])) return false;
  }
  return true;
}

std::int32_t fine(std::int32_t displaced) {
  return std::clamp(displaced, -(1 << 15), 1 << 15) * (1 << kFine);
}

/// Σ|displaced − predicted|, lattice steps / 64, for every blend; a displacement counts as at most 2^15
/// steps.
void scatter(const std::int32_t* displaced, const std::int32_t* smooth, const std::int32_t* own, int count,
             std::uint32_t sums[kBlends]) {
  std::int32_t off[kBlock], more[kBlock];
  for (int i = 0; i < count; ++i) {
    off[i] = fine(displaced[i]) - smooth[i];
    more[i] = own[i] - smooth[i];
  }
  for (int b = 0; b < kBlends; ++b) {
    std::uint32_t sum = 0;
    for (int i = 0; i < count; ++i)
      sum += static_cast<std::uint32_t>(std::abs(off[i] - ((more[i] * b) >> 2))) >> (kFine - 6);
    sums[b] = sum;
  }
}

/// What is coded of an axis in a class whose low bits are not raw.
struct Narrow {
  std::int32_t residual[kBlock];
  std::int32_t symbol[kBlock];
  std::int32_t fraction[kBlock];
};
/// Half of the fractions are the other half seen in a mirror.
void make_narrow(const std::int32_t* displaced, const std::int32_t* predicted, int count, Narrow& out) {
  for (int i = 0; i < count; ++i) {
    const std::int32_t residual = displaced[i] - (predicted[i] >> kFine);
    const std::int32_t fraction = (predicted[i] >> (kFine - 3)) & 7;
    const std::int32_t mirror = -(fraction >> 2);  // all ones or none
    out.fraction[i] = fraction ^ (mirror & 7);
    out.residual[i] = (residual ^ mirror) - 2 * mirror;  // 1 − residual
    out.symbol[i] = std::clamp(out.residual[i] + 7, 0, 15);
  }
}

/// The narrow class that costs least, or a wide one by the mean scatter.
int choose_class(const Narrow& narrow, int count, std::uint32_t sum) {
  const Models& models = Models::get();
  const std::uint32_t mean = sum / static_cast<std::uint32_t>(count);
  int wide = 1;
  while (mean > models.reach[static_cast<std::size_t>(wide)]) ++wide;
  if (wide >= kFirstWide) return wide;
  std::uint32_t seen[kFractions * kSymbols] = {};
  for (int i = 0; i < count; ++i) ++seen[narrow.fraction[i] * kSymbols + narrow.symbol[i]];
  int best = 1;
  std::uint32_t least = ~0u;
  for (int klass = 1; klass < kFirstWide; ++klass) {
    const auto& tables = models.residual[static_cast<std::size_t>(klass)];
    std::uint32_t cost = 0;
    for (std::size_t f = 0; f < kFractions; ++f) {
      for (std::size_t s = 0; s < kSymbols; ++s) cost += seen[f * kSymbols + s] * tables[f].cost[s];
    }
    if (cost >= least) continue;
    least = cost;
    best = klass;
  }
  return best;
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

void remove_particles(const std::uint8_t* gone, int many, Block& block) {
  remove_points(gone, many, block.count, block.points);
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

void BlockWriter::start() {
  out_.clear();
  std::fill(class_before_, class_before_ + 3, kFirstClass);
}

void BlockWriter::retired(const std::uint8_t* gone, int many) {
  out_.bits(static_cast<std::uint64_t>(many - 1), 7);
  for (int i = 0; i < many; ++i) out_.bits(gone[i], 7);
}

void BlockWriter::temporal(const Block& block, BlockPoints last, const BlockPoints* before,
                           const std::uint8_t* gone, int many, bool packed) {
  BlockPoints kept_before;
  if (many > 0) {
    const int count = block.count + many;
    remove_points(gone, many, count, last);
    if (before) {
      kept_before = *before;
      remove_points(gone, many, count, kept_before);
      before = &kept_before;
    }
  } else if (at_rest(block.points, last, block.count)) {
    out_.bits(static_cast<std::uint64_t>(BlockMode::kRest), 2);
    return;
  }
  if (packed) {
    out_.bits(static_cast<std::uint64_t>(BlockMode::kPacked), 2);
    out_.bits(many > 0, 1);
    if (many > 0) retired(gone, many);
    points(block);
    return;
  }
  out_.bits(static_cast<std::uint64_t>(many > 0 ? BlockMode::kMovedSomeRetired : BlockMode::kMoved), 2);
  if (many > 0) retired(gone, many);
  if (block.count > 0) moved(block, last, before);
}

void BlockWriter::moved(const Block& block, const BlockPoints& last, const BlockPoints* before) {
  const int n = block.count;
  std::int32_t displaced[3][kBlock];
  for (int a = 0; a < 3; ++a) {
    for (int i = 0; i < n; ++i) displaced[a][i] = block.points.at[a][i] - last.at[a][i];
  }
  BlockMotion motion;
  std::uint32_t sums[3] = {};
  int blend = 0;
  if (before) {
    fit_motion(last, *before, n, motion);
    std::uint64_t least = ~std::uint64_t{0};
    std::uint32_t tried[3][kBlends];
    for (int a = 0; a < 3; ++a) scatter(displaced[a], motion.smooth[a], motion.own[a], n, tried[a]);
    for (int b = 0; b < kBlends; ++b) {
      // Bits go with the logarithm of the scatter: the product over the axes compares.
      std::uint64_t product = 1;
      for (int a = 0; a < 3; ++a) product *= std::min<std::uint64_t>(tried[a][b] / 16 + 1, 1u << 21);
      if (product >= least) continue;
      least = product;
      blend = b;
      for (int a = 0; a < 3; ++a) sums[a] = tried[a][b];
    }
    out_.bits(static_cast<std::uint64_t>(blend), 2);
    for (int a = 0; a < 3; ++a) {
      for (int i = 0; i < n; ++i)
        motion.smooth[a][i] = blend_motion(motion.smooth[a][i], motion.own[a][i], blend);
    }
  } else {
    std::int32_t drift[3];
    for (int a = 0; a < 3; ++a) {
      std::int64_t sum = 0;
      for (int i = 0; i < n; ++i) sum += displaced[a][i];
      drift[a] = static_cast<std::int32_t>(std::clamp<std::int64_t>(8 * sum / n, -32768, 32767));
      out_.bits(static_cast<std::uint64_t>(drift[a] + 32768), 16);
    }
    uniform_motion(drift, n, motion);
    for (int a = 0; a < 3; ++a) {
      std::uint32_t all[kBlends];
      scatter(displaced[a], motion.smooth[a], motion.own[a], n, all);
      sums[a] = all[0];
    }
  }
  const Models& models = Models::get();
  for (int a = 0; a < 3; ++a) {
    const bool still = std::all_of(displaced[a], displaced[a] + n, [](std::int32_t d) { return d == 0; });
    Narrow narrow;
    make_narrow(displaced[a], motion.smooth[a], n, narrow);
    const int klass = still ? 0 : choose_class(narrow, n, sums[a]);
    const int change = std::clamp(klass - class_before_[a] + 8, 0, 15);
    out_.symbol(models.class_change, change);
    if (change == 0 || change == 15) out_.bits(static_cast<std::uint64_t>(klass), 4);
    if (klass == 0) continue;
    class_before_[a] = klass;
    const auto& tables = models.residual[static_cast<std::size_t>(klass)];
    if (klass >= kFirstWide) {
      wide_axis(displaced[a], motion.smooth[a], n, klass);
      continue;
    }
    const bool plain =
        std::all_of(narrow.symbol, narrow.symbol + n, [](std::int32_t x) { return x > 0 && x < 15; });
    if (plain) {
      out_.symbols(tables, narrow.fraction, narrow.symbol, n);
      continue;
    }
    for (int i = 0; i < n; ++i) {
      out_.symbol(tables[static_cast<std::size_t>(narrow.fraction[i])], narrow.symbol[i]);
      if (narrow.symbol[i] == 0 || narrow.symbol[i] == 15) [[unlikely]]
        beyond(narrow.residual[i]);
    }
  }
}

/// Of a residual that its symbol, 0 or 15, does not tell.
void BlockWriter::beyond(std::int32_t residual) {
  const auto more = static_cast<std::uint32_t>(residual < 0 ? -7 - residual : residual - 8);
  const int length = bit_count(more);
  out_.bits(static_cast<std::uint64_t>(length), 5);
  out_.bits(more, length);
}

void BlockWriter::wide_axis(const std::int32_t* displaced, const std::int32_t* predicted, int count,
                            int klass) {
  const Table& table = Models::get().residual[static_cast<std::size_t>(klass)][0];
  const int low = Models::low_bits(klass);
  for (int i = 0; i < count; ++i) {
    const std::int32_t residual = displaced[i] - (predicted[i] >> kFine) + (1 << (low - 1));
    const std::int32_t high = residual >> low;
    const int symbol = std::clamp(high + 7, 0, 15);
    out_.symbol(table, symbol);
    if (symbol == 0 || symbol == 15) beyond(high);
    out_.bits(static_cast<std::uint32_t>(residual) & ((1u << low) - 1), low);
  }
}

void BlockWriter::points(const Block& block) {
  int width[3];
  std::int32_t least[3];
  for (int a = 0; a < 3; ++a) {
    const auto* at = block.points.at[a];
    least[a] = block.count > 0 ? *std::min_element(at, at + block.count) : 0;
    const std::int32_t most = block.count > 0 ? *std::max_element(at, at + block.count) : 0;
    width[a] = bit_count(static_cast<std::uint64_t>(most - least[a]));
    out_.bits(static_cast<std::uint64_t>(least[a] + kCoordinateLimit), kCoordinateBits);
    out_.bits(static_cast<std::uint64_t>(width[a]), 5);
  }
  for (int i = 0; i < block.count; ++i) {
    for (int a = 0; a < 3; ++a)
      out_.bits(static_cast<std::uint64_t>(block.points.at[a][i] - least[a]), width[a]);
  }
}

void BlockWriter::fluids(const Block& block) {
  const auto [least, most] = std::minmax_element(block.fluid, block.fluid + block.count);
  const int lowest = block.count > 0 ? *least : 0;
  const int width = block.count > 0 ? bit_count(static_cast<std::uint64_t>(*most - *least)) : 0;
  out_.bits(static_cast<std::uint64_t>(lowest), 8);
  out_.bits(static_cast<std::uint64_t>(width), 4);
  for (int i = 0; width > 0 && i < block.count; ++i)
    out_.bits(static_cast<std::uint64_t>(block.fluid[i] - lowest), width);
}

void BlockWriter::key(const Block& block, const std::int32_t origin[3]) {
  std::uint64_t codes[kBlock] = {};
  for (int i = 0; i < block.count; ++i) {
    const std::int32_t at[3] = {block.points.at[0][i], block.points.at[1][i], block.points.at[2][i]};
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
    const auto [low, high] = std::minmax_element(block.points.at[a], block.points.at[a] + n);
    width_bits += n * bit_count(static_cast<std::uint64_t>(*high - *low));
  }
  const bool packed = width_bits < sorted_bits;
  out_.bits(packed, 1);
  if (packed) {
    points(block);
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

void BlockWriter::mend(const Block& block, int size, bool later) {
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
  points(block);
  fluids(block);
}

}  // namespace slosh::codec
