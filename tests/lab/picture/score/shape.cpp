#include "tests/lab/picture/score/shape.h"

#include <algorithm>
#include <vector>

namespace slosh::score {
namespace {

std::vector<char> fluid_of(const FloatImage& depth) {
  std::vector<char> fluid(depth.values.size());
  std::ranges::transform(depth.values, fluid.begin(), is_fluid);
  return fluid;
}

/// `fluid` is used up.
int pieces_of(std::vector<char>& fluid, int width, int height) {
  int pieces = 0;
  std::vector<int> open;
  for (int start = 0; start < width * height; ++start) {
    if (!fluid[static_cast<std::size_t>(start)]) continue;
    int size = 0;
    open.assign(1, start);
    fluid[static_cast<std::size_t>(start)] = 0;
    while (!open.empty()) {
      const int at = open.back();
      open.pop_back();
      ++size;
      const int x = at % width, y = at / width;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
          char& next = fluid[static_cast<std::size_t>(v * width + u)];
          if (next) open.push_back(v * width + u);
          next = 0;
        }
      }
    }
    pieces += size >= kMinPiece;
  }
  return pieces;
}

}  // namespace

ShapeScore score_shape(const Exact& drawn, const Exact& right) {
  std::vector<char> a = fluid_of(drawn.depth), b = fluid_of(right.depth);
  std::size_t both = 0, either = 0, in_a = 0, in_b = 0, normals = 0;
  ShapeScore score;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both += a[i] && b[i];
    either += a[i] || b[i];
    in_a += a[i];
    in_b += b[i];
    if (!a[i] || !b[i]) continue;
    const auto normal = [i](const FloatImage& of) {
      return glm::vec3(of.values[3 * i], of.values[3 * i + 1], of.values[3 * i + 2]);
    };
    const glm::vec3 n = normal(drawn.normal), m = normal(right.normal);
    if (glm::dot(n, n) < 0.5f) continue;
    score.normal_mean += degrees_between(n, m);
    ++normals;
  }
  const auto share = [](std::size_t of, std::size_t whole) {
    return whole ? static_cast<double>(of) / static_cast<double>(whole) : 0.0;
  };
  score.overlap = share(both, either);
  score.area = share(in_a, in_b);
  score.normal_mean = normals ? score.normal_mean / static_cast<double>(normals) : 0.0;
  score.pieces = pieces_of(a, drawn.depth.width, drawn.depth.height);
  score.right_pieces = pieces_of(b, right.depth.width, right.depth.height);
  return score;
}

}  // namespace slosh::score
