#include "render/passes/smooth_centers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "render/shader_math.h"

namespace slosh {
namespace {

constexpr int kTileWide =
    16;  // neighbours side by side: loops over them are plain, so that the compiler makes them wide
using TileLanes = std::array<float, kTileWide>;

/// Particles that lie one after the other in memory.
struct Run {
  std::uint32_t first, end;
};

float total(TileLanes lanes) {
  for (int half = kTileWide / 2; half > 0; half /= 2) {
    for (int i = 0; i < half; ++i) lanes[i] += lanes[i + half];
  }
  return lanes[0];
}

/// Of all in `runs` that lie within reach of `at`. Up to kTileWide - 1 places behind a run are read.
shader::Neighbourhood neighbourhood_of(const std::array<std::vector<float>, 3>& places,
                                       std::span<const Run> runs, const glm::vec3& at, float reach) {
  const float inverse = 1.0f / reach;
  const float squared_reach = reach * reach;
  TileLanes w{}, x{}, y{}, z{}, xx{}, yy{}, zz{}, xy{}, yz{}, zx{};
  for (const Run& run : runs) {
    for (std::uint32_t k = run.first; k < run.end; k += kTileWide) {
      const float* px = &places[0][k];
      const float* py = &places[1][k];
      const float* pz = &places[2][k];
      const int here = static_cast<int>(run.end - k);
      for (int i = 0; i < kTileWide; ++i) {
        const float dx = px[i] - at.x;
        const float dy = py[i] - at.y;
        const float dz = pz[i] - at.z;
        const float squared = dx * dx + dy * dy + dz * dz;
        const float share = std::sqrt(squared) * inverse;
        const float whole = shader::neighbour_weight(share);
        const float weight = (i < here) & (squared < squared_reach) ? whole : 0.0f;
        const float wx = weight * dx;
        const float wy = weight * dy;
        const float wz = weight * dz;
        w[i] += weight;
        x[i] += wx;
        y[i] += wy;
        z[i] += wz;
        xx[i] += wx * dx;
        yy[i] += wy * dy;
        zz[i] += wz * dz;
        xy[i] += wx * dy;
        yz[i] += wy * dz;
        zx[i] += wz * dx;
      }
    }
  }
  return {total(w),
          {total(x), total(y), total(z)},
          {total(xx), total(yy), total(zz)},
          {total(xy), total(yz), total(zx)}};
}

bool counts(const Frame& frame, std::size_t i) {
  const glm::vec3& at = frame.particles[i];
  return frame.particle_fluid[i] < frame.fluids.size() && std::isfinite(at.x + at.y + at.z);
}

/// Kept small enough for an integer; what is no number (the greater of a limit and it is the limit) at the
/// lower limit.
glm::vec3 in_cells(const glm::vec3& at, float reach) {
  return glm::floor(glm::min(glm::max(glm::vec3(-1e8f), at / reach), glm::vec3(1e8f)));
}

}  // namespace

glm::ivec3 SmoothCenters::cell_of(const glm::vec3& at) const {
  return glm::clamp(glm::ivec3(in_cells(at, reach_)) - lowest_, glm::ivec3(0), cells_ - 1);
}

std::size_t SmoothCenters::row_of(int y, int z) const {
  return (static_cast<std::size_t>(z) * cells_.y + y) * cells_.x;
}

void SmoothCenters::fit_cells(const Frame& frame, std::size_t count) {
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

void SmoothCenters::sort(const Frame& frame) {
  const std::size_t count = std::min(frame.particles.size(), frame.particle_fluid.size());
  reach_ = reach(frame.particle_radius);
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
  for (auto& column : at_) column.assign(kept + kTileWide, 0.0f);
  // Filled from each cell's end downwards; afterwards begin_[c + 1] is where c begins.
  for (std::size_t i = count; i-- > 0;) {
    if (cell_[i] == kNone) continue;
    const std::uint32_t place = --begin_[cell_[i] + 1];
    for (int axis = 0; axis < 3; ++axis) at_[axis][place] = frame.particles[i][axis];
  }
  std::copy(begin_.begin() + 1, begin_.end(), begin_.begin());
  begin_.back() = static_cast<std::uint32_t>(kept);
  smoothed_.resize(count);
  known_.assign(count, 0);
}

SmoothCenters::Smoothed SmoothCenters::smooth(const glm::vec3& at, float radius) const {
  const glm::ivec3 middle = cell_of(at);
  const glm::ivec3 low = glm::max(middle - 1, glm::ivec3(0));
  const glm::ivec3 high = glm::min(middle + 1, cells_ - 1);
  std::array<Run, 9> runs{};
  std::size_t count = 0;
  for (int z = low.z; z <= high.z; ++z) {
    for (int y = low.y; y <= high.y; ++y) {
      const std::size_t row = row_of(y, z);
      runs[count++] = {begin_[row + low.x], begin_[row + high.x + 1]};
    }
  }
  const shader::Neighbourhood around = neighbourhood_of(at_, {runs.data(), count}, at, reach_);
  return {at + shader::smoothing_step(around, reach_), shader::smoothing_ellipsoid(around, reach_, radius)};
}

void SmoothCenters::move(const Frame& frame, Splats& splats) {
  splats.shapes.resize(splats.spheres.size());
  const glm::mat3 turn(frame.view.view);
  for (std::size_t i = 0; i < splats.spheres.size(); ++i) {
    const std::uint32_t particle = splats.particles[i];
    Smoothed& smoothed = smoothed_[particle];
    if (!known_[particle]) {
      smoothed = smooth(frame.particles[particle], frame.particle_radius);
      known_[particle] = 1;
    }
    glm::vec4& sphere = splats.spheres[i];
    sphere = glm::vec4(glm::vec3(frame.view.view * glm::vec4(smoothed.center, 1.0f)), sphere.w);
    splats.shapes[i] = shape_of(turn * smoothed.ellipsoid * glm::transpose(turn), glm::vec3(sphere));
  }
}

}  // namespace slosh
