// Reading a signed distance field sampled on a regular grid.
#pragma once

#include <glm/glm.hpp>

#include "sim/math/host_device.h"

namespace slosh {

/// A read-only view of a regular grid of signed distances (m, negative inside the solid), in the mesh's
/// frame. Node (i, j, k) sits at origin + cell·(i, j, k) and at index i + size.x·(j + size.y·k).
struct DistanceFieldView {
  glm::vec3 origin{0.0f};
  float cell = 0.0f;   ///< spacing of the nodes, m, > 0
  glm::ivec3 size{0};  ///< nodes along each axis, each >= 2
  const float* distance = nullptr;
};

/// Calls f(d, p, n) for each node in the order in which they lie: its distance, m, its place and its index.
template <class F>
void for_each_node(const DistanceFieldView& field, F&& f) {
  int n = 0;
  for (int z = 0; z < field.size.z; ++z) {
    for (int y = 0; y < field.size.y; ++y) {
      for (int x = 0; x < field.size.x; ++x, ++n)
        f(field.distance[n], field.origin + field.cell * glm::vec3(x, y, z), n);
    }
  }
}

struct DistanceSample {
  float distance = 0.0f;     ///< m, negative inside
  glm::vec3 gradient{0.0f};  ///< not normalised; points away from the solid
};

/// Trilinear distance and its gradient. A point beyond the grid gets the distance at the nearest grid point
/// plus the way to it, so the result is safe everywhere.
SLOSH_HD inline DistanceSample sample_distance(const DistanceFieldView& field, const glm::vec3& point) {
  const glm::vec3 extent = glm::vec3(field.size - 1);
  const glm::vec3 raw = (point - field.origin) / field.cell;
  const glm::vec3 grid = glm::clamp(raw, glm::vec3(0.0f), extent);
  const glm::ivec3 base = glm::min(glm::ivec3(grid), field.size - 2);
  const glm::vec3 f = grid - glm::vec3(base);
  const int row = field.size.x;
  const int slab = field.size.x * field.size.y;
  const float* d = field.distance + base.x + base.y * row + base.z * slab;
  const float x00 = d[0] + f.x * (d[1] - d[0]);
  const float x10 = d[row] + f.x * (d[row + 1] - d[row]);
  const float x01 = d[slab] + f.x * (d[slab + 1] - d[slab]);
  const float x11 = d[slab + row] + f.x * (d[slab + row + 1] - d[slab + row]);
  const float y0 = x00 + f.y * (x10 - x00);
  const float y1 = x01 + f.y * (x11 - x01);
  const auto along_x = [&](int offset) { return d[offset + 1] - d[offset]; };
  const float gx0 = along_x(0) + f.y * (along_x(row) - along_x(0));
  const float gx1 = along_x(slab) + f.y * (along_x(slab + row) - along_x(slab));
  DistanceSample sample;
  sample.distance = y0 + f.z * (y1 - y0);
  sample.gradient =
      glm::vec3(gx0 + f.z * (gx1 - gx0), (x10 - x00) + f.z * ((x11 - x01) - (x10 - x00)), y1 - y0) /
      field.cell;
  const glm::vec3 outside = (raw - grid) * field.cell;
  const float away = glm::length(outside);
  if (away > 0.0f) {
    sample.distance += away;
    sample.gradient = outside / away;
  }
  return sample;
}

}  // namespace slosh
