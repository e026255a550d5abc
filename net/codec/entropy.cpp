#include "net/codec/entropy.h"

#include <bit>

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
    below[s] = static_cast<std::uint16_t>(at);
    for (std::uint32_t i = 0; i < share[s]; ++i) symbol_at[at++] = static_cast<std::uint8_t>(s);
    cost[s] = cost_of(share[s]);
    // Exact for every x below 2^31 (Alverson 1991): shift rounds log2(share) up, the factor is rounded up.
    int shift = 0;
    while (share[s] > (1u << shift)) ++shift;
    said[s] = {0, share[s], below[s], static_cast<std::uint16_t>(shift)};
    if (share[s] != 1u << shift) {
      said[s].factor =
          static_cast<std::uint32_t>(((std::uint64_t{1} << (shift + 31)) + share[s] - 1) / share[s]);
      said[s].shift = static_cast<std::uint16_t>(shift - 1);
    }
  }
  below[kSymbols] = static_cast<std::uint16_t>(at);
}

void EntropyEncoder::finish(std::vector<std::uint8_t>& out) {
  if (words_.size() < count_) words_.resize(count_);
  std::size_t words = 0;
  // The states take turns; two variables, as memory would hold each up for the one before.
  std::uint32_t now = kStateStart, next = kStateStart;
  for (std::size_t i = count_; i-- > 0;) {
    const Table::Said say = said_[i];
    const bool full = now >= std::uint32_t{say.share} << 19;
    words_[words] = static_cast<std::uint16_t>(now);
    words += full;
    const std::uint32_t x = full ? now >> 16 : now;
    const std::uint32_t quotient =
        say.factor == 0 ? x >> say.shift
                        : static_cast<std::uint32_t>((std::uint64_t{x} * say.factor) >> 32) >> say.shift;
    now = next;
    next = (quotient << kProbabilityBits) + (x - quotient * say.share) + say.below;
  }
  // The last symbol coded is the first to be read: its state comes first.
  const std::uint32_t state[2] = {count_ > 0 ? next : now, count_ > 0 ? now : next};
  const std::size_t start = out.size();
  out.resize(start + 8 + 2 * words);
  std::uint8_t* at = out.data() + start;
  std::memcpy(at, &state[0], 4);
  std::memcpy(at + 4, &state[1], 4);
  at += 8;
  for (std::size_t i = words; i-- > 0; at += 2) std::memcpy(at, &words_[i], 2);
}

EntropyDecoder::EntropyDecoder(std::span<const std::uint8_t> in)
    : at_(in.data()), end_(in.data() + in.size()) {
  if (in.size() < 8 || in.size() % 2 != 0) return;
  std::memcpy(&state_, at_, 4);
  std::memcpy(&other_, at_ + 4, 4);
  at_ += 8;
  started_ = state_ >= kStateStart && other_ >= kStateStart;
}

}  // namespace slosh::codec
