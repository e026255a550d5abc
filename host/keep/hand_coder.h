// Hands' inputs, tick by tick, bitwise in few bytes: each number is carried on by its last change, taken
// as an integer, and what is off is written without its leading zeros. A hand that rests costs nothing.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/keep/chunk.h"
#include "sim/world.h"

namespace slosh::keep {

/// Both ends have one and feed it the same ticks.
class HandCoder {
 public:
  explicit HandCoder(std::size_t hands) : tracks_(hands) {}

  /// Appends one tick; nothing when all hands are as expected, and false then. What a disengaged hand reads
  /// is left out.
  bool encode(std::span<const HandleInput> hands, Bytes& out);
  /// Takes one tick off the front of `in`; false when it is cut short or malformed.
  bool decode(ByteView& in, std::vector<HandleInput>& hands);
  /// A tick for which encode() gave nothing.
  void expected(std::vector<HandleInput>& hands);
  /// Back to the beginning, so that what follows can be read on its own.
  void restart() { tracks_.assign(tracks_.size(), {}); }

 private:
  static constexpr std::size_t kWords = 14;
  using Words = std::array<std::uint64_t, kWords>;
  struct Track {
    Words last{}, before{};
    bool engaged = false;
    Words expected() const;
    void take(const Words& words, bool is_engaged);
  };
  static Words words_of(const HandleInput& hand);
  static HandleInput hand_of(const Words& words, bool engaged);

  std::vector<Track> tracks_;
};

}  // namespace slosh::keep
