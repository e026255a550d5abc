#include "scenes/sampling/distance.h"

#include <algorithm>
#include <cmath>

#include "scenes/mesh/winding.h"

namespace slosh::sampling {

DistanceField make_distance_field(const TriangleMesh& mesh, const mesh::MeshTree& tree, double spacing) {
  const glm::dvec3 extent = glm::dvec3(tree.high()) - glm::dvec3(tree.low());
  const double longest = std::max({extent.x, extent.y, extent.z});
  // The margin counts in nodes too: longest + 2 · 3 spacings must fit kMaxNodes − 1 cells, with one to
  // spare.
  const double pad = 3.0 * spacing;
  const double cell = std::max(0.5 * spacing, (longest + 2.0 * pad) / (kMaxNodes - 2));
  DistanceField field;
  field.cell = static_cast<float>(cell);
  field.size = glm::ivec3(glm::ceil((extent + 2.0 * pad) / cell)) + 1;
  // Centred: a body that is symmetric gets a field that is.
  const glm::dvec3 center = 0.5 * (glm::dvec3(tree.low()) + glm::dvec3(tree.high()));
  field.origin = glm::vec3(center - 0.5 * static_cast<double>(field.cell) * glm::dvec3(field.size - 1));
  const mesh::Grid grid{glm::dvec3(field.origin), static_cast<double>(field.cell), field.size};
  const std::vector<std::int8_t> winding = mesh::winding_numbers(mesh, grid);
  field.distance.resize(grid.count());
  int hint = -1;
  for_each_node(field.view(), [&](float, const glm::vec3& point, int n) {
    const auto index = static_cast<std::size_t>(n);
    const mesh::NearestPoint near = tree.nearest(point, INFINITY, hint);
    hint = near.triangle;
    field.distance[index] = winding[index] > 0 ? -near.distance : near.distance;
  });
  return field;
}

}  // namespace slosh::sampling
