// How a block that moved is written: its expected motion, and for each axis the class whose table costs
// least.
#include <algorithm>
#include <bit>
#include <cstdlib>

#include "net/codec/block_code.h"

namespace slosh::codec {

namespace {

std::int32_t fine(std::int32_t displaced) {
  return std::clamp(displaced, -(1 << 15), 1 << 15) * (1 << kFine);
}

/// Σ|displaced − predicted|, lattice steps / 64, for every blend; a displacement counts as at most 2^15
/// steps.
void measure_scatter(const std::int32_t* displaced, const std::int32_t* smooth, const std::int32_t* own,
                     int count, std::uint32_t sums[kBlends]) {
  static_assert(kBlends == 4);
  std::uint32_t sum0 = 0, sum1 = 0, sum2 = 0, sum3 = 0;
  const auto size = [](std::int32_t off) { return static_cast<std::uint32_t>(std::abs(off)) >> (kFine - 6); };
  for (int i = 0; i < count; ++i) {
    const std::int32_t off = fine(displaced[i]) - smooth[i];
    const std::int32_t more = own[i] - smooth[i];
    sum0 += size(off);
    sum1 += size(off - (more >> 2));
    sum2 += size(off - ((more * 2) >> 2));
    sum3 += size(off - ((more * 3) >> 2));
  }
  sums[0] = sum0, sums[1] = sum1, sums[2] = sum2, sums[3] = sum3;
}

/// What is coded of an axis in a class whose low bits are not raw.
struct Narrow {
  std::int32_t residual[kBlock];
  std::uint16_t code[kBlock];  ///< within the class: fraction · 16 + symbol
};
/// Half of the fractions are the other half seen in a mirror.
void make_narrow(const std::int32_t* displaced, const std::int32_t* predicted, int count, Narrow& out) {
  for (int i = 0; i < count; ++i) {
    const std::int32_t whole = displaced[i] - (predicted[i] >> kFine);
    const std::int32_t fraction = (predicted[i] >> (kFine - 3)) & 7;
    const std::int32_t mirror = -(fraction >> 2);                 // all ones or none
    const std::int32_t residual = (whole ^ mirror) - 2 * mirror;  // 1 − residual
    out.residual[i] = residual;
    out.code[i] = static_cast<std::uint16_t>((fraction ^ (mirror & 7)) * kSymbols +
                                             std::clamp(residual + 7, 0, kSymbols - 1));
  }
}

struct Choice {
  int klass = 1;
  std::uint32_t cost = 0;  ///< bits / 256 of the symbols; of narrow classes alone
  bool plain = false;      ///< no residual is beyond the symbols
};

/// The narrow class that costs least, or a wide one by the mean scatter.
Choice choose_class(const Narrow& narrow, int count, std::uint32_t scatter) {
  const Models& models = Models::get();
  const std::uint32_t mean = scatter / static_cast<std::uint32_t>(count);
  Choice best;
  while (mean > models.reach[static_cast<std::size_t>(best.klass)]) ++best.klass;
  if (best.klass >= kFirstWide) return best;
  // Counted in turns, as a number that was just written takes long to read.
  constexpr int kCodes = kFractions * kSymbols;
  std::uint8_t turn[4][kCodes] = {};
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    for (int t = 0; t < 4; ++t) ++turn[t][narrow.code[i + t]];
  }
  for (; i < count; ++i) ++turn[0][narrow.code[i]];
  std::int16_t seen[kCodes];
  for (int c = 0; c < kCodes; ++c)
    seen[c] = static_cast<std::int16_t>(turn[0][c] + turn[1][c] + turn[2][c] + turn[3][c]);
  best.cost = ~0u;
  for (int klass = 1; klass < kFirstWide; ++klass) {
    const auto& of_class = models.cost[static_cast<std::size_t>(klass)];
    std::int32_t sum = 0;
    for (int c = 0; c < kCodes; ++c) sum += seen[c] * of_class[static_cast<std::size_t>(c)];
    const auto cost = static_cast<std::uint32_t>(sum);
    if (cost >= best.cost) continue;
    best.cost = cost;
    best.klass = klass;
  }
  std::int32_t at_ends = 0;
  for (int f = 0; f < kFractions; ++f) at_ends |= seen[f * kSymbols] | seen[f * kSymbols + kSymbols - 1];
  best.plain = at_ends == 0;
  return best;
}

bool all_zero(const std::int32_t* values, int count) {
  std::int32_t any = 0;
  for (int i = 0; i < count; ++i) any |= values[i];
  return any == 0;
}

}  // namespace

void BlockWriter::choose_blend(int count, const BlockPoints& displaced, BlockMotion& motion,
                               std::uint32_t scatter[3]) {
  int blend = 0;
  std::uint64_t least = ~std::uint64_t{0};
  std::uint32_t tried[3][kBlends];
  for (int a = 0; a < 3; ++a)
    measure_scatter(displaced.at[a], motion.smooth[a], motion.own[a], count, tried[a]);
  for (int b = 0; b < kBlends; ++b) {
    // Bits go with the logarithm of the scatter: the product over the axes compares.
    std::uint64_t product = 1;
    for (int a = 0; a < 3; ++a) product *= std::min<std::uint64_t>(tried[a][b] / 16 + 1, 1u << 21);
    if (product >= least) continue;
    least = product;
    blend = b;
    for (int a = 0; a < 3; ++a) scatter[a] = tried[a][b];
  }
  out_.bits(static_cast<std::uint64_t>(blend), 2);
  for (int a = 0; a < 3; ++a) {
    for (int i = 0; i < count; ++i)
      motion.smooth[a][i] = blend_motion(motion.smooth[a][i], motion.own[a][i], blend);
  }
}

void BlockWriter::choose_drift(int count, const BlockPoints& displaced, BlockMotion& motion,
                               std::uint32_t scatter[3]) {
  std::int32_t drift[3];
  for (int a = 0; a < 3; ++a) {
    std::int64_t sum = 0;
    for (int i = 0; i < count; ++i) sum += displaced.at[a][i];
    drift[a] = static_cast<std::int32_t>(std::clamp<std::int64_t>(8 * sum / count, -32768, 32767));
    out_.bits(static_cast<std::uint64_t>(drift[a] + 32768), 16);
  }
  uniform_motion(drift, count, motion);
  for (int a = 0; a < 3; ++a) {
    std::uint32_t all[kBlends];
    measure_scatter(displaced.at[a], motion.smooth[a], motion.own[a], count, all);
    scatter[a] = all[0];
  }
}

void BlockWriter::moved(int count, const BlockPoints& now, const BlockPoints& last,
                        const BlockPoints* before) {
  BlockPoints displaced;
  for (int a = 0; a < 3; ++a) {
    for (int i = 0; i < count; ++i) displaced.at[a][i] = now.at[a][i] - last.at[a][i];
  }
  BlockMotion motion;
  std::uint32_t scatter[3] = {};
  if (before) {
    fit_motion(last, *before, count, motion);
    choose_blend(count, displaced, motion, scatter);
  } else {
    choose_drift(count, displaced, motion, scatter);
  }
  for (int a = 0; a < 3; ++a) axis(a, count, displaced.at[a], motion.smooth[a], scatter[a]);
}

void BlockWriter::axis(int a, int count, const std::int32_t* displaced, const std::int32_t* predicted,
                       std::uint32_t scatter) {
  const Models& models = Models::get();
  Narrow narrow;
  Choice choice;
  if (all_zero(displaced, count)) {
    choice.klass = 0;
  } else {
    make_narrow(displaced, predicted, count, narrow);
    choice = choose_class(narrow, count, scatter);
  }
  const int klass = choice.klass;
  const int change = std::clamp(klass - class_before_[a] + 8, 0, 15);
  out_.symbol(models.class_change, change);
  if (change == 0 || change == 15) out_.bits(static_cast<std::uint64_t>(klass), 4);
  if (klass == 0) return;
  class_before_[a] = klass;
  if (klass >= kFirstWide) {
    wide_axis(displaced, predicted, count, klass);
    return;
  }
  const auto& tables = models.residual[static_cast<std::size_t>(klass)];
  if (choice.plain) {
    out_.symbols(tables[0].first_code, narrow.code, count, choice.cost);
    return;
  }
  for (int i = 0; i < count; ++i) {
    const int symbol = narrow.code[i] % kSymbols;
    out_.symbol(tables[narrow.code[i] / kSymbols], symbol);
    if (symbol == 0 || symbol == kSymbols - 1) [[unlikely]]
      beyond(narrow.residual[i]);
  }
}

/// Of a residual that its symbol, 0 or 15, does not tell.
void BlockWriter::beyond(std::int32_t residual) {
  const auto more = static_cast<std::uint32_t>(residual < 0 ? -7 - residual : residual - 8);
  const int length = std::bit_width(more);
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

}  // namespace slosh::codec
