// The integer lattice that all coding happens on: a coordinate is the multiple of 2·tolerance next to it.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace slosh::codec {

constexpr int kBlockBits = 7;
constexpr int kBlock = 1 << kBlockBits;  ///< particles of a block, the last one of an epoch may have fewer
constexpr int kCoordinateBits = 19;
constexpr std::int32_t kCoordinateLimit = 1 << (kCoordinateBits - 1);  ///< |lattice coordinate| stays below
constexpr std::uint32_t kMaxParticles = 1u << 22;
constexpr std::uint32_t kMaxBlocks = kMaxParticles / kBlock;
constexpr std::uint8_t kRetired = 255;  ///< Snapshot::fluid_index of what is not drawn

/// The integer next to it, the even one of two; |scaled| below 2^31. Rounded by where a double's last bit is,
/// which, unlike std::lrint, every compiler does many at once.
inline std::int32_t nearest(double scaled) {
  constexpr double kLastBitIsOne = 6755399441055744.0;  // 1.5 · 2^52
  return static_cast<std::int32_t>(std::bit_cast<std::int64_t>(scaled + kLastBitIsOne));
}

/// False: not finite, or beyond the lattice.
inline bool to_lattice(const glm::vec3& position, double per_step, std::int32_t out[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    const double scaled = static_cast<double>(position[axis]) * per_step;
    if (!(std::abs(scaled) < kCoordinateLimit - 1)) return false;
    out[axis] = nearest(scaled);
  }
  return true;
}

/// Every third bit, for the order that keeps near points near: bits of x to bits 0, 3, 6, …
inline std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}
inline std::uint64_t gather_bits(std::uint64_t x) {
  x &= 0x1249249249249249;
  x = (x | x >> 2) & 0x10c30c30c30c30c3;
  x = (x | x >> 4) & 0x100f00f00f00f00f;
  x = (x | x >> 8) & 0x001f0000ff0000ff;
  x = (x | x >> 16) & 0x001f00000000ffff;
  return (x | x >> 32) & 0x1fffff;
}
/// Morton code of a point at or above the origin.
inline std::uint64_t morton(const std::int32_t at[3], const std::int32_t origin[3]) {
  return spread_bits(static_cast<std::uint64_t>(at[0] - origin[0])) |
         spread_bits(static_cast<std::uint64_t>(at[1] - origin[1])) << 1 |
         spread_bits(static_cast<std::uint64_t>(at[2] - origin[2])) << 2;
}

/// One block's lattice points at one frame, an array an axis.
struct BlockPoints {
  std::int32_t at[3][kBlock];
};

}  // namespace slosh::codec
