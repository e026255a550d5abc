#include "render/passes/narrow_range_on_cpu.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/renderer.h"
#include "render/shader_math.h"

namespace slosh {
namespace {

/// Pixels that are worked on side by side: loops over them are plain, so that the compiler makes them wide.
constexpr int kWide = 32;
constexpr int kBorder = 2;
using Lanes = std::array<float, kWide>;
using Indices = std::array<int, kWide>;

/// Any of these is fluid.
bool any_fluid(const float* depths, int count) {
  bool any = false;
  for (int i = 0; i < count; ++i) any |= depths[i] <= shader::kFluidDepthLimit;
  return any;
}

/// A line of neighbours for each of some pixels in a row: the pixel's place on it, its length, and how far
/// its elements and the lines are apart in memory.
struct Lines {
  const float* first;
  int at;
  bool at_moves;  ///< on by one from pixel to pixel: the lines are one row
  int length;
  int apart;
};

/// narrow_range.frag along one axis, for `count` pixels whose own depths are `here`.
void smooth_along(const Lines& lines, const float* here, int count, const NarrowRangeOnCpu::Kernel& kernel,
                  float* out) {
  Lanes depth, share, moved, weights, ahead_near, ahead_far, behind_near, behind_far;
  Indices stride, taps, at;
  const int last = lines.length - 1;
  int most = 0;
  for (int i = 0; i < kWide; ++i) {
    const bool fluid = i < count && here[std::min(i, count - 1)] <= shader::kFluidDepthLimit;
    depth[i] = fluid ? here[i] : shader::kFluidDepthLimit;
    at[i] = lines.at + (lines.at_moves ? i : 0);
    const int inside = std::min(at[i], last - at[i]);
    const float reach =
        shader::filter_reach(kernel.reach * kernel.pixels_per_metre / depth[i], static_cast<float>(inside));
    stride[i] = static_cast<int>(shader::filter_stride(reach, static_cast<float>(kernel.taps)));
    taps[i] = fluid && inside > 0 ? static_cast<int>(reach) / stride[i] : 0;
    share[i] = static_cast<float>(stride[i]) / (reach + 1.0f);
    moved[i] = 0.0f;
    weights[i] = 1.0f;
    ahead_near[i] = behind_near[i] = depth[i] - kernel.range;
    ahead_far[i] = behind_far[i] = depth[i] + kernel.range;
    most = std::max(most, taps[i]);
  }
  const int lane = lines.at_moves ? 0 : 1;
  for (int k = 1; k <= most; ++k) {
    for (int i = 0; i < kWide; ++i) {
      const int off = k * stride[i];
      const float a =
          lines.first[std::clamp(at[i] + off, 0, last) * lines.apart + lane * std::min(i, count - 1)];
      const float b =
          lines.first[std::clamp(at[i] - off, 0, last) * lines.apart + lane * std::min(i, count - 1)];
      const bool mine = k <= taps[i];
      const bool a_in = mine & (a >= ahead_near[i]) & (a <= ahead_far[i]);
      const bool b_in = mine & (b >= behind_near[i]) & (b <= behind_far[i]);
      const float x = static_cast<float>(k) * share[i];
      const float left = 1.0f - x * x;
      const float w = a_in & b_in ? left * left : 0.0f;
      moved[i] += a_in & b_in ? w * (a + b - 2.0f * depth[i]) : 0.0f;
      weights[i] += 2.0f * w;
      ahead_near[i] = a_in ? std::min(ahead_near[i], a - kernel.range) : ahead_near[i];
      ahead_far[i] = a_in ? std::max(ahead_far[i], a + kernel.range) : ahead_far[i];
      behind_near[i] = b_in ? std::min(behind_near[i], b - kernel.range) : behind_near[i];
      behind_far[i] = b_in ? std::max(behind_far[i], b + kernel.range) : behind_far[i];
    }
  }
  for (int i = 0; i < count; ++i)
    out[i] = here[i] <= shader::kFluidDepthLimit ? depth[i] + moved[i] / weights[i] : here[i];
}

/// The same over 5 × 5 pixels. `here`: the first pixel, within a picture of rows `apart` that has a border.
void smooth_block(const float* here, std::ptrdiff_t apart, int count, float range, float* out) {
  Lanes moved{}, weights;
  weights.fill(1.0f);
  for (int y = 0; y <= 2; ++y) {
    for (int x = y == 0 ? 1 : -2; x <= 2; ++x) {
      const float weight = shader::kernel_weight(std::sqrt(static_cast<float>(x * x + y * y)) / 3.4f);
      const float* a_row = here + y * apart + x;
      const float* b_row = here - y * apart - x;
      for (int i = 0; i < count; ++i) {
        const float middle = here[i];
        const float a = a_row[i];
        const float b = b_row[i];
        const bool both =
            (a >= middle - range) & (a <= middle + range) & (b >= middle - range) & (b <= middle + range);
        moved[i] += both ? weight * (a + b - 2.0f * middle) : 0.0f;
        weights[i] += both ? 2.0f * weight : 0.0f;
      }
    }
  }
  for (int i = 0; i < count; ++i)
    out[i] = here[i] <= shader::kFluidDepthLimit ? here[i] + moved[i] / weights[i] : here[i];
}

}  // namespace

std::span<const float> NarrowRangeOnCpu::run(std::span<const float> depths, glm::ivec2 size,
                                             const Kernel& kernel) {
  const int width = size.x;
  const int height = size.y;
  const std::ptrdiff_t bordered = width + 2 * kBorder;
  rows_.resize(depths.size());
  surface_.resize(depths.size());
  columns_.assign(static_cast<std::size_t>(bordered) * static_cast<std::size_t>(height + 2 * kBorder),
                  kNoFluidDepth);
  const auto for_each_run = [&](auto&& work) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; x += kWide) work(x, y, std::min(kWide, width - x));
  };
  for_each_run([&](int x, int y, int count) {
    const float* row = depths.data() + std::ptrdiff_t{y} * width;
    float* out = rows_.data() + std::ptrdiff_t{y} * width + x;
    if (any_fluid(row + x, count))
      smooth_along({row, x, true, width, 1}, row + x, count, kernel, out);
    else
      std::copy_n(row + x, count, out);
  });
  for_each_run([&](int x, int y, int count) {
    const float* here = rows_.data() + std::ptrdiff_t{y} * width + x;
    float* out = columns_.data() + (y + kBorder) * bordered + kBorder + x;
    if (any_fluid(here, count))
      smooth_along({rows_.data() + x, y, false, height, width}, here, count, kernel, out);
    else
      std::copy_n(here, count, out);
  });
  for_each_run([&](int x, int y, int count) {
    const float* here = columns_.data() + (y + kBorder) * bordered + kBorder + x;
    float* out = surface_.data() + std::ptrdiff_t{y} * width + x;
    if (any_fluid(here, count))
      smooth_block(here, bordered, count, kernel.range, out);
    else
      std::copy_n(here, count, out);
  });
  return surface_;
}

}  // namespace slosh
