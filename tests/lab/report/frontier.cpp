#include "tests/lab/report/frontier.h"

#include <cmath>

#include "tests/lab/report/surface.h"

namespace slosh::report {

std::vector<bool> on_frontier(const std::vector<glm::dvec2>& points) {
  std::vector<bool> best(points.size(), true);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 p = points[i];
    best[i] = std::isfinite(p.x) && std::isfinite(p.y);
    for (const glm::dvec2& q : points) {
      const bool as_good = q.x <= p.x && q.y <= p.y;  // false for what is not a number
      if (as_good && (q.x < p.x || q.y < p.y)) best[i] = false;
    }
  }
  return best;
}

std::optional<double> order_of(const std::vector<glm::dvec2>& spacing_and_error) {
  std::vector<glm::dvec2> logs;
  bool differ = false;
  for (const glm::dvec2& p : spacing_and_error) {
    if (!(std::abs(p.y) > 0.0) || !std::isfinite(p.y)) return std::nullopt;
    logs.emplace_back(std::log(p.x), std::log(std::abs(p.y)));
    differ = differ || logs.back().x != logs.front().x;
  }
  if (!differ) return std::nullopt;
  return slope_of(logs);
}

}  // namespace slosh::report
