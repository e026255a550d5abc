// The last seconds of one number, as a curve. No Dear ImGui here.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace slosh {

/// A ring of samples. It starts empty: what was never measured is not drawn as zero.
class StripChart {
 public:
  /// `samples` >= 2 that it holds. `least_top` > 0: the scale's end until a sample is larger.
  StripChart(std::size_t samples, float least_top) : samples_(samples), top_(least_top) {}

  /// A sample, >= 0; the oldest goes where there is no room. What is not finite is left out.
  void add(float value);

  /// The largest so far, or the least top.
  float top() const { return top_; }
  std::size_t size() const { return values_.size(); }

  /// The curve in a rectangle (y down): the newest sample at its right edge, zero on its lower one, the top
  /// just below its upper one; samples are as far apart as in a full chart.
  std::vector<glm::vec2> curve(const glm::vec2& low, const glm::vec2& high) const;

 private:
  std::size_t samples_;
  std::vector<float> values_;  // a ring once it is full
  std::size_t oldest_ = 0;
  float top_;
};

}  // namespace slosh
