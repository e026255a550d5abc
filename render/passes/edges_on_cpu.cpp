#include "render/passes/edges_on_cpu.h"

#include <algorithm>
#include <cmath>

#include "render/shader_math.h"

namespace slosh {
namespace {

/// What edges.frag reads of the picture.
class Shown {
 public:
  Shown(std::span<const std::uint8_t> rgba, glm::ivec2 size, const std::vector<float>& brightness)
      : rgba_(rgba), size_(size), brightness_(brightness) {}

  float brightness(const glm::ivec2& at) const { return brightness_[index(at)]; }
  glm::vec3 color(const glm::ivec2& at) const {
    const std::uint8_t* c = &rgba_[4 * index(at)];
    return {c[0], c[1], c[2]};
  }

  /// Steps along the edge to where it ends, and there the mean over the edge less that here.
  glm::vec2 edge_end(const glm::ivec2& texel, const glm::ivec2& along, const glm::ivec2& over, float here,
                     float tolerance) const {
    for (int k = 1; k <= shader::kLongestEdge; ++k) {
      const glm::ivec2 at = texel + along * k;
      const float off = 0.5f * (brightness(at) + brightness(at + over)) - here;
      if (std::abs(off) >= tolerance) return {static_cast<float>(k), off};
    }
    return {static_cast<float>(shader::kLongestEdge), 0.0f};
  }

 private:
  std::size_t index(const glm::ivec2& at) const {
    const glm::ivec2 inside = glm::clamp(at, glm::ivec2(0), size_ - 1);
    return static_cast<std::size_t>(inside.y) * static_cast<std::size_t>(size_.x) +
           static_cast<std::size_t>(inside.x);
  }
  std::span<const std::uint8_t> rgba_;
  glm::ivec2 size_;
  const std::vector<float>& brightness_;
};

glm::vec3 smoothed(const Shown& shown, const glm::ivec2& texel, const shader::Cross& cross) {
  const auto at = [&](int x, int y) { return shown.brightness(texel + glm::ivec2(x, y)); };
  const shader::Corners corners{at(-1, 1), at(1, 1), at(-1, -1), at(1, -1)};
  const bool level = shader::edge_is_level(cross, corners);
  const float before = level ? cross.below : cross.left;
  const float after = level ? cross.above : cross.right;
  const bool to_before = std::abs(before - cross.middle) >= std::abs(after - cross.middle);
  const float other = to_before ? before : after;
  const glm::ivec2 over = (level ? glm::ivec2(0, 1) : glm::ivec2(1, 0)) * (to_before ? -1 : 1);
  const glm::ivec2 along = level ? glm::ivec2(1, 0) : glm::ivec2(0, 1);
  const float here = 0.5f * (cross.middle + other);
  const float tolerance = 0.25f * std::abs(other - cross.middle);
  const glm::vec2 ahead = shown.edge_end(texel, along, over, here, tolerance);
  const glm::vec2 back = shown.edge_end(texel, -along, over, here, tolerance);
  return glm::mix(shown.color(texel), shown.color(texel + over),
                  shader::other_share(cross, corners, here, ahead, back));
}

}  // namespace

void smooth_edges(std::span<const std::uint8_t> rgba, glm::ivec2 size, PixelBox changed,
                  std::vector<float>& brightness, std::vector<std::uint8_t>& out) {
  const auto width = static_cast<std::size_t>(size.x);
  const auto height = static_cast<std::size_t>(size.y);
  if (brightness.size() != width * height || out.size() != rgba.size()) changed = {glm::ivec2(0), size};
  brightness.resize(width * height);
  out.resize(rgba.size());
  for (int y = changed.low.y; y < changed.high.y; ++y) {
    const std::size_t end = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(changed.high.x);
    for (std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(changed.low.x);
         i < end; ++i)
      brightness[i] = (0.299f * rgba[4 * i] + 0.587f * rgba[4 * i + 1] + 0.114f * rgba[4 * i + 2]) / 255.0f;
  }
  // An edge's end is looked for so far away, and one more is read beyond it.
  const PixelBox box = changed.grown(shader::kLongestEdge + 2, size);
  const auto left = static_cast<std::size_t>(box.low.x);
  const auto right = static_cast<std::size_t>(box.high.x);
  const Shown shown(rgba, size, brightness);
  std::vector<std::uint8_t> edge(width);
  for (auto y = static_cast<std::size_t>(box.low.y); y < static_cast<std::size_t>(box.high.y); ++y) {
    std::copy_n(&rgba[4 * (y * width + left)], 4 * (right - left), &out[4 * (y * width + left)]);
    const float* row = &brightness[y * width];
    const float* above = y + 1 < height ? row + width : row;
    const float* below = y > 0 ? row - width : row;
    // Most pixels have none: a plain loop over the row, which the compiler makes wide.
    for (std::size_t x = std::max<std::size_t>(left, 1); x < std::min(right, width - 1); ++x) {
      const float high =
          std::max(std::max(row[x], above[x]), std::max(below[x], std::max(row[x - 1], row[x + 1])));
      const float low =
          std::min(std::min(row[x], above[x]), std::min(below[x], std::min(row[x - 1], row[x + 1])));
      edge[x] = high - low > std::max(0.04f, 0.125f * high) ? 1 : 0;
    }
    edge.front() = edge.back() = 1;  // asked below
    for (std::size_t x = left; x < right; ++x) {
      if (!edge[x]) continue;
      const glm::ivec2 texel(static_cast<int>(x), static_cast<int>(y));
      const auto at = [&](int dx, int dy) { return shown.brightness(texel + glm::ivec2(dx, dy)); };
      const shader::Cross cross{row[x], at(0, 1), at(0, -1), at(1, 0), at(-1, 0)};
      if (!shader::has_edge(cross)) continue;
      const glm::vec3 color = smoothed(shown, texel, cross);
      for (int c = 0; c < 3; ++c)
        out[4 * (y * width + x) + static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::lround(color[c]));
    }
  }
}

}  // namespace slosh
