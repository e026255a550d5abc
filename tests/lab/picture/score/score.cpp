#include "tests/lab/picture/score/score.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "render/renderer.h"

namespace slosh::score {
namespace {

/// Pixels within kEdgeBand of a jump of the exact depth or of the picture's end.
std::vector<bool> edges(const FloatImage& depth, float jump) {
  const int width = depth.width;
  const int height = depth.height;
  std::vector<bool> edge(static_cast<std::size_t>(width) * height, false);
  const auto mark = [&](int x, int y) {
    for (int v = std::max(y - kEdgeBand, 0); v <= std::min(y + kEdgeBand, height - 1); ++v) {
      for (int u = std::max(x - kEdgeBand, 0); u <= std::min(x + kEdgeBand, width - 1); ++u)
        edge[static_cast<std::size_t>(v) * width + u] = true;
    }
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float d = depth.at(x, y);
      const bool right = x + 1 < width && std::abs(depth.at(x + 1, y) - d) > jump;
      const bool below = y + 1 < height && std::abs(depth.at(x, y + 1) - d) > jump;
      if (right || below) mark(x, y);
    }
  }
  return edge;
}

}  // namespace

SurfaceScore score_surface(const FloatImage& depth, const FloatImage& normal, const Exact& exact,
                           float particle_radius, float jump) {
  const std::vector<bool> edge = edges(exact.depth, jump);
  std::vector<double> inside;
  std::vector<double> off;
  double edge_sum = 0.0;
  std::size_t edge_count = 0;
  std::size_t differ = 0;
  std::size_t outline = 0;
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * depth.width + x;
      const bool there = is_fluid(exact.depth.at(x, y));
      const bool drawn = is_fluid(depth.at(x, y));
      differ += there != drawn ? 1 : 0;
      if (x + 1 < depth.width && there != is_fluid(exact.depth.at(x + 1, y))) ++outline;
      if (y + 1 < depth.height && there != is_fluid(exact.depth.at(x, y + 1))) ++outline;
      const glm::vec3 n(normal.at(x, y, 0), normal.at(x, y, 1), normal.at(x, y, 2));
      if (!there || !drawn || glm::dot(n, n) < 0.5f) continue;
      const glm::vec3 e(exact.normal.at(x, y, 0), exact.normal.at(x, y, 1), exact.normal.at(x, y, 2));
      const double angle = degrees_between(n, e);
      if (edge[i]) {
        edge_sum += angle;
        ++edge_count;
        continue;
      }
      inside.push_back(angle);
      off.push_back((depth.at(x, y) - exact.depth.at(x, y)) / particle_radius);
    }
  }
  SurfaceScore score;
  score.pixels = inside.size();
  score.edge_mean = edge_count ? edge_sum / static_cast<double>(edge_count) : 0.0;
  // A step of the outline along a row and one along a column are one piece of it, 1.27 steps a pixel on
  // average (4/π).
  score.silhouette = outline ? static_cast<double>(differ) / (static_cast<double>(outline) * 0.7854) : 0.0;
  if (inside.empty()) return score;
  const auto count = static_cast<double>(inside.size());
  for (std::size_t i = 0; i < inside.size(); ++i) {
    score.normal_mean += inside[i] / count;
    score.depth_bias += off[i] / count;
  }
  for (const double o : off) score.depth_rms += (o - score.depth_bias) * (o - score.depth_bias) / count;
  score.depth_rms = std::sqrt(score.depth_rms);
  const auto p95 = inside.begin() + static_cast<std::ptrdiff_t>(0.95 * count);
  std::ranges::nth_element(inside, p95);
  score.normal_p95 = *p95;
  return score;
}

PictureScore score_picture(const Image& drawn, const Image& right, const FloatImage& depth, float jump) {
  const std::vector<bool> edge = edges(depth, jump);
  PictureScore score;
  for (std::size_t i = 0; i < edge.size(); ++i) {
    if (!edge[i] && !is_fluid(depth.values[i])) continue;
    double off = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      off += std::abs(int{drawn.rgba[4 * i + c]} - int{right.rgba[4 * i + c]}) / 3.0;
    (edge[i] ? score.edges : score.inside) += off;
    ++(edge[i] ? score.edge_pixels : score.inside_pixels);
  }
  score.inside /= static_cast<double>(std::max<std::size_t>(score.inside_pixels, 1));
  score.edges /= static_cast<double>(std::max<std::size_t>(score.edge_pixels, 1));
  return score;
}

double flicker(const Image& a, const Image& b) {
  if (a.rgba.size() != b.rgba.size() || a.rgba.empty()) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    if (i % 4 < 3) sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
  }
  return sum / (0.75 * static_cast<double>(a.rgba.size()));
}

StirScore score_stir(const std::array<FloatImage, 3>& light, const std::array<FloatImage, 3>& index) {
  const auto shown = [](float value) {
    const double v = std::clamp(static_cast<double>(value), 0.0, 1.0);
    return 255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055);
  };
  StirScore score;
  for (std::size_t i = 0; i < index[1].values.size(); ++i) {
    if (std::ranges::any_of(index, [&](const FloatImage& of) { return of.values[i] < 0.0f; })) continue;
    ++score.pixels;
    for (std::size_t c = 0; c < 3; ++c) {
      const double before = shown(light[0].values[3 * i + c]);
      const double now = shown(light[1].values[3 * i + c]);
      const double after = shown(light[2].values[3 * i + c]);
      score.change += (std::abs(now - before) + std::abs(after - now)) / 6.0;
      score.restless += std::abs(now - 0.5 * (before + after)) / 3.0;
    }
  }
  score.change /= static_cast<double>(std::max<std::size_t>(score.pixels, 1));
  score.restless /= static_cast<double>(std::max<std::size_t>(score.pixels, 1));
  return score;
}

}  // namespace slosh::score
