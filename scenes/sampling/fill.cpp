#include "scenes/sampling/fill.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "scenes/gltf/extras.h"
#include "scenes/mesh/closed.h"
#include "scenes/mesh/tree.h"
#include "scenes/mesh/winding.h"
#include "scenes/sampling/point_grid.h"

namespace slosh::sampling {
namespace {

constexpr double kMostOverlap = 0.05;
constexpr double kMostPoints = 3e7;
// Lattice planes lie exactly half a spacing off a wall that the volume touches: a hair of slack for rounding.
constexpr double kClear = 0.5 * 0.999;
// How far a trilinear distance may be off, in cells: most beside a concave edge.
constexpr double kFieldError = 0.75;

/// A body as an obstacle for a fluid.
struct Obstacle {
  DistanceFieldView field;
  std::shared_ptr<const mesh::MeshTree> tree;  ///< shared by bodies of one mesh
  Pose to_body;                                ///< world to mesh frame
  glm::dvec3 low;                              ///< world bounds, `clear` around it
  glm::dvec3 high;
  std::size_t body;
  std::size_t overlaps = 0;  ///< lattice points inside it
};

std::vector<Obstacle> find_obstacles(const Scene& scene, const SampledScene& sampled, double clear) {
  std::vector<Obstacle> out;
  std::map<int, std::shared_ptr<const mesh::MeshTree>> trees;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (body.point_probe || sampled.distance_fields[b].size.x == 0) continue;
    std::shared_ptr<const mesh::MeshTree>& tree = trees[body.mesh];
    if (!tree) tree = std::make_shared<const mesh::MeshTree>(scene.meshes[body.mesh]);
    Obstacle o{sampled.distance_fields[b].view(),
               tree,
               inverse(body.pose),
               glm::dvec3(INFINITY),
               glm::dvec3(-INFINITY),
               b,
               0};
    for (const glm::vec3& p : scene.meshes[body.mesh].positions) {
      const glm::dvec3 w = transform_point(body.pose, glm::dvec3(p));
      o.low = glm::min(o.low, w - clear);
      o.high = glm::max(o.high, w + clear);
    }
    out.push_back(o);
  }
  return out;
}

mesh::Grid lattice(const TriangleMesh& mesh, double spacing) {
  glm::dvec3 low(INFINITY);
  glm::dvec3 high(-INFINITY);
  for (const glm::vec3& p : mesh.positions) {
    low = glm::min(low, glm::dvec3(p));
    high = glm::max(high, glm::dvec3(p));
  }
  mesh::Grid grid;
  grid.cell = spacing;
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = high[axis] - low[axis];
    const double count = std::min(std::max(1.0, std::floor(extent / spacing + 1e-3)), 1e6);
    grid.size[axis] = static_cast<int>(count);
    const double slack = axis == 1 ? 0.0 : std::max(0.0, extent - count * spacing);
    grid.origin[axis] = low[axis] + 0.5 * slack + 0.5 * std::min(spacing, extent);
  }
  return grid;
}

/// The signed distance to a body: by the field where that is clear enough, else exact.
double distance_to(const Obstacle& o, const glm::vec3& local, double clear) {
  const double distance = sample_distance(o.field, local).distance;
  const double error = kFieldError * o.field.cell;
  if (distance > clear + error || distance < -error) return distance;
  const double exact = o.tree->nearest(local).distance;
  const bool inside = distance < error ? o.tree->inside(local) : false;
  return inside ? -exact : exact;
}

bool clear_of(std::vector<Obstacle>& obstacles, const glm::dvec3& point, double clear) {
  bool is_clear = true;
  for (Obstacle& o : obstacles) {
    if (glm::any(glm::lessThan(point, o.low)) || glm::any(glm::greaterThan(point, o.high))) continue;
    const double distance = distance_to(o, glm::vec3(transform_point(o.to_body, point)), clear);
    if (distance < 0.0) ++o.overlaps;
    if (distance < clear) is_clear = false;
  }
  return is_clear;
}

/// Lattice points of one volume.
struct Filling {
  mesh::Grid grid;
  Pose pose;
  std::vector<glm::ivec3> nodes;     ///< kept
  std::vector<glm::vec3> positions;  ///< of the kept ones, world
  std::size_t inside = 0;            ///< points inside the mesh
  std::size_t given_up = 0;  ///< of these, to an earlier fluid or inside a body: not to be made up for

  glm::dvec3 at(const glm::ivec3& node) const {
    return transform_point(pose, grid.origin + grid.cell * glm::dvec3(node));
  }
};

double closed_volume(const TriangleMesh& mesh) {
  const mesh::WeldedMesh welded = mesh::weld(mesh);
  mesh::Components parts;
  mesh::find_defects(welded, &parts);
  return mesh::integrate_volume(welded, parts).volume;
}

/// A wall keeps the lattice off itself by half a spacing, though the fluid will lie against it, and a lattice
/// has whole layers only: what is missing goes on top, in layers over the highest, and finds its level when
/// the world settles. Without this a round vessel of ten spacings would start a sixth too light.
template <class Free>
void top_up(Filling& filling, double wanted, Free&& is_free) {
  const double have = static_cast<double>(filling.positions.size() + filling.given_up);
  if (filling.nodes.empty() || wanted - have < 0.01 * wanted) return;
  auto missing = static_cast<std::size_t>(wanted - have);
  std::vector<std::size_t> layer_sizes(static_cast<std::size_t>(filling.grid.size.y), 0);
  int top = 0;
  for (const glm::ivec3& node : filling.nodes) {
    top = std::max(top, node.y);
    ++layer_sizes[static_cast<std::size_t>(node.y)];
  }
  // A shape that tapers to a tip (a drop, a cone) would grow a tower; it keeps its shape instead.
  const std::size_t widest = *std::max_element(layer_sizes.begin(), layer_sizes.end());
  if (4 * layer_sizes[static_cast<std::size_t>(top)] < widest) return;
  std::vector<glm::ivec3> columns;
  for (const glm::ivec3& node : filling.nodes) {
    if (node.y == top) columns.push_back(node);
  }
  while (missing > 0) {
    ++top;
    std::vector<glm::ivec3> layer;
    for (glm::ivec3 node : columns) {
      node.y = top;
      if (is_free(filling.at(node))) layer.push_back(node);
    }
    if (layer.empty()) return;
    // A last layer that is not full is spread over the whole of it.
    const std::size_t count = std::min(missing, layer.size());
    for (std::size_t i = 0; i < count; ++i) {
      filling.positions.emplace_back(filling.at(layer[i * layer.size() / count]));
    }
    missing -= count;
  }
}

}  // namespace

std::optional<Error> fill_fluids(const Scene& scene, SampledScene& sampled) {
  using gltf::short_number;
  const double spacing = sampled.spacing;
  const double clear = kClear * spacing;
  std::vector<Obstacle> obstacles = find_obstacles(scene, sampled, clear);
  for (const FluidVolume& volume : scene.fluid_volumes) {
    const std::string where = scene.source_file + ": node '" + volume.name + "'";
    const TriangleMesh& mesh = scene.meshes[volume.mesh];
    const mesh::Grid grid = lattice(mesh, spacing);
    if (static_cast<double>(grid.size.x) * grid.size.y * grid.size.z > kMostPoints) {
      return Error{where,
                   "would take more than 30 million lattice points at a spacing of " +
                       short_number(1000.0 * spacing) + " mm",
                   "Choose a larger spacing (the scene's spacing_min_m)"};
    }
    const std::vector<std::int8_t> winding = mesh::winding_numbers(mesh, grid);
    const PointGrid earlier(sampled.fluid_positions, static_cast<float>(0.9 * spacing));
    for (Obstacle& o : obstacles) o.overlaps = 0;
    std::size_t shared = 0;  // with an earlier fluid, to which this one gives way
    const auto is_free = [&](const glm::dvec3& point) {
      if (!clear_of(obstacles, point, clear)) return false;
      bool taken = false;
      earlier.each_near(glm::vec3(point), [&](std::uint32_t other) {
        taken = taken || glm::distance(sampled.fluid_positions[other], glm::vec3(point)) < 0.9 * spacing;
      });
      shared += taken;
      return !taken;
    };
    Filling filling{grid, volume.pose, {}, {}, 0, 0};
    std::size_t index = 0;
    for (int k = 0; k < grid.size.z; ++k) {
      for (int j = 0; j < grid.size.y; ++j) {
        for (int i = 0; i < grid.size.x; ++i, ++index) {
          if (winding[index] <= 0) continue;
          ++filling.inside;
          const glm::ivec3 node(i, j, k);
          const glm::dvec3 point = filling.at(node);
          if (is_free(point)) {
            filling.nodes.push_back(node);
            filling.positions.emplace_back(point);
          }
        }
      }
    }
    std::size_t overlapping = 0;
    for (const Obstacle& o : obstacles) {
      overlapping += o.overlaps;
      if (static_cast<double>(o.overlaps) <= kMostOverlap * static_cast<double>(filling.inside)) continue;
      return Error{
          where,
          "overlaps the body '" + scene.bodies[o.body].name + "': " +
              short_number(100.0 * static_cast<double>(o.overlaps) / static_cast<double>(filling.inside)) +
              " % of the fluid starts inside it",
          "Make the fluid's mesh smaller, so that it ends at the wall's surface"};
    }
    filling.given_up = overlapping + shared;
    top_up(filling, closed_volume(mesh) / (spacing * spacing * spacing), is_free);
    const std::vector<glm::vec3>& kept = filling.positions;
    if (kept.empty()) {
      return Error{where, "holds no particle at a spacing of " + short_number(1000.0 * spacing) + " mm",
                   "Make the fluid's mesh larger, or the scene's spacing_max_m smaller"};
    }
    sampled.fluid_positions.insert(sampled.fluid_positions.end(), kept.begin(), kept.end());
    sampled.fluid_velocities.resize(sampled.fluid_positions.size(), glm::vec3(volume.velocity));
    sampled.fluid_index.resize(sampled.fluid_positions.size(), static_cast<std::uint8_t>(volume.fluid));
  }
  return std::nullopt;
}

}  // namespace slosh::sampling
