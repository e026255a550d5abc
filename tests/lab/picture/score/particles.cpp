#include "tests/lab/picture/score/particles.h"

#include <algorithm>
#include <random>
#include <unordered_map>

namespace slosh::score {
namespace {

std::int64_t cell_key(const glm::ivec3& c) {
  return (static_cast<std::int64_t>(c.x) * 73856093) ^ (static_cast<std::int64_t>(c.y) * 19349663) ^
         (static_cast<std::int64_t>(c.z) * 83492791);
}

}  // namespace

std::vector<glm::vec3> jitter_lattice(const glm::vec3& low, const glm::vec3& high, float spacing,
                                      std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto jitter = [&] {
    return (static_cast<float>(random() >> 8) / 16777216.0f - 0.5f) * 0.9f * spacing;
  };
  const glm::ivec3 count = glm::max(glm::ivec3((high - low) / spacing), glm::ivec3(1));
  std::vector<glm::vec3> points;
  for (int z = 0; z < count.z; ++z) {
    for (int y = 0; y < count.y; ++y) {
      for (int x = 0; x < count.x; ++x) {
        const glm::vec3 off(jitter(), jitter(), jitter());
        points.push_back(glm::clamp(low + (glm::vec3(x, y, z) + 0.5f) * spacing + off, low, high));
      }
    }
  }
  return points;
}

void relax(std::vector<glm::vec3>& points, float spacing, const glm::vec3& low, const glm::vec3& high,
           int iterations) {
  const float reach = 1.05f * spacing;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    std::unordered_map<std::int64_t, std::vector<std::size_t>> cells;
    const auto cell_of = [&](const glm::vec3& p) { return glm::ivec3(glm::floor(p / reach)); };
    for (std::size_t i = 0; i < points.size(); ++i) cells[cell_key(cell_of(points[i]))].push_back(i);
    std::vector<glm::vec3> moved = points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::ivec3 cell = cell_of(points[i]);
      for (int n = 0; n < 27; ++n) {
        const auto found = cells.find(cell_key(cell + glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
        if (found == cells.end()) continue;
        for (std::size_t j : found->second) {
          const glm::vec3 apart = points[i] - points[j];
          const float distance = glm::length(apart);
          if (j == i || distance >= reach || distance < 1e-7f) continue;
          moved[i] += 0.2f * (reach - distance) * apart / distance;
        }
      }
      moved[i] = glm::clamp(moved[i], low, high);
    }
    points = std::move(moved);
  }
}

}  // namespace slosh::score
