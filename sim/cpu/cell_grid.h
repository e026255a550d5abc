// Sorting particles by cell, and finding the rows of cells around one.
//
// Cells are cubes of at least the support radius, x fastest. Once particles are sorted by cell, the three
// cells (x−1, x, x+1) of a row are one contiguous run of particles: a particle's neighbours lie in nine such
// rows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace slosh {

/// The geometry of the grid: a box of cells with one cell of margin all around.
class CellGrid {
 public:
  CellGrid() = default;
  /// Covers [lower, upper] (m) with cells of at least `support_radius`. When that would take more than
  /// kMaxCells cells, the cells grow: slower, not wrong.
  CellGrid(const glm::dvec3& lower, const glm::dvec3& upper, double support_radius);

  static constexpr double kMaxCells = 4.0e6;

  /// True when the position is finite and inside the covered box.
  bool contains(float x, float y, float z) const {
    return x >= lower_.x && x <= upper_.x && y >= lower_.y && y <= upper_.y && z >= lower_.z && z <= upper_.z;
  }
  /// The cell of a position; positions outside count to the nearest cell.
  std::uint32_t cell_of(float x, float y, float z) const {
    const glm::vec3 p = glm::clamp(glm::vec3(x, y, z), lower_, upper_);
    const glm::uvec3 c = glm::uvec3((p - lower_) * inverse_cell_) + 1u;
    return c.x + cells_.x * (c.y + cells_.y * c.z);
  }
  std::uint32_t cell_count() const { return cells_.x * cells_.y * cells_.z; }
  /// Key of a particle that is out of the world: sorts behind all cells.
  std::uint32_t retired_key() const { return cell_count(); }
  /// First cells (x−1) of the nine rows around `cell`.
  std::array<std::uint32_t, 9> rows_around(std::uint32_t cell) const {
    std::array<std::uint32_t, 9> rows;
    const std::uint32_t line = cells_.x;
    const std::uint32_t slab = cells_.x * cells_.y;
    const std::uint32_t first = cell - slab - line - 1;
    for (std::uint32_t z = 0; z < 3; ++z) {
      for (std::uint32_t y = 0; y < 3; ++y) rows[3 * z + y] = first + z * slab + y * line;
    }
    return rows;
  }

 private:
  glm::vec3 lower_{0.0f};
  glm::vec3 upper_{0.0f};
  float inverse_cell_ = 1.0f;
  glm::uvec3 cells_{3u};
};

/// A contiguous range of sorted particles.
struct ParticleRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

/// An occupied cell and its particles.
struct CellRun {
  std::uint32_t cell = 0;
  ParticleRange particles;
};

/// The non-empty rows around a cell.
struct RowList {
  std::array<ParticleRange, 9> rows;
  int count = 0;
};

/// Where each cell's particles are in one sorted set.
class CellIndex {
 public:
  /// sorted_keys: the cell of each particle, rising; entries >= grid.retired_key() are left out.
  void rebuild(const CellGrid& grid, const std::uint32_t* sorted_keys, std::size_t count);

  const std::vector<CellRun>& runs() const { return runs_; }
  std::size_t particles() const { return runs_.empty() ? 0 : runs_.back().particles.end; }
  RowList rows(const CellGrid& grid, std::uint32_t cell) const;

 private:
  // An empty cell is {max, 0}, so that a row is the minimum of the begins and the maximum of the ends.
  static constexpr ParticleRange kEmpty{0xffffffffu, 0};
  std::vector<ParticleRange> cells_;
  std::vector<CellRun> runs_;
};

/// Stable radix sort of keys. After the call order[i] is the old index of the i-th particle and keys is
/// sorted.
class KeySorter {
 public:
  void sort(std::uint32_t* keys, std::size_t count, std::uint32_t largest_key);
  const std::uint32_t* order() const { return order_.data(); }

 private:
  std::vector<std::uint64_t> items_, scratch_;
  std::vector<std::uint32_t> order_;
};

}  // namespace slosh
