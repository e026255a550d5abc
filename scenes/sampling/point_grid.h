// Points sorted into cells, to find those within a radius.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <unordered_map>
#include <vector>

namespace slosh::sampling {

/// Finds points within one cell's width. Visiting order is fixed by the points alone.
class PointGrid {
 public:
  /// `cell` in m, > 0.
  PointGrid(const std::vector<glm::vec3>& points, float cell) : cell_(cell) {
    if (points.empty()) return;
    low_ = points[0];
    glm::vec3 high = low_;
    for (const glm::vec3& p : points) {
      low_ = glm::min(low_, p);
      high = glm::max(high, p);
    }
    size_ = glm::ivec3((high - low_) / cell) + 1;
    sorted_.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) sorted_.push_back({key(cell_of(points[i])), i});
    std::sort(sorted_.begin(), sorted_.end(), [](const Slot& a, const Slot& b) {
      return a.key != b.key ? a.key < b.key : a.index < b.index;
    });
    first_.reserve(sorted_.size());
    for (std::uint32_t i = 0; i < sorted_.size(); ++i) first_.try_emplace(sorted_[i].key, i);
  }

  /// Calls visit(index) for every point in the 27 cells around `point`, a superset of those within a cell's
  /// width.
  template <class Visit>
  void each_near(const glm::vec3& point, Visit visit) const {
    const glm::ivec3 base = cell_of(point);
    for (int z = base.z - 1; z <= base.z + 1; ++z) {
      for (int y = base.y - 1; y <= base.y + 1; ++y) {
        for (int x = base.x - 1; x <= base.x + 1; ++x) {
          if (x < 0 || y < 0 || z < 0 || x >= size_.x || y >= size_.y || z >= size_.z) continue;
          const std::uint64_t k = key({x, y, z});
          const auto entry = first_.find(k);
          if (entry == first_.end()) continue;
          for (std::size_t i = entry->second; i < sorted_.size() && sorted_[i].key == k; ++i)
            visit(sorted_[i].index);
        }
      }
    }
  }

 private:
  struct Slot {
    std::uint64_t key;
    std::uint32_t index;
  };
  glm::ivec3 cell_of(const glm::vec3& p) const { return glm::ivec3(glm::floor((p - low_) / cell_)); }
  std::uint64_t key(const glm::ivec3& c) const {
    return static_cast<std::uint64_t>(c.x) +
           static_cast<std::uint64_t>(size_.x) *
               (static_cast<std::uint64_t>(c.y) +
                static_cast<std::uint64_t>(size_.y) * static_cast<std::uint64_t>(c.z));
  }

  float cell_;
  glm::vec3 low_{0.0f};
  glm::ivec3 size_{0};
  std::vector<Slot> sorted_;
  std::unordered_map<std::uint64_t, std::uint32_t> first_;
};

}  // namespace slosh::sampling
