// The fixed tables of the entropy coder. Made once, from integers alone: bitwise identical at both ends.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "net/codec/entropy.h"

namespace slosh::codec {

/// How far residuals scatter about their prediction. 0: the coordinate does not move at all, nothing is
/// coded. From kFirstWide on the low bits are coded raw.
constexpr int kClasses = 16;
constexpr int kFirstWide = 11;
constexpr int kFractions = 4;  ///< of the prediction between two lattice points; the other half by mirroring

struct Models {
  /// Symbol s of residual s − 7; 0 and 15 are followed by how far beyond.
  std::array<std::array<Table, kFractions>, kClasses> residual;
  /// Largest mean |residual| of a class, lattice steps / 64.
  std::array<std::uint32_t, kClasses> reach{};
  Table class_change;       ///< of a block's class against the block before, + 8
  Table code_distance;      ///< bit length of a Morton distance against the block's own, + 10
  std::vector<Step> steps;  ///< of all the tables, for the encoder
  /// What a symbol costs, bits / 256: by class below kFirstWide, then fraction · 16 + symbol.
  std::array<std::array<std::int16_t, kFractions * kSymbols>, kFirstWide> cost{};

  static const Models& get();
  static constexpr int low_bits(int klass) { return klass < kFirstWide ? 0 : klass - kFirstWide + 1; }

 private:
  Models();
};

}  // namespace slosh::codec
