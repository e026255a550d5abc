#include "scenes/mesh/weld.h"

#include <cmath>
#include <unordered_map>

namespace slosh::mesh {
namespace {

struct CellHash {
  std::size_t operator()(const glm::i64vec3& c) const {
    std::uint64_t h = 0x9E3779B97F4A7C15ull;
    for (int i = 0; i < 3; ++i) {
      h ^= static_cast<std::uint64_t>(c[i]) + 0x9E3779B97F4A7C15ull + (h << 6) + (h >> 2);
      h *= 0xBF58476D1CE4E5B9ull;
    }
    return static_cast<std::size_t>(h ^ (h >> 31));
  }
};

glm::i64vec3 cell_of(const glm::dvec3& p, double cell) {
  return glm::i64vec3(glm::floor(p / cell));
}

}  // namespace

WeldedMesh weld(const TriangleMesh& mesh) {
  WeldedMesh out;
  if (mesh.positions.empty()) return out;
  glm::dvec3 low(mesh.positions[0]);
  glm::dvec3 high = low;
  for (const glm::vec3& p : mesh.positions) {
    low = glm::min(low, glm::dvec3(p));
    high = glm::max(high, glm::dvec3(p));
  }
  const double tolerance = 1e-6 * glm::length(high - low);
  // Cells far wider than the tolerance: a point looks into more than one only when it lies on a cell's
  // border.
  const double cell = std::max(1000.0 * tolerance, 1e-12);

  std::unordered_map<glm::i64vec3, std::vector<std::uint32_t>, CellHash> cells;
  std::vector<std::uint32_t> welded(mesh.positions.size());
  const auto find = [&](const glm::dvec3& p) -> std::int64_t {
    const glm::i64vec3 from = cell_of(p - low - tolerance, cell);
    const glm::i64vec3 to = cell_of(p - low + tolerance, cell);
    for (std::int64_t z = from.z; z <= to.z; ++z) {
      for (std::int64_t y = from.y; y <= to.y; ++y) {
        for (std::int64_t x = from.x; x <= to.x; ++x) {
          const auto entry = cells.find({x, y, z});
          if (entry == cells.end()) continue;
          for (const std::uint32_t index : entry->second) {
            const glm::dvec3 way = out.points[index] - p;
            if (glm::dot(way, way) <= tolerance * tolerance) return index;
          }
        }
      }
    }
    return -1;
  };
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::dvec3 p(mesh.positions[i]);
    std::int64_t index = find(p);
    if (index < 0) {
      index = static_cast<std::int64_t>(out.points.size());
      out.points.push_back(p);
      cells[cell_of(p - low, cell)].push_back(static_cast<std::uint32_t>(index));
    }
    welded[i] = static_cast<std::uint32_t>(index);
  }
  out.triangles.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3& t = mesh.triangles[i];
    const glm::uvec3 w(welded[t.x], welded[t.y], welded[t.z]);
    if (w.x == w.y || w.y == w.z || w.z == w.x) continue;
    out.triangles.push_back(w);
    out.sources.push_back(static_cast<std::uint32_t>(i));
  }
  return out;
}

}  // namespace slosh::mesh
