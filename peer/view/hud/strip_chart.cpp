#include "peer/view/hud/strip_chart.h"

#include <algorithm>
#include <cmath>

namespace slosh {

void StripChart::add(float value) {
  if (!std::isfinite(value)) return;
  if (values_.size() < samples_) {
    values_.push_back(value);
  } else {
    values_[oldest_] = value;
    oldest_ = (oldest_ + 1) % samples_;
  }
  top_ = std::max(top_, value);
}

std::vector<glm::vec2> StripChart::curve(const glm::vec2& low, const glm::vec2& high) const {
  std::vector<glm::vec2> points;
  points.reserve(values_.size());
  const float step = (high.x - low.x) / static_cast<float>(samples_ - 1);
  const float scale = (high.y - low.y) / (1.05f * top_);
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const float value = values_[(oldest_ + i) % values_.size()];
    points.emplace_back(high.x - step * static_cast<float>(values_.size() - 1 - i), high.y - scale * value);
  }
  return points;
}

}  // namespace slosh
