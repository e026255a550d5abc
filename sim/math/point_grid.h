// Points sorted into cells, to find those within a radius.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace slosh {

/// Finds points within one cell's width. Visiting order is fixed by the points alone.
class PointGrid {
 public:
  /// `cell` in m, > 0; it is widened where the points are so far apart that the cells would not fit memory.
  PointGrid(const std::vector<glm::vec3>& points, float cell) : cell_(cell) {
    if (points.empty()) return;
    low_ = points[0];
    glm::vec3 high = low_;
    for (const glm::vec3& p : points) {
      low_ = glm::min(low_, p);
      high = glm::max(high, p);
    }
    for (;; cell_ *= 1.5f) {
      const glm::dvec3 cells = glm::dvec3(high - low_) / static_cast<double>(cell_) + 1.0;
      if (cells.x * cells.y * cells.z > kMaxCells) continue;
      size_ = glm::ivec3(cells) + 1;  // one to spare: the quotient may round up
      break;
    }
    // A counting sort: cell → its points, rising.
    first_.assign(static_cast<std::size_t>(size_.x) * size_.y * size_.z + 1, 0);
    for (const glm::vec3& p : points) ++first_[index(cell_of(p)) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    sorted_.resize(points.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < points.size(); ++i) sorted_[next[index(cell_of(points[i]))]++] = i;
  }

  /// Calls visit(index) for every point in the 27 cells around `point`, a superset of those within a cell's
  /// width.
  template <class Visit>
  void each_near(const glm::vec3& point, Visit visit) const {
    if (sorted_.empty()) return;
    const glm::ivec3 base = cell_of(point);
    const glm::ivec3 from = glm::max(base - 1, glm::ivec3(0));
    const glm::ivec3 to = glm::min(base + 1, size_ - 1);
    if (from.x > to.x) return;
    for (int z = from.z; z <= to.z; ++z) {
      for (int y = from.y; y <= to.y; ++y) {
        const std::size_t end = first_[index({to.x, y, z}) + 1];
        for (std::size_t i = first_[index({from.x, y, z})]; i < end; ++i) visit(sorted_[i]);
      }
    }
  }

 private:
  static constexpr double kMaxCells = 8e6;

  glm::ivec3 cell_of(const glm::vec3& p) const {
    // Clamped before the conversion: a point may be far off the grid.
    return glm::ivec3(glm::clamp(glm::floor((p - low_) / cell_), glm::vec3(-2.0f), glm::vec3(size_ + 1)));
  }
  std::size_t index(const glm::ivec3& c) const {
    return static_cast<std::size_t>(c.x) +
           static_cast<std::size_t>(size_.x) *
               (static_cast<std::size_t>(c.y) + static_cast<std::size_t>(size_.y) * c.z);
  }

  float cell_;
  glm::vec3 low_{0.0f};
  glm::ivec3 size_{0};
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> sorted_;
};

}  // namespace slosh
