// The grid of cells that particles are sorted by: geometry alone, for both backends.
//
// Cells are cubes of at least the support radius, x fastest, or slices of such cubes across x. Once particles
// are sorted by cell, those of a row that are near enough in x are one contiguous run of particles: a
// particle's neighbours lie in nine such rows.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "sim/math/host_device.h"

namespace slosh {

/// The geometry of the grid: a box of cells with one cell of margin all around.
class CellGrid {
 public:
  CellGrid() = default;
  /// Covers [lower, upper] (m) with cells of at least `support_radius`. When that would take more than
  /// `max_cells`, the cells grow: slower, not wrong.
  CellGrid(const glm::dvec3& lower, const glm::dvec3& upper, double support_radius,
           double max_cells = kMaxCells)
      : lower_(lower), upper_(upper) {
    const glm::dvec3 extent = glm::max(upper - lower, glm::dvec3(support_radius));
    // A hair more than the support radius: float rounding of a cell index must not hide a neighbour.
    double cell = support_radius * 1.0001;
    const auto count_at = [&](double size) {
      const glm::dvec3 n = glm::floor(extent / size) + 3.0;
      return n.x * n.y * n.z;
    };
    while (count_at(cell) > max_cells) cell *= 1.1;
    inverse_cell_ = glm::vec3(static_cast<float>(1.0 / cell));
    cells_ = glm::uvec3(glm::floor(extent / cell) + 3.0);
  }
  /// The same cells, each in up to `slices` across x: a row's run is shorter by up to a quarter. A line of
  /// them along x is a multiple of four and ends with one that no row reaches.
  CellGrid sliced(std::uint32_t slices) const {
    CellGrid grid = *this;
    const auto line = [&] { return (cells_.x * slices + 5) / 4 * 4; };
    while (slices > 1 && static_cast<double>(line()) * cells_.y * cells_.z > kMaxSlices) slices /= 2;
    grid.inverse_cell_.x *= static_cast<float>(slices);
    grid.cells_.x = line();
    grid.slices_ = slices;
    return grid;
  }

  static constexpr double kMaxCells = 4.0e6, kMaxSlices = 1.6e7;

  /// True when the position is finite and inside the covered box.
  SLOSH_HD bool contains(float x, float y, float z) const {
    return x >= lower_.x && x <= upper_.x && y >= lower_.y && y <= upper_.y && z >= lower_.z && z <= upper_.z;
  }
  /// The cell of a position; positions outside count to the nearest cell.
  SLOSH_HD std::uint32_t cell_of(float x, float y, float z) const {
    const glm::vec3 p = glm::clamp(glm::vec3(x, y, z), lower_, upper_);
    const glm::uvec3 c = glm::uvec3((p - lower_) * inverse_cell_) + glm::uvec3(slices_, 1, 1);
    return c.x + cells_.x * (c.y + cells_.y * c.z);
  }
  /// Where in its cell a position is, in bytes that a GPU subtracts four at a time: y and z in 64ths of the
  /// cell, 0, x in 64ths of a cube modulo four cubes. Lowest byte first.
  SLOSH_HD std::uint32_t coarse_of(float x, float y, float z) const {
    const glm::vec3 at = (glm::clamp(glm::vec3(x, y, z), lower_, upper_) - lower_) * inverse_cell_;
    const auto of_cell = [](float v) {
      return static_cast<std::uint32_t>(kCoarse * (v - static_cast<float>(static_cast<std::uint32_t>(v))));
    };
    const auto along = static_cast<std::uint32_t>(at.x * (kCoarse / static_cast<float>(slices_)));
    return along << 24 | of_cell(at.z) << 8 | of_cell(at.y);
  }
  /// Two that are within `reach` (m) of each other are less than the square root of this apart by
  /// coarse_of(), which rounds each coordinate down.
  std::int32_t coarse_reach_squared(float reach) const {
    const float units = kCoarse * reach * inverse_cell_.y + 1.76f;  // √3, and what floats round
    return static_cast<std::int32_t>(units * units) + 1;
  }
  static constexpr float kCoarse = 64.0f;

  SLOSH_HD std::uint32_t cell_count() const { return cells_.x * cells_.y * cells_.z; }
  /// Cells of a line along x, which follow each other.
  SLOSH_HD std::uint32_t line_cells() const { return cells_.x; }
  /// Key of a particle that is out of the world: sorts behind all cells.
  SLOSH_HD std::uint32_t retired_key() const { return cell_count(); }
  /// How many cells of a row may hold neighbours: one, and `slices` on either side.
  SLOSH_HD std::uint32_t row_cells() const { return 2 * slices_ + 1; }
  /// The first of them in the n-th of the nine rows around `cell`; n is 0–8, y before z.
  SLOSH_HD std::uint32_t row_around(std::uint32_t cell, std::uint32_t n) const {
    const std::uint32_t line = cells_.x;
    const std::uint32_t slab = cells_.x * cells_.y;
    return cell - slab - line - slices_ + (n / 3) * slab + (n % 3) * line;
  }

 private:
  glm::vec3 lower_{0.0f};
  glm::vec3 upper_{0.0f};
  glm::vec3 inverse_cell_{1.0f};
  glm::uvec3 cells_{3u};
  std::uint32_t slices_ = 1;
};

}  // namespace slosh
