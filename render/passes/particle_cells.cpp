#include "render/passes/particle_cells.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace slosh {
namespace {

bool counts(const Frame& frame, std::size_t i) {
  const glm::vec3& at = frame.particles[i];
  return fluid_sample(frame.particle_fluid[i]).fluid < frame.fluids.size() &&
         std::isfinite(at.x + at.y + at.z);
}

/// Kept small enough for an integer; what is no number (the greater of a limit and it is the limit) at the
/// lower limit.
glm::vec3 in_cells(const glm::vec3& at, float reach) {
  return glm::floor(glm::min(glm::max(glm::vec3(-1e8f), at / reach), glm::vec3(1e8f)));
}

}  // namespace

glm::ivec3 ParticleCells::cell_of(const glm::vec3& at) const {
  return glm::clamp(glm::ivec3(in_cells(at, reach_)) - lowest_, glm::ivec3(0), cells_ - 1);
}

std::size_t ParticleCells::row_of(int y, int z) const {
  return (static_cast<std::size_t>(z) * cells_.y + y) * cells_.x;
}

void ParticleCells::fit_cells(const Frame& frame, std::size_t count) {
  glm::vec3 low(1e9f), high(-1e9f);
  glm::dvec3 sum(0.0);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!counts(frame, i)) continue;
    const glm::vec3 cell = in_cells(frame.particles[i], reach_);
    low = glm::min(low, cell);
    high = glm::max(high, cell);
    sum += cell;
    ++kept;
  }
  if (kept == 0) low = high = glm::vec3(0.0f);
  // A drop that flew far makes no large table: cells are cut off around the middle of all, and what lies
  // beyond is counted in the outermost, where whoever was near it is as well.
  const glm::vec3 middle = kept == 0 ? low : glm::vec3(glm::floor(sum / static_cast<double>(kept)));
  const double most = 8.0 * static_cast<double>(kept) + 4096.0;
  for (;;) {
    const glm::vec3 size = high - low + 1.0f;
    if (static_cast<double>(size.x) * size.y * size.z <= most) break;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    low[axis] = std::max(low[axis], middle[axis] - std::floor(0.25f * size[axis]));
    high[axis] = std::min(high[axis], middle[axis] + std::floor(0.25f * size[axis]));
  }
  lowest_ = glm::ivec3(low);
  cells_ = glm::ivec3(high - low) + 1;
}

void ParticleCells::sort(const Frame& frame, float reach) {
  const std::size_t count = std::min(frame.particles.size(), frame.particle_fluid.size());
  reach_ = reach;
  fit_cells(frame, count);
  begin_.assign(row_of(0, cells_.z) + 1, 0);
  constexpr std::uint32_t kNone = ~0u;
  cell_.assign(count, kNone);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!counts(frame, i)) continue;
    const glm::ivec3 cell = cell_of(frame.particles[i]);
    cell_[i] = static_cast<std::uint32_t>(row_of(cell.y, cell.z)) + static_cast<std::uint32_t>(cell.x);
    ++begin_[cell_[i] + 1];
    ++kept;
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  source_.resize(kept);
  for (auto& column : at_) column.assign(kept + kReadOn, 0.0f);
  // Filled from each cell's end downwards; afterwards begin_[c + 1] is where c begins.
  for (std::size_t i = count; i-- > 0;) {
    if (cell_[i] == kNone) continue;
    const std::uint32_t place = --begin_[cell_[i] + 1];
    for (int axis = 0; axis < 3; ++axis) at_[axis][place] = frame.particles[i][axis];
    source_[place] = static_cast<std::uint32_t>(i);
  }
  std::copy(begin_.begin() + 1, begin_.end(), begin_.begin());
  begin_.back() = static_cast<std::uint32_t>(kept);
}

ParticleCells::Runs ParticleCells::around(const glm::vec3& at) const {
  const glm::ivec3 middle = cell_of(at);
  const glm::ivec3 low = glm::max(middle - 1, glm::ivec3(0));
  const glm::ivec3 high = glm::min(middle + 1, cells_ - 1);
  Runs runs{};
  std::size_t count = 0;
  for (int z = low.z; z <= high.z; ++z) {
    for (int y = low.y; y <= high.y; ++y) {
      const std::size_t row = row_of(y, z);
      runs[count++] = {begin_[row + low.x], begin_[row + high.x + 1]};
    }
  }
  return runs;
}

}  // namespace slosh
