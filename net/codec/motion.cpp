#include "net/codec/motion.h"

#include <algorithm>

namespace slosh::codec {

namespace {

constexpr std::int32_t kFar = 2047;  // steps: products of two, summed over a block, stay within 32 bits

std::int32_t limited(std::int32_t value) {
  return std::clamp(value, -kFar, kFar);
}

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  const std::int64_t q = a / b;
  return q * b > a ? q - 1 : q;
}

/// By how many particles there are: most blocks are full, and a shift is many times shorter.
std::int64_t per_particle(std::int64_t sum, int count) {
  return count == kBlock ? sum >> kBlockBits : floor_div(sum, count);
}

/// Σ a·b. Values within ±kFar: 16 bits each, so that two products at once are one instruction.
std::int32_t dot(const std::int16_t* a, const std::int16_t* b, int count) {
  std::int32_t sum = 0;
  for (int i = 0; i < count; ++i) sum += std::int32_t{a[i]} * b[i];
  return sum;
}

/// Symmetric, xx xy xz yy yz zz.
struct Moments {
  std::int64_t m[6];
};

/// Inverse · 2^29 of moments that are scaled to a trace below 2^16 and held away from singular.
Moments inverted(Moments s) {
  const std::int64_t trace = s.m[0] + s.m[3] + s.m[5];
  const std::int64_t ridge = trace / 32 + 1;
  s.m[0] += ridge, s.m[3] += ridge, s.m[5] += ridge;
  const auto& [xx, xy, xz, yy, yz, zz] = s.m;
  const Moments adjugate{{yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy, xx * zz - xz * xz,
                          xy * xz - xx * yz, xx * yy - xy * xy}};
  const std::int64_t determinant = xx * adjugate.m[0] + xy * adjugate.m[1] + xz * adjugate.m[2];
  Moments result{};
  if (determinant <= 0) return result;
  for (int i = 0; i < 6; ++i) result.m[i] = floor_div(adjugate.m[i] * (std::int64_t{1} << 29), determinant);
  return result;
}

}  // namespace

void fit_motion(const BlockPoints& last, const BlockPoints& before, int count, BlockMotion& out) {
  std::int16_t x[3][kBlock];
  std::int16_t d[3][kBlock];
  std::int64_t sum_x[3], sum_d[3];
  for (int a = 0; a < 3; ++a) {
    std::int32_t sum = 0;  // coordinates have 19 bits
    for (int i = 0; i < count; ++i) sum += last.at[a][i];
    const auto center = static_cast<std::int32_t>(per_particle(sum, count));
    std::int32_t sx = 0, sd = 0;
    for (int i = 0; i < count; ++i) {
      const std::int32_t place = limited(last.at[a][i] - center);
      const std::int32_t moved = limited(last.at[a][i] - before.at[a][i]);
      x[a][i] = static_cast<std::int16_t>(place);
      d[a][i] = static_cast<std::int16_t>(moved);
      sx += place;
      sd += moved;
      out.own[a][i] = moved * (1 << kFine);
    }
    sum_x[a] = sx;
    sum_d[a] = sd;
  }
  Moments s{};
  std::int64_t r[3][3];  // of velocity axis, with position axis
  int entry = 0;
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b)
      s.m[entry++] = dot(x[a], x[b], count) - per_particle(sum_x[a] * sum_x[b], count);
    for (int b = 0; b < 3; ++b) r[a][b] = dot(d[a], x[b], count) - per_particle(sum_d[a] * sum_x[b], count);
  }
  int shift = 0;
  while ((s.m[0] + s.m[3] + s.m[5]) >> shift >= 1 << 16) ++shift;
  for (std::int64_t& m : s.m) m >>= shift;
  const Moments inverse = inverted(s);
  static constexpr int kAt[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  for (int a = 0; a < 3; ++a) {
    std::int32_t slope[3];  // steps / 4096 a step
    for (int b = 0; b < 3; ++b) {
      std::int64_t sum = 0;
      for (int c = 0; c < 3; ++c) sum += inverse.m[kAt[b][c]] * (r[a][c] >> shift);
      slope[b] = static_cast<std::int32_t>(std::clamp<std::int64_t>(sum >> (29 - kFine), -8192, 8191));
    }
    const auto mean = static_cast<std::int32_t>(per_particle(sum_d[a] * (1 << kFine), count));
    for (int i = 0; i < count; ++i)
      out.smooth[a][i] = mean + slope[0] * x[0][i] + slope[1] * x[1][i] + slope[2] * x[2][i];
  }
}

void uniform_motion(const std::int32_t drift[3], int count, BlockMotion& out) {
  for (int a = 0; a < 3; ++a) {
    for (int i = 0; i < count; ++i) out.smooth[a][i] = out.own[a][i] = drift[a] * (1 << (kFine - 3));
  }
}

}  // namespace slosh::codec
