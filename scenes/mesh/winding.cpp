#include "scenes/mesh/winding.h"

#include <algorithm>
#include <cmath>

namespace slosh::mesh {
namespace {

/// Twice the signed area of (a, b, p) in the y–z plane. The end points are put in a fixed order first, so
/// that the two triangles of an edge get results of equal size and opposite sign.
double edge_side(const glm::dvec3& a, const glm::dvec3& b, double y, double z) {
  const bool swap = a.y != b.y ? a.y > b.y : a.z > b.z;
  const glm::dvec3& from = swap ? b : a;
  const glm::dvec3& to = swap ? a : b;
  const double side = (to.y - from.y) * (z - from.z) - (to.z - from.z) * (y - from.y);
  return swap ? -side : side;
}

}  // namespace

std::vector<Crossing> line_crossings(const TriangleMesh& mesh, const Grid& grid) {
  // Lines are moved a little off the nodes, in an odd direction: nodes love to lie exactly on edges.
  const double shift_y = grid.cell * 1.3717e-5;
  const double shift_z = grid.cell * 2.1931e-5;
  std::vector<Crossing> crossings;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]);
    const glm::dvec3 b(mesh.positions[t.y]);
    const glm::dvec3 c(mesh.positions[t.z]);
    const glm::dvec3 low = (glm::min(a, glm::min(b, c)) - grid.origin) / grid.cell;
    const glm::dvec3 high = (glm::max(a, glm::max(b, c)) - grid.origin) / grid.cell;
    const int j0 = static_cast<int>(std::max(0.0, std::floor(low.y) - 1.0));
    const int j1 = static_cast<int>(std::min(grid.size.y - 1.0, std::ceil(high.y) + 1.0));
    const int k0 = static_cast<int>(std::max(0.0, std::floor(low.z) - 1.0));
    const int k1 = static_cast<int>(std::min(grid.size.z - 1.0, std::ceil(high.z) + 1.0));
    for (int k = k0; k <= k1; ++k) {
      const double z = grid.origin.z + grid.cell * k + shift_z;
      for (int j = j0; j <= j1; ++j) {
        const double y = grid.origin.y + grid.cell * j + shift_y;
        const double wa = edge_side(b, c, y, z);
        const double wb = edge_side(c, a, y, z);
        const double wc = edge_side(a, b, y, z);
        const bool front = wa > 0.0 && wb > 0.0 && wc > 0.0;
        const bool back = wa < 0.0 && wb < 0.0 && wc < 0.0;
        if (!front && !back) continue;
        const double x = (wa * a.x + wb * b.x + wc * c.x) / (wa + wb + wc);
        crossings.push_back({j + grid.size.y * k, static_cast<float>((x - grid.origin.x) / grid.cell),
                             static_cast<std::int8_t>(front ? -1 : 1)});
      }
    }
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& p, const Crossing& q) {
    if (p.row != q.row) return p.row < q.row;
    if (p.x != q.x) return p.x < q.x;
    return p.sign > q.sign;
  });
  return crossings;
}

std::vector<std::int8_t> winding_numbers(const TriangleMesh& mesh, const Grid& grid) {
  const std::vector<Crossing> crossings = line_crossings(mesh, grid);
  std::vector<std::int8_t> winding(grid.count(), 0);
  for (std::size_t begin = 0; begin < crossings.size();) {
    std::size_t end = begin;
    while (end < crossings.size() && crossings[end].row == crossings[begin].row) ++end;
    std::int8_t* row = winding.data() + static_cast<std::size_t>(crossings[begin].row) * grid.size.x;
    int number = 0;
    std::size_t next = begin;
    for (int i = 0; i < grid.size.x; ++i) {
      while (next < end && crossings[next].x <= static_cast<float>(i)) number += crossings[next++].sign;
      row[i] = static_cast<std::int8_t>(std::clamp(number, -100, 100));
    }
    begin = end;
  }
  return winding;
}

}  // namespace slosh::mesh
