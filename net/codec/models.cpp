#include "net/codec/models.h"

#include <algorithm>

namespace slosh::codec {

namespace {

constexpr std::uint64_t kOne = 1u << 16;

/// e^−x in 16.16 for x in 16.16.
std::uint64_t exp_minus(std::uint64_t x) {
  const std::uint64_t in_halvings = x * 94548 >> 16;  // · 1/ln 2
  const std::uint64_t whole = in_halvings >> 16, part = in_halvings & 0xffff;
  if (whole > 40) return 0;
  // 2^−t on [0, 1), by Horner; within 1e-4.
  std::uint64_t value = 3638;
  value = 15743 - (value * part >> 16);
  value = 45425 - (value * part >> 16);
  value = kOne - (value * part >> 16);
  return value >> whole;
}

/// Logistic distribution function in 16.16; x and scale in 1/1024 lattice steps.
std::int64_t logistic(std::int64_t x, std::int64_t scale) {
  const auto size = static_cast<std::uint64_t>(x < 0 ? -x : x) * kOne / static_cast<std::uint64_t>(scale);
  const std::uint64_t e = exp_minus(size);
  const auto tail = static_cast<std::int64_t>((e << 16) / (kOne + e));
  return x < 0 ? tail : static_cast<std::int64_t>(kOne) - tail;
}

// Scale of each class in 1/1024 lattice steps: of what is left when the point's own place between lattice
// points, anywhere within `kSmear`, is known.
constexpr std::array<std::int64_t, kClasses> kScale = {8,   15,  80,  150,  210,  270,  330,  400,
                                                       520, 700, 960, 1000, 1000, 1000, 1000, 1000};

std::array<std::uint32_t, kSymbols> residual_weights(int klass, int fraction) {
  const std::int64_t scale = kScale[static_cast<std::size_t>(klass)];
  const std::int64_t center = klass < kFirstWide ? 128 * fraction + 64 : 0;
  const std::int64_t smear = klass < kFirstWide ? 448 : 256;
  std::array<std::uint32_t, kSymbols> weights{};
  for (int s = 0; s < kSymbols; ++s) {
    std::int64_t sum = 0;
    for (std::int64_t shift = -smear; shift <= smear; shift += smear / 4) {
      const std::int64_t lower = 1024 * (s - 7) - 512 - center - shift;
      const std::int64_t p =
          (s == kSymbols - 1 ? static_cast<std::int64_t>(kOne) : logistic(lower + 1024, scale)) -
          (s == 0 ? 0 : logistic(lower, scale));
      sum += p;
    }
    weights[static_cast<std::size_t>(s)] = static_cast<std::uint32_t>(sum < 0 ? 0 : sum);
  }
  return weights;
}

template <std::size_t... I>
std::array<Table, kFractions> fractions_of(int klass, std::index_sequence<I...>) {
  return {Table(residual_weights(klass, static_cast<int>(I)))...};
}
template <std::size_t... I>
std::array<std::array<Table, kFractions>, kClasses> all_classes(std::index_sequence<I...>) {
  return {fractions_of(static_cast<int>(I), std::make_index_sequence<kFractions>{})...};
}

}  // namespace

Models::Models()
    : residual(all_classes(std::make_index_sequence<kClasses>{})),
      class_change({4, 10, 35, 70, 200, 200, 500, 1700, 4100, 1950, 750, 240, 140, 60, 15, 4}),
      code_distance({2, 8, 30, 80, 150, 200, 260, 430, 920, 2120, 3130, 2180, 450, 60, 20, 12}) {
  std::array<std::uint32_t, kClasses> mean{};
  for (std::size_t c = 1; c < kClasses; ++c) {
    std::uint64_t sum = 0;
    for (std::size_t f = 0; f < kFractions; ++f) {
      const Table& table = residual[c][f];
      for (int s = 0; s < kSymbols; ++s) {
        const int off = 64 * (s - 7) - (c < kFirstWide ? static_cast<int>(8 * f + 4) : 0);
        sum += static_cast<std::uint64_t>(table.interval[static_cast<std::size_t>(s)].share) *
               static_cast<std::uint64_t>(off < 0 ? -off : off);
      }
    }
    mean[c] = static_cast<std::uint32_t>(sum / (kFractions * kProbabilityOne))
              << low_bits(static_cast<int>(c));
  }
  for (std::size_t c = 1; c + 1 < kClasses; ++c) reach[c] = (mean[c] + mean[c + 1]) / 2;
  reach[kClasses - 1] = ~0u;
  // The fractions of a class follow each other: the code within a class is fraction · 16 + symbol.
  for (auto& klass : residual) {
    for (Table& table : klass) append_steps(table, steps);
  }
  append_steps(class_change, steps);
  append_steps(code_distance, steps);
  for (std::size_t c = 0; c < kFirstWide; ++c) {
    for (std::size_t f = 0; f < kFractions; ++f)
      std::copy_n(residual[c][f].cost.begin(), kSymbols, cost[c].begin() + static_cast<long>(f * kSymbols));
  }
}

const Models& Models::get() {
  static const Models models;
  return models;
}

}  // namespace slosh::codec
