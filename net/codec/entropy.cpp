#include "net/codec/entropy.h"

#include <bit>
#include <utility>

namespace slosh::codec {

namespace {

/// log2(4096 / share) · 256, by squaring: the same on every machine.
std::uint32_t cost_of(std::uint32_t share) {
  const std::uint64_t x = share;
  const int whole = std::bit_width(x) - 1;
  std::uint64_t mantissa = (x << 32) >> whole;  // 1–2 in 32.32
  std::uint32_t fraction = 0;
  for (int bit = 0; bit < 8; ++bit) {
    mantissa = (mantissa >> 16) * (mantissa >> 16);
    fraction <<= 1;
    if (mantissa >= std::uint64_t{2} << 32) {
      mantissa >>= 1;
      fraction |= 1;
    }
  }
  return (static_cast<std::uint32_t>(kProbabilityBits - whole) << 8) - fraction;
}

}  // namespace

Table::Table(const std::array<std::uint32_t, kSymbols>& weights) {
  std::uint64_t sum = 0;
  for (const std::uint32_t w : weights) sum += w;
  std::array<std::uint16_t, kSymbols> share{};
  std::uint32_t used = 0;
  std::size_t largest = 0;
  for (std::size_t s = 0; s < kSymbols; ++s) {
    share[s] = static_cast<std::uint16_t>(
        1 + (sum == 0 ? 0 : std::uint64_t{weights[s]} * (kProbabilityOne - kSymbols) / sum));
    used += share[s];
    if (share[s] > share[largest]) largest = s;
  }
  share[largest] = static_cast<std::uint16_t>(share[largest] + kProbabilityOne - used);
  std::uint32_t at = 0;
  for (std::size_t s = 0; s < kSymbols; ++s) {
    interval[s] = {share[s], static_cast<std::uint16_t>(at)};
    for (std::uint32_t i = 0; i < share[s]; ++i) symbol_at[at++] = static_cast<std::uint8_t>(s);
    cost[s] = cost_of(share[s]);
  }
}

void append_steps(Table& table, std::vector<Step>& steps) {
  table.first_code = static_cast<std::uint16_t>(steps.size());
  for (const Table::Interval& in : table.interval) {
    // Exact for every state below 2^31 (Alverson 1991): log2(share) and the factor are rounded up.
    const int log = std::bit_width(std::uint32_t{in.share} - 1);
    Step& step = steps.emplace_back();
    step.factor = static_cast<std::uint32_t>(((std::uint64_t{1} << (log + 31)) + in.share - 1) / in.share);
    step.shift = static_cast<std::uint32_t>(log + 31);
    step.limit = std::uint32_t{in.share} << 19;
    step.below = in.below;
    step.other_shares = static_cast<std::uint16_t>(kProbabilityOne - in.share);
  }
}

inline std::uint32_t EntropyEncoder::advance(std::uint32_t state, std::uint16_t code,
                                             std::uint16_t*& word) const {
  *word = static_cast<std::uint16_t>(state);
  if (code < kRaw) {
    const Step& step = steps_[code];
    const bool full = state >= step.limit;
    word += full;
    const std::uint32_t x = full ? state >> 16 : state;
    const auto quotient = static_cast<std::uint32_t>((std::uint64_t{x} * step.factor) >> step.shift);
    return x + step.below + quotient * step.other_shares;
  }
  const std::uint32_t leading = code & (kRaw - 1);
  const int part = std::bit_width(leading) - 1;
  const int left = kProbabilityBits - part;
  const bool full = state >= std::uint32_t{1} << (left + 19);
  word += full;
  const std::uint32_t x = full ? state >> 16 : state;
  const std::uint32_t piece = leading ^ 1u << part;
  return (x >> left << kProbabilityBits) + (x & ((1u << left) - 1)) + (piece << left);
}

void EntropyEncoder::finish(std::vector<std::uint8_t>& out) {
  if (words_.size() < count_ + 1) words_.resize(count_ + 1);
  std::uint16_t* word = words_.data();
  // The states take turns; two variables, as memory would hold each up for the one before.
  std::uint32_t even = kStateStart, odd = kStateStart;
  std::size_t i = count_;
  if (i % 2 != 0) even = advance(even, said_[--i], word);
  while (i > 0) {
    odd = advance(odd, said_[--i], word);
    even = advance(even, said_[--i], word);
  }
  const auto words = static_cast<std::size_t>(word - words_.data());
  // The first symbol is the even state's, which comes first.
  const std::size_t start = out.size();
  out.resize(start + 8 + 2 * words);
  std::uint8_t* at = out.data() + start;
  std::memcpy(at, &even, 4);
  std::memcpy(at + 4, &odd, 4);
  at += 8;
  for (std::size_t w = words; w-- > 0; at += 2) std::memcpy(at, &words_[w], 2);
}

EntropyDecoder::EntropyDecoder(std::span<const std::uint8_t> in)
    : at_(in.data()), end_(in.data() + in.size()) {
  if (in.size() < 8 || in.size() % 2 != 0) return;
  std::memcpy(&state_, at_, 4);
  std::memcpy(&other_, at_ + 4, 4);
  at_ += 8;
  const auto fits = [](std::uint32_t state) { return state >= kStateStart && state < kStateEnd; };
  started_ = fits(state_) && fits(other_);
}

int EntropyDecoder::symbols(const Table* const* tables, const std::uint8_t* which, int count,
                            std::uint8_t* symbols) {
  const std::uint8_t* at = at_;
  std::uint32_t now = state_, next = other_;
  int i = 0;
  bool plain = true;
  // No branch hangs on what is read, as it could not be foretold: two words are looked at, none to two taken.
  const auto read = [](const Table& table, std::uint32_t& state, std::uint32_t& words, std::uint32_t& used) {
    const std::uint32_t slot = state & (kProbabilityOne - 1);
    const std::uint8_t s = table.symbol_at[slot];
    const Table::Interval in = table.interval[s];
    const std::uint32_t rest = in.share * (state >> kProbabilityBits) + slot - in.below;
    const std::uint32_t low = (rest - kStateStart) >> 31;  // 1: below it; states are below 2^31
    state = rest << 16 * low | (words & 0xffff * low);
    words >>= 16 * low;
    used += low;
    return s;
  };
  while (plain && i + 1 < count && end_ - at >= 4) {
    std::uint32_t words, used = 0;
    std::memcpy(&words, at, 4);
    const std::uint8_t first = read(*tables[which[i]], now, words, used);
    symbols[i++] = first;
    plain = first - 1u < kSymbols - 2u;
    if (!plain) {
      std::swap(now, next);
    } else {
      const std::uint8_t second = read(*tables[which[i]], next, words, used);
      symbols[i++] = second;
      plain = second - 1u < kSymbols - 2u;
    }
    at += 2 * used;
  }
  at_ = at;
  state_ = now;
  other_ = next;
  return i;
}

}  // namespace slosh::codec
