#include "sim/shell.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slosh {

namespace {

constexpr double kCellWidth = 1.2;  // spacings
constexpr std::int64_t kMostCells = std::int64_t{1} << 24;
constexpr std::uint32_t kNowhere = ~0u;

bool counts(const glm::vec3& p, std::uint8_t fluid) {
  return fluid != 255 && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

void find_shell(std::span<const glm::vec3> positions, std::span<const std::uint8_t> fluid_index,
                double spacing, std::vector<std::uint8_t>& shell) {
  const std::size_t count = std::min(positions.size(), fluid_index.size());
  shell.assign(positions.size(), 0);
  glm::vec3 lower(std::numeric_limits<float>::max()), upper(-std::numeric_limits<float>::max());
  for (std::size_t i = 0; i < count; ++i) {
    if (!counts(positions[i], fluid_index[i])) continue;
    lower = glm::min(lower, positions[i]);
    upper = glm::max(upper, positions[i]);
  }
  if (lower.x > upper.x) return;
  const double per_cell = 1.0 / (kCellWidth * spacing);
  // A rim of empty cells, so that every filled one has all its neighbours.
  const glm::dvec3 cells = glm::floor(glm::dvec3(upper - lower) * per_cell) + 3.0;
  if (!(cells.x * cells.y * cells.z <= static_cast<double>(kMostCells))) {
    for (std::size_t i = 0; i < count; ++i) shell[i] = counts(positions[i], fluid_index[i]);
    return;
  }
  const auto nx = static_cast<std::uint32_t>(cells.x), ny = static_cast<std::uint32_t>(cells.y);
  const std::uint32_t row = nx, plane = nx * ny;
  thread_local std::vector<std::uint8_t> filled;
  thread_local std::vector<std::uint32_t> cell_of;
  filled.assign(static_cast<std::size_t>(plane) * static_cast<std::size_t>(cells.z), 0);
  cell_of.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (!counts(positions[i], fluid_index[i])) {
      cell_of[i] = kNowhere;
      continue;
    }
    const glm::dvec3 at = glm::dvec3(positions[i] - lower) * per_cell;
    cell_of[i] = static_cast<std::uint32_t>(at.x) + 1 + row * (static_cast<std::uint32_t>(at.y) + 1) +
                 plane * (static_cast<std::uint32_t>(at.z) + 1);
    filled[cell_of[i]] = 1;
  }
  // Six faces and twelve edges; a corner's hole shows too little.
  const std::int64_t x = 1, y = row, z = plane;
  const std::int64_t around[18] = {-x,    x,      -y,    y,     -z,    z,      -x - y, x - y, -x + y,
                                   x + y, -x - z, x - z, z - x, x + z, -y - z, y - z,  z - y, y + z};
  for (std::size_t i = 0; i < count; ++i) {
    if (cell_of[i] == kNowhere) continue;
    const std::uint8_t* cell = filled.data() + cell_of[i];
    std::uint8_t inside = 1;
    for (const std::int64_t to : around) inside &= cell[to];
    shell[i] = inside ^ 1;
  }
}

}  // namespace slosh
