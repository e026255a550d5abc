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

/// And no body hides it: what one does is negative.
bool is_seen_fluid(float depth) {
  return (depth >= 0.0f) & (depth <= shader::kFluidDepthLimit);
}

bool any_fluid(const float* depths, int count) {
  // In whole numbers, which the compiler makes wide where two comparisons in a bool are not.
  int any = 0;
  for (int i = 0; i < count; ++i) any |= is_seen_fluid(depths[i]) ? 1 : 0;
  return any != 0;
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

/// narrow_range.frag along one axis, for `count` pixels whose own depths are `here`. kHides: some of what the
/// line goes through may be hidden.
template <bool kHides>
void smooth_along(const Lines& lines, const float* here, int count, const NarrowRangeOnCpu::Kernel& kernel,
                  int wanted_taps, float* out) {
  Lanes depth, share, moved, weights, moved_along, along, squared;
  Lanes ahead_near, ahead_far, behind_near, behind_far;
  Indices stride, taps, at;
  const int last = lines.length - 1;
  int most = 0;
  for (int i = 0; i < kWide; ++i) {
    const float own = here[std::min(i, count - 1)];
    const bool fluid = i < count && is_seen_fluid(own);
    depth[i] = fluid ? own : shader::kFluidDepthLimit;
    at[i] = lines.at + (lines.at_moves ? i : 0);
    const int inside = std::min(at[i], last - at[i]);
    const float reach =
        shader::filter_reach(kernel.reach * kernel.pixels_per_metre / depth[i], static_cast<float>(inside));
    stride[i] = static_cast<int>(shader::filter_stride(reach, static_cast<float>(wanted_taps)));
    taps[i] = fluid && inside > 0 ? static_cast<int>(reach) / stride[i] : 0;
    share[i] = static_cast<float>(stride[i]) / (reach + 1.0f);
    moved[i] = 0.0f;
    if constexpr (kHides) moved_along[i] = along[i] = squared[i] = 0.0f;
    weights[i] = 1.0f;
    ahead_near[i] = behind_near[i] = depth[i] - kernel.range;
    ahead_far[i] = behind_far[i] = depth[i] + kernel.range;
    most = std::max(most, taps[i]);
  }
  const int lane = lines.at_moves ? 0 : 1;
  const float level = lines.at_moves ? kernel.radius : -1.0f;
  for (int k = 1; k <= most; ++k) {
    for (int i = 0; i < kWide; ++i) {
      const int off = k * stride[i];
      const float h = depth[i];
      const float a_marked =
          lines.first[std::clamp(at[i] + off, 0, last) * lines.apart + lane * std::min(i, count - 1)];
      const float b_marked =
          lines.first[std::clamp(at[i] - off, 0, last) * lines.apart + lane * std::min(i, count - 1)];
      // As the first pass of the shader has it: what is level with the pixel goes on.
      const float a = kHides && std::abs(a_marked + h) <= level ? -a_marked : a_marked;
      const float b = kHides && std::abs(b_marked + h) <= level ? -b_marked : b_marked;
      const bool mine = k <= taps[i];
      const bool a_in = mine & (!kHides | (a > 0.0f)) & (a >= ahead_near[i]) & (a <= ahead_far[i]);
      const bool b_in = mine & (!kHides | (b > 0.0f)) & (b >= behind_near[i]) & (b <= behind_far[i]);
      // with_pair() or with_one() of narrow_range.glsl; divided whether it counts or not, which goes side by
      // side.
      const float place = static_cast<float>(k) * share[i];
      const float left = 1.0f - place * place;
      if constexpr (kHides) {
        const float a_off = shader::off_in_inverse(h, a);
        const float b_off = shader::off_in_inverse(h, b);
        const float w_a = a_in & (b_in | (b < 0.0f)) ? left * left : 0.0f;
        const float w_b = b_in & (a_in | (a < 0.0f)) ? left * left : 0.0f;
        moved[i] += w_a * a_off + w_b * b_off;
        weights[i] += w_a + w_b;
        moved_along[i] += place * (w_a * a_off - w_b * b_off);
        along[i] += place * (w_a - w_b);
        squared[i] += place * place * (w_a + w_b);
      } else {
        // Both at once, by one division.
        const float w = a_in & b_in ? left * left : 0.0f;
        moved[i] += w * (2.0f * h - h * h * (a + b) / (a * b));
        weights[i] += 2.0f * w;
      }
      ahead_near[i] = a_in ? std::min(ahead_near[i], a - kernel.range) : ahead_near[i];
      ahead_far[i] = a_in ? std::max(ahead_far[i], a + kernel.range) : ahead_far[i];
      behind_near[i] = b_in ? std::min(behind_near[i], b - kernel.range) : behind_near[i];
      behind_far[i] = b_in ? std::max(behind_far[i], b + kernel.range) : behind_far[i];
    }
  }
  for (int i = 0; i < count; ++i) {
    float off = moved[i] / weights[i];
    if constexpr (kHides) off = shader::fitted({moved[i], weights[i], moved_along[i], along[i], squared[i]});
    out[i] = is_seen_fluid(here[i]) ? shader::depth_of_off(depth[i], off) : here[i];
  }
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
        const bool both = (std::min(a, b) > 0.0f) & (a >= middle - range) & (a <= middle + range) &
                          (b >= middle - range) & (b <= middle + range);
        moved[i] += both ? weight * (a + b - 2.0f * middle) : 0.0f;
        weights[i] += both ? 2.0f * weight : 0.0f;
      }
    }
  }
  for (int i = 0; i < count; ++i)
    out[i] = is_seen_fluid(here[i]) ? here[i] + moved[i] / weights[i] : std::abs(here[i]);
}

}  // namespace

void NarrowRangeOnCpu::find_hidden(std::span<const float> depths, std::span<const float> bodies,
                                   glm::ivec2 size, float radius) {
  seen_.resize(depths.size());
  const int runs = (size.x + kWide - 1) / kWide;
  const std::ptrdiff_t apart = runs + 1;
  hidden_before_.assign(static_cast<std::size_t>(apart * (size.y + 1)), 0);
  for (int y = 0; y < size.y; ++y) {
    int* below = hidden_before_.data() + (y + 1) * apart;
    int in_row = 0;
    for (int run = 0; run < runs; ++run) {
      const std::ptrdiff_t first = std::ptrdiff_t{y} * size.x + run * kWide;
      const int count = std::min(kWide, size.x - run * kWide);
      bool any = false;
      for (std::ptrdiff_t i = first; i < first + count; ++i) {
        const bool hidden =
            (depths[i] <= shader::kFluidDepthLimit) & shader::is_hidden(depths[i], bodies[i], radius);
        seen_[i] = hidden ? -depths[i] : depths[i];
        any |= hidden;
      }
      in_row += any ? 1 : 0;
      below[run + 1] = below[run + 1 - apart] + in_row;
    }
  }
}

bool NarrowRangeOnCpu::any_hidden(glm::ivec2 low, glm::ivec2 high, glm::ivec2 size) const {
  const int last_run = (size.x - 1) / kWide;
  const std::ptrdiff_t apart = last_run + 2;
  const int left = std::max(low.x, 0) / kWide;
  const int right = std::min(high.x / kWide, last_run) + 1;
  const auto to = [&](int run, int y) { return hidden_before_[static_cast<std::size_t>(y * apart + run)]; };
  const int top = std::max(low.y, 0);
  const int bottom = std::min(high.y, size.y - 1) + 1;
  return to(right, bottom) - to(left, bottom) - to(right, top) + to(left, top) > 0;
}

std::span<const float> NarrowRangeOnCpu::run(std::span<const float> depths, std::span<const float> bodies,
                                             glm::ivec2 size, const Kernel& kernel) {
  const int width = size.x;
  const int height = size.y;
  const std::ptrdiff_t bordered = width + 2 * kBorder;
  find_hidden(depths, bodies, size, kernel.radius);
  rows_.resize(depths.size());
  surface_.resize(depths.size());
  columns_.assign(static_cast<std::size_t>(bordered) * static_cast<std::size_t>(height + 2 * kBorder),
                  kNoFluidDepth);
  const auto for_each_run = [&](auto&& work) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; x += kWide) work(x, y, std::min(kWide, width - x));
  };
  // Along one axis, by the short way where nothing within reach is hidden.
  const auto smooth = [&](const Lines& lines, glm::ivec2 at, const float* here, int count, float* out) {
    if (!any_fluid(here, count)) {
      std::copy_n(here, count, out);
      return;
    }
    float nearest = kNoFluidDepth;
    for (int i = 0; i < count; ++i) nearest = is_seen_fluid(here[i]) ? std::min(nearest, here[i]) : nearest;
    const float most = static_cast<float>(std::max(width, height));
    const int reach = static_cast<int>(std::min(kernel.reach * kernel.pixels_per_metre / nearest, most)) + 1;
    const glm::ivec2 off = lines.at_moves ? glm::ivec2(reach, 0) : glm::ivec2(0, reach);
    const bool hides = any_hidden(at - off, at + glm::ivec2(count - 1, 0) + off, size);
    // Beside what is hidden a tap more or less shows: few of them, far apart, left a net of dots there, along
    // rows that end at it and then down the columns of what those rows have made.
    const bool beside =
        hides || (!lines.at_moves && any_hidden(at - reach, at + glm::ivec2(count - 1, 0) + reach, size));
    const int taps = beside ? kernel.taps_beside : kernel.taps;
    (hides ? smooth_along<true> : smooth_along<false>)(lines, here, count, kernel, taps, out);
  };
  for_each_run([&](int x, int y, int count) {
    const float* row = seen_.data() + std::ptrdiff_t{y} * width;
    smooth({row, x, true, width, 1}, {x, y}, row + x, count, rows_.data() + std::ptrdiff_t{y} * width + x);
  });
  for_each_run([&](int x, int y, int count) {
    smooth({rows_.data() + x, y, false, height, width}, {x, y}, rows_.data() + std::ptrdiff_t{y} * width + x,
           count, columns_.data() + (y + kBorder) * bordered + kBorder + x);
  });
  for_each_run([&](int x, int y, int count) {
    const float* here = columns_.data() + (y + kBorder) * bordered + kBorder + x;
    float* out = surface_.data() + std::ptrdiff_t{y} * width + x;
    if (any_fluid(here, count))
      smooth_block(here, bordered, count, kernel.range, out);
    else
      std::transform(here, here + count, out, [](float depth) { return std::abs(depth); });
  });
  return surface_;
}

}  // namespace slosh
