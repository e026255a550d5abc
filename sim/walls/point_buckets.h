// Points in cubes, for asking who is near.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <unordered_map>
#include <vector>

namespace slosh {

/// Of a spacing. Wider holes in a layer of wall particles leak. The sampler's own are up to 0.8; at 0.9 a
/// tank of walls five spacings thick lost an eighth of its fluid through its edges in 3 s.
inline constexpr float kLargestHole = 0.7f;

class PointBuckets {
 public:
  explicit PointBuckets(float cell) : cell_(cell) {}

  void add(const glm::vec3& p) { buckets_[key(cell_of(p))].push_back({p, count_++}); }

  /// Calls f(point, number) for all points in the 27 cubes around p: those within one cell, and some more.
  /// Points are numbered from 0 as they were added.
  template <class F>
  void around(const glm::vec3& p, F&& f) const {
    const glm::ivec3 center = cell_of(p);
    for (int n = 0; n < 27; ++n) {
      const auto found = buckets_.find(key(center + glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      if (found == buckets_.end()) continue;
      for (const Entry& entry : found->second) f(entry.point, entry.number);
    }
  }

  /// Whether a point is nearer to p than `distance`, which is at most a cell.
  bool any_within(const glm::vec3& p, float distance) const {
    bool found = false;
    around(p, [&](const glm::vec3& q, std::uint32_t) { found |= glm::distance(p, q) < distance; });
    return found;
  }

 private:
  struct Entry {
    glm::vec3 point;
    std::uint32_t number;
  };

  glm::ivec3 cell_of(const glm::vec3& p) const { return glm::ivec3(glm::floor(p / cell_)); }
  static std::int64_t key(const glm::ivec3& c) {
    constexpr std::int64_t kOffset = 1 << 20;  // 21 bits an axis: a million cells to either side
    return (c.x + kOffset) | ((c.y + kOffset) << 21) | ((c.z + kOffset) << 42);
  }

  float cell_;
  std::uint32_t count_ = 0;
  std::unordered_map<std::int64_t, std::vector<Entry>> buckets_;
};

}  // namespace slosh
