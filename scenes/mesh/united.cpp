#include "scenes/mesh/united.h"

#include <algorithm>
#include <vector>

#include "scenes/mesh/winding.h"

namespace slosh::mesh {
namespace {

constexpr int kLines = 256;  // along the two axes across

struct Box {
  glm::dvec3 low{INFINITY};
  glm::dvec3 high{-INFINITY};
};

bool some_boxes_meet(const WeldedMesh& mesh, const Components& components) {
  std::vector<Box> boxes(static_cast<std::size_t>(components.count));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Box& box = boxes[static_cast<std::size_t>(components.of_triangle[t])];
    for (int i = 0; i < 3; ++i) {
      box.low = glm::min(box.low, mesh.points[mesh.triangles[t][i]]);
      box.high = glm::max(box.high, mesh.points[mesh.triangles[t][i]]);
    }
  }
  // By their lower ends along x: most parts of most meshes are far from each other.
  std::sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.low.x < b.low.x; });
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size() && boxes[j].low.x < boxes[i].high.x; ++j) {
      if (boxes[j].low.y < boxes[i].high.y && boxes[i].low.y < boxes[j].high.y &&
          boxes[j].low.z < boxes[i].high.z && boxes[i].low.z < boxes[j].high.z)
        return true;
    }
  }
  return false;
}

/// ∫1, ∫x and ∫xxᵀ about a place.
struct Moments {
  double volume = 0.0;
  glm::dvec3 first{0.0};
  glm::dmat3 second{0.0};
};

/// Of a piece of a line along x from `from` to `to`, `area` wide.
void add_piece(Moments& sums, const glm::dvec3& from, double to, double area) {
  const double a = from.x, b = to;
  const double length = area * (b - a);
  const double x1 = area * (b * b - a * a) / 2.0;
  const double x2 = area * (b * b * b - a * a * a) / 3.0;
  const double y = from.y, z = from.z;
  sums.volume += length;
  sums.first += glm::dvec3(x1, length * y, length * z);
  sums.second += glm::dmat3(x2, x1 * y, x1 * z, x1 * y, length * y * y, length * y * z, x1 * z,
                            length * y * z, length * z * z);
}

/// What the sum over the parts has too much, about `about`.
Moments counted_again(const WeldedMesh& mesh, const glm::dvec3& about) {
  TriangleMesh all;
  all.triangles = mesh.triangles;
  Box box;
  for (const glm::dvec3& p : mesh.points) {
    all.positions.emplace_back(p);
    box.low = glm::min(box.low, p);
    box.high = glm::max(box.high, p);
  }
  const glm::dvec3 size = box.high - box.low;
  Grid grid;
  grid.cell = std::max(std::max(size.y, size.z), 1e-9) / kLines;
  grid.origin = box.low + 0.5 * grid.cell;
  grid.origin.x = box.low.x;
  grid.size = {1, std::max(1, static_cast<int>(size.y / grid.cell)),
               std::max(1, static_cast<int>(size.z / grid.cell))};
  Moments sums;
  int winding = 0;
  const std::vector<Crossing> crossings = line_crossings(all, grid);
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const bool begins = i == 0 || crossings[i - 1].row != crossings[i].row;
    winding = (begins ? 0 : winding) + crossings[i].sign;
    if (winding < 2 || i + 1 == crossings.size() || crossings[i + 1].row != crossings[i].row) continue;
    const glm::dvec3 node(0.0, crossings[i].row % grid.size.y, crossings[i].row / grid.size.y);
    glm::dvec3 from = grid.origin + grid.cell * node - about;
    const double to = from.x + grid.cell * static_cast<double>(crossings[i + 1].x);
    from.x += grid.cell * static_cast<double>(crossings[i].x);
    add_piece(sums, from, to, grid.cell * grid.cell * (winding - 1));
  }
  return sums;
}

}  // namespace

United integrate_union(const WeldedMesh& mesh, const Components& components) {
  United out{integrate_volume(mesh, components), 0.0};
  // Parts that touch may hang together where they also cover each other.
  const bool may_overlap = components.touching || (components.count > 1 && some_boxes_meet(mesh, components));
  if (!may_overlap || !(out.solid.volume > 0.0)) return out;
  VolumeIntegrals& solid = out.solid;
  const Moments again = counted_again(mesh, solid.centroid);
  if (again.volume <= kMinOverlap * solid.volume || again.volume >= solid.volume) return out;
  out.overlap = again.volume;
  // Back from inertia to ∫xxᵀ: I = tr(S) − S, so tr(I) = 2 tr(S).
  const double trace = 0.5 * (solid.inertia[0][0] + solid.inertia[1][1] + solid.inertia[2][2]);
  glm::dmat3 second = glm::dmat3(trace) - solid.inertia - again.second;
  solid.volume -= again.volume;
  const glm::dvec3 shift = -again.first / solid.volume;
  second -= solid.volume * glm::outerProduct(shift, shift);
  solid.centroid += shift;
  solid.inertia = glm::dmat3(second[0][0] + second[1][1] + second[2][2]) - second;
  return out;
}

}  // namespace slosh::mesh
