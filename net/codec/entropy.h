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
constexpr int kSymbols = 16;  ///< of every table
constexpr std::uint32_t kStateStart = 1u << 15;
constexpr std::uint32_t kStateEnd = 1u << 31;  ///< states stay below: there the reciprocals are exact

/// Sixteen symbols' shares of 4096; every one at least 1.
struct Table {
  struct Interval {
    std::uint16_t share = 0, below = 0;  ///< below: sum of the shares before
  };
  std::array<Interval, kSymbols> interval{};
  std::array<std::uint32_t, kSymbols> cost{};  ///< bits / 256
  std::uint16_t first_code = 0;                ///< of this table's symbols in the encoder's list
  std::array<std::uint8_t, kProbabilityOne> symbol_at{};

  /// `weights` need not have any particular sum.
  explicit Table(const std::array<std::uint32_t, kSymbols>& weights);
};

/// A symbol of a table as the encoder needs it: state / share = (state · factor) >> shift, exactly for every
/// state below 2^31.
struct Step {
  std::uint32_t factor = 0;
  std::uint32_t limit = 0;         ///< from this state on a word is written first
  std::uint16_t below = 0;         ///< of the table's interval
  std::uint16_t other_shares = 0;  ///< 4096 − share
  std::uint32_t shift = 0;
};
/// Appends the table's sixteen and tells the table where they are.
void append_steps(Table& table, std::vector<Step>& steps);

/// Says what is to be coded, in the order in which it is to be decoded.
class EntropyEncoder {
 public:
  struct Mark {
    std::size_t said = 0;
    std::uint64_t cost = 0;
  };

  /// `steps` of all the tables; stays the caller's.
  explicit EntropyEncoder(std::span<const Step> steps) : steps_(steps) {}

  void clear() { back_to({}); }
  Mark mark() const { return {count_, cost_}; }
  void back_to(const Mark& mark) {
    count_ = mark.said;
    cost_ = mark.cost;
  }
  /// Bytes that finish() will append, to within a few.
  std::size_t size() const { return 8 + static_cast<std::size_t>(cost_ >> 11); }
  void symbol(const Table& table, int symbol) {
    cost_ += table.cost[static_cast<std::size_t>(symbol)];
    say(static_cast<std::uint16_t>(table.first_code + symbol));
  }
  /// Many at once: codes `first` + offset[i], which together cost so many bits / 256.
  void symbols(std::uint16_t first, const std::uint16_t* offset, int count, std::uint32_t cost) {
    const auto n = static_cast<std::size_t>(count);
    if (said_.size() < count_ + n) said_.resize(2 * (count_ + n) + 4096);
    std::uint16_t* to = said_.data() + count_;
    for (std::size_t i = 0; i < n; ++i) to[i] = static_cast<std::uint16_t>(first + offset[i]);
    count_ += n;
    cost_ += cost;
  }
  /// `count` low bits of `value`, most significant first; 0–63 bits.
  void bits(std::uint64_t value, int count) {
    cost_ += static_cast<std::uint64_t>(count) << 8;
    while (count > 0) {
      const int part = count > kProbabilityBits ? kProbabilityBits : count;
      count -= part;
      // A leading one tells how many bits there are.
      const auto piece = static_cast<std::uint32_t>(value >> count) & ((1u << part) - 1);
      say(static_cast<std::uint16_t>(kRaw | 1u << part | piece));
    }
  }
  /// Appends everything that was said.
  void finish(std::vector<std::uint8_t>& out);

 private:
  static constexpr std::uint32_t kRaw = 0x8000;  // a code with this bit is raw bits

  void say(std::uint16_t code) {
    if (count_ == said_.size()) [[unlikely]]
      said_.resize(2 * count_ + 4096);
    said_[count_++] = code;
  }
  std::uint32_t advance(std::uint32_t state, std::uint16_t code, std::uint16_t*& word) const;

  std::span<const Step> steps_;
  std::vector<std::uint16_t> said_;  // codes, the first count_ of them
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
    const Table::Interval in = table.interval[static_cast<std::size_t>(s)];
    advance(in.share, slot - in.below);
    return s;
  }
  /// Up to `count` symbols, the i-th by *tables[which[i]]. Stops behind a symbol 0 or 15, which may have
  /// something of its own to follow, and before the input's last words. Returns how many were read.
  int symbols(const Table* const* tables, const std::uint8_t* which, int count, std::uint8_t* symbols);
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
