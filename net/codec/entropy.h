// Entropy coding of a piece: asymmetric numeral systems (rANS, Duda 2013) with fixed tables, two states in
// turn. A piece is one such stream, so that the coder's last bits are paid once a datagram.
//
// The encoder writes backwards: it keeps what it is told and codes it in finish(). The decoder must find its
// states as the encoder started them and no byte left over: damage shows there at the latest.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace slosh::codec {

constexpr int kProbabilityBits = 12;
constexpr std::uint32_t kProbabilityOne = 1u << kProbabilityBits;
constexpr int kSymbols = 16;                     ///< of every table
constexpr std::uint32_t kStateStart = 1u << 15;  // keeps states below 2^31, where the reciprocals are exact

/// Sixteen symbols' shares of 4096; every one at least 1.
struct Table {
  std::array<std::uint16_t, kSymbols> share{};
  std::array<std::uint16_t, kSymbols + 1> below{};  ///< sum of the shares before
  std::array<std::uint32_t, kSymbols> cost{};       ///< bits / 256
  /// A symbol as the encoder needs it: x / share = (x · factor) >> (32 + shift), or x >> shift without
  /// factor.
  struct Said {
    std::uint32_t factor = 0;
    std::uint16_t share = 0, below = 0, shift = 0;
  };
  std::array<Said, kSymbols> said{};
  std::array<std::uint8_t, kProbabilityOne> symbol_at{};

  /// `weights` need not have any particular sum.
  explicit Table(const std::array<std::uint32_t, kSymbols>& weights);
};

/// Says what is to be coded, in the order in which it is to be decoded.
class EntropyEncoder {
 public:
  struct Mark {
    std::size_t said = 0;
    std::uint64_t cost = 0;
  };

  void clear() { back_to({}); }
  Mark mark() const { return {count_, cost_}; }
  void back_to(const Mark& mark) {
    count_ = mark.said;
    cost_ = mark.cost;
  }
  /// Bytes that finish() will append, to within a few.
  std::size_t size() const { return 8 + static_cast<std::size_t>(cost_ >> 11); }
  void symbol(const Table& table, int symbol) {
    const auto s = static_cast<std::size_t>(symbol);
    cost_ += table.cost[s];
    say(table.said[s]);
  }
  /// Symbol i by table which[i].
  template <std::size_t N>
  void symbols(const std::array<Table, N>& tables, const std::int32_t* which, const std::int32_t* symbol,
               int count) {
    const auto n = static_cast<std::size_t>(count);
    if (said_.size() < count_ + n) said_.resize(2 * (count_ + n) + 4096);
    Table::Said* to = said_.data() + count_;
    std::uint64_t cost = 0;  // here, not in memory: every symbol adds to it
    for (std::size_t i = 0; i < n; ++i) {
      const Table& table = tables[static_cast<std::size_t>(which[i])];
      const auto s = static_cast<std::size_t>(symbol[i]);
      to[i] = table.said[s];
      cost += table.cost[s];
    }
    count_ += n;
    cost_ += cost;
  }
  /// `count` low bits of `value`, most significant first; 0–63 bits.
  void bits(std::uint64_t value, int count) {
    cost_ += static_cast<std::uint64_t>(count) << 8;
    while (count > 0) {
      const int part = count > kProbabilityBits ? kProbabilityBits : count;
      count -= part;
      const auto piece = static_cast<std::uint32_t>(value >> count) & ((1u << part) - 1);
      const int left = kProbabilityBits - part;
      say({0, static_cast<std::uint16_t>(1u << left), static_cast<std::uint16_t>(piece << left),
           static_cast<std::uint16_t>(left)});
    }
  }
  /// Appends everything that was said.
  void finish(std::vector<std::uint8_t>& out);

 private:
  void say(const Table::Said& said) {
    if (count_ == said_.size()) [[unlikely]]
      said_.resize(2 * count_ + 4096);
    said_[count_++] = said;
  }
  std::vector<Table::Said> said_;  // the first count_ of them
  std::size_t count_ = 0;
  std::uint64_t cost_ = 0;  // bits / 256
  std::vector<std::uint16_t> words_;
};

/// Reads what an EntropyEncoder wrote. Never reads outside `in`: behind its end come zeros, and ended() is
/// false then.
class EntropyDecoder {
 public:
  explicit EntropyDecoder(std::span<const std::uint8_t> in);
  bool started() const { return started_; }

  int symbol(const Table& table) {
    const std::uint32_t slot = state_ & (kProbabilityOne - 1);
    const int s = table.symbol_at[slot];
    advance(table.share[static_cast<std::size_t>(s)], slot - table.below[static_cast<std::size_t>(s)]);
    return s;
  }
  std::uint64_t bits(int count) {
    std::uint64_t value = 0;
    while (count > 0) {
      const int part = count > kProbabilityBits ? kProbabilityBits : count;
      count -= part;
      const int left = kProbabilityBits - part;
      const std::uint32_t slot = state_ & (kProbabilityOne - 1);
      advance(1u << left, slot & ((1u << left) - 1));
      value = value << part | slot >> left;
    }
    return value;
  }
  /// True when exactly all was read, and nothing beyond.
  bool ended() const {
    return at_ == end_ && overrun_ == 0 && state_ == kStateStart && other_ == kStateStart;
  }
  bool overran() const { return overrun_ > 0; }

 private:
  void advance(std::uint32_t share, std::uint32_t rest) {
    std::uint32_t next = share * (state_ >> kProbabilityBits) + rest;
    if (next < kStateStart) next = next << 16 | word();
    state_ = other_;
    other_ = next;
  }
  std::uint32_t word() {
    if (at_ == end_) return ++overrun_, 0u;
    std::uint16_t raw;
    std::memcpy(&raw, at_, 2);
    at_ += 2;
    return raw;
  }
  const std::uint8_t* at_;
  const std::uint8_t* end_;
  std::uint32_t state_ = 0, other_ = 0;
  std::uint32_t overrun_ = 0;
  bool started_ = false;
};

}  // namespace slosh::codec
