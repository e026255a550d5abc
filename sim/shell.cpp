#include "sim/shell.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slosh {

namespace {

constexpr double kCellWidth = 1.4;  // spacings
constexpr std::int64_t kMaxCells = std::int64_t{1} << 24;
constexpr std::uint8_t kEmpty = 0, kFluid = 1, kOutside = 2;
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
  if (!(cells.x * cells.y * cells.z <= static_cast<double>(kMaxCells))) {
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
    filled[cell_of[i]] = kFluid;
  }
  // What is reached from outside through faces. Gaps within the fluid, of which every splash has many, are
  // not seen and stay out.
  const std::int64_t around[6] = {
      -1, 1, -static_cast<std::int64_t>(row), row, -static_cast<std::int64_t>(plane), plane};
  const auto total = static_cast<std::int64_t>(filled.size());
  thread_local std::vector<std::uint32_t> reached;
  reached.assign(1, 0);
  filled[0] = kOutside;
  while (!reached.empty()) {
    const std::int64_t from = reached.back();
    reached.pop_back();
    for (const std::int64_t step : around) {
      // A step over a side's end leads to the rim on the other side, which is outside as well.
      const std::int64_t to = from + step;
      if (to < 0 || to >= total || filled[static_cast<std::size_t>(to)] != kEmpty) continue;
      filled[static_cast<std::size_t>(to)] = kOutside;
      reached.push_back(static_cast<std::uint32_t>(to));
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (cell_of[i] == kNowhere) continue;
    bool seen = false;
    for (const std::int64_t step : around)
      seen |= filled[static_cast<std::size_t>(cell_of[i] + step)] == kOutside;
    shell[i] = seen;
  }
}

}  // namespace slosh
