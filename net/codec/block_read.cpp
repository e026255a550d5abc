#include <algorithm>

#include "net/codec/block_code.h"

namespace slosh::codec {

namespace {

constexpr char kOutside[] = "a particle is outside the lattice";
constexpr char kTooShort[] = "ends too early";

bool at_end(int symbol) {
  return symbol == 0 || symbol == kSymbols - 1;
}

bool inside(std::int64_t coordinate) {
  return coordinate > -kCoordinateLimit && coordinate < kCoordinateLimit;
}

}  // namespace

BlockReader::BlockReader(std::span<const std::uint8_t> in) : in_(in) {
  std::fill(class_before_, class_before_ + 3, kFirstClass);
}

const char* BlockReader::retired(Block& block, const BlockPoints*& before, BlockPoints& space) {
  const int many = static_cast<int>(in_.bits(7)) + 1;
  if (many > block.count) return "more particles retire than there are";
  std::uint8_t gone[kBlock];
  for (int i = 0; i < many; ++i) {
    gone[i] = static_cast<std::uint8_t>(in_.bits(7));
    if (gone[i] >= block.count || (i > 0 && gone[i] <= gone[i - 1]))
      return "retired particles are out of order";
  }
  if (before) {
    space = *before;
    remove_points(gone, many, block.count, space);
    before = &space;
  }
  remove_points(gone, many, block.count, block.points);
  remove_members(gone, many, block);
  return nullptr;
}

const char* BlockReader::temporal(Block& block, const BlockPoints* before) {
  const auto mode = static_cast<BlockMode>(in_.bits(2));
  if (mode == BlockMode::kRest) return in_.overran() ? kTooShort : nullptr;
  const bool some_retired =
      mode == BlockMode::kMovedSomeRetired || (mode == BlockMode::kPacked && in_.bits(1) == 1);
  BlockPoints space;
  if (some_retired) {
    if (const char* fault = retired(block, before, space)) return fault;
  }
  if (mode == BlockMode::kPacked) return points(block);
  if (block.count > 0) {
    if (const char* fault = moved(block, before)) return fault;
  }
  return in_.overran() ? kTooShort : nullptr;
}

const char* BlockReader::moved(Block& block, const BlockPoints* before) {
  BlockMotion motion;
  const int n = block.count;
  if (before) {
    const int blend = static_cast<int>(in_.bits(2));
    fit_motion(block.points, *before, n, motion);
    for (int a = 0; a < 3; ++a) {
      for (int i = 0; i < n; ++i)
        motion.smooth[a][i] = blend_motion(motion.smooth[a][i], motion.own[a][i], blend);
    }
  } else {
    std::int32_t drift[3];
    for (std::int32_t& d : drift) d = static_cast<std::int32_t>(in_.bits(16)) - 32768;
    uniform_motion(drift, n, motion);
  }
  const Models& models = Models::get();
  for (int a = 0; a < 3; ++a) {
    const int change = in_.symbol(models.class_change);
    const int klass =
        change == 0 || change == 15 ? static_cast<int>(in_.bits(4)) : class_before_[a] + change - 8;
    if (klass < 0 || klass >= kClasses) return "a block's class is none of the 16";
    if (klass == 0) continue;
    class_before_[a] = klass;
    if (!axis(motion.smooth[a], n, klass, block.points.at[a])) return kOutside;
  }
  return nullptr;
}

bool BlockReader::axis(const std::int32_t* predicted, int count, int klass, std::int32_t* at) {
  const auto& tables = Models::get().residual[static_cast<std::size_t>(klass)];
  const Table* const table[kFractions] = {&tables[0], &tables[1], &tables[2], &tables[3]};
  const int low = Models::low_bits(klass);
  // What does not hang on the stream is done before and after it, where the compiler can do many at once.
  std::uint8_t fraction[kBlock], symbol[kBlock];
  std::int32_t residual[kBlock];
  for (int i = 0; i < count; ++i) {
    const std::int32_t eighth = (predicted[i] >> (kFine - 3)) & 7;
    fraction[i] = static_cast<std::uint8_t>(low > 0 ? 0 : eighth ^ (-(eighth >> 2) & 7));
  }
  if (low > 0) {
    for (int i = 0; i < count; ++i) {
      const int high = residual_of(in_.symbol(*table[0]));
      residual[i] = high * (1 << low) + static_cast<std::int32_t>(in_.bits(low)) - (1 << (low - 1));
    }
  } else {
    struct Beyond {
      std::uint8_t at;
      std::int32_t residual;
    };
    Beyond beyond[kBlock];
    int many = 0;
    for (int i = 0; i < count; ++i) {
      const int came = in_.symbols(table, fraction + i, count - i, symbol + i);
      i += came;
      // Where the last one is not of the table's ends, nothing follows, and the next is read by itself.
      if (came == 0 || !at_end(symbol[i - 1])) {
        if (i == count) break;
        symbol[i] = static_cast<std::uint8_t>(in_.symbol(*table[fraction[i]]));
      } else {
        --i;
      }
      if (at_end(symbol[i])) beyond[many++] = {static_cast<std::uint8_t>(i), residual_of(symbol[i])};
    }
    for (int i = 0; i < count; ++i) residual[i] = symbol[i] - 7;
    for (int m = 0; m < many; ++m) residual[beyond[m].at] = beyond[m].residual;
  }
  std::uint32_t outside = 0;
  for (int i = 0; i < count; ++i) {
    const std::int32_t mirror = low > 0 ? 0 : -((predicted[i] >> (kFine - 1)) & 1);  // all ones or none
    at[i] += (predicted[i] >> kFine) + (residual[i] ^ mirror) - 2 * mirror;  // 1 − residual in the mirror
    outside |= static_cast<std::uint32_t>(at[i] + kCoordinateLimit - 1) > 2u * kCoordinateLimit - 2;
  }
  return outside == 0;
}

/// Of a symbol that was read; what is beyond the table's ends follows in the stream.
std::int32_t BlockReader::residual_of(int symbol) {
  if (!at_end(symbol)) return symbol - 7;
  const int length = static_cast<int>(in_.bits(5));
  const auto beyond = static_cast<std::int32_t>(in_.bits(std::min(length, 22)));
  return symbol == 0 ? -7 - beyond : 8 + beyond;
}

const char* BlockReader::points(Block& block) {
  int width[3];
  std::int64_t least[3];
  for (int a = 0; a < 3; ++a) {
    least[a] = static_cast<std::int64_t>(in_.bits(kCoordinateBits)) - kCoordinateLimit;
    width[a] = static_cast<int>(in_.bits(5));
    if (width[a] > kCoordinateBits) return "a coordinate has too many bits";
  }
  for (int i = 0; i < block.count; ++i) {
    for (int a = 0; a < 3; ++a) {
      const std::int64_t at = least[a] + static_cast<std::int64_t>(in_.bits(width[a]));
      if (!inside(at)) return kOutside;
      block.points.at[a][i] = static_cast<std::int32_t>(at);
    }
  }
  return in_.overran() ? kTooShort : nullptr;
}

const char* BlockReader::fluids(Block& block) {
  const auto lowest = in_.bits(8);
  const int width = static_cast<int>(in_.bits(4));
  if (width > 8) return "a fluid's index has too many bits";
  for (int i = 0; i < block.count; ++i) {
    const std::uint64_t fluid = lowest + in_.bits(width);
    if (fluid >= kRetired) return "a fluid's index is above 254";
    block.fluid[i] = static_cast<std::uint8_t>(fluid);
  }
  return in_.overran() ? kTooShort : nullptr;
}

const char* BlockReader::key(Block& block, int size, const std::int32_t origin[3]) {
  block.count = size;
  for (int i = 0; i < size; ++i) block.slot[i] = static_cast<std::uint8_t>(i);
  if (in_.bits(1) == 1) {
    if (const char* fault = points(block)) return fault;
    return fluids(block);
  }
  constexpr std::uint64_t kMaxCode = std::uint64_t{1} << 3 * kCoordinateBits;
  const int first = static_cast<int>(in_.bits(6));
  std::uint64_t code = in_.bits(std::min(first, 60));
  const int typical = static_cast<int>(in_.bits(6));
  const Table& table = Models::get().code_distance;
  for (int i = 0; i < size; ++i) {
    if (i > 0) {
      const int symbol = in_.symbol(table);
      const int length = symbol == 0 || symbol == 15 ? static_cast<int>(in_.bits(6)) : typical + symbol - 10;
      if (length < 0 || length > 3 * kCoordinateBits) return kOutside;
      if (length > 0) code += std::uint64_t{1} << (length - 1) | in_.bits(length - 1);
    }
    if (code >= kMaxCode) return kOutside;
    for (int a = 0; a < 3; ++a) {
      const std::int64_t at = origin[a] + static_cast<std::int64_t>(gather_bits(code >> a));
      if (!inside(at)) return kOutside;
      block.points.at[a][i] = static_cast<std::int32_t>(at);
    }
  }
  return fluids(block);
}

const char* BlockReader::mend(Block& block, int size, bool later) {
  if (later) {
    size = static_cast<int>(in_.bits(7)) + 1;
    block.born = in_.bits(1) == 1;
  }
  block.count = 0;
  const bool whole = in_.bits(1) == 0;
  for (int slot = 0; slot < size; ++slot) {
    if (whole || in_.bits(1) == 1) block.slot[block.count++] = static_cast<std::uint8_t>(slot);
  }
  if (const char* fault = points(block)) return fault;
  return fluids(block);
}

}  // namespace slosh::codec
