#include "scenes/sampling/fill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "scenes/gltf/extras.h"
#include "scenes/mesh/tree.h"
#include "scenes/mesh/united.h"
#include "scenes/mesh/winding.h"
#include "scenes/sampling/place.h"
#include "sim/math/point_grid.h"

namespace slosh::sampling {
namespace {

constexpr double kMaxOverlap = 0.05;
constexpr double kMaxPoints = 3e7;
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

/// Which way of a mesh's axes goes up, as nearly as one does.
struct Up {
  int axis = 1;
  bool along = true;  ///< false: against the axis

  int height(const glm::ivec3& node) const { return along ? node[axis] : -node[axis]; }
  glm::ivec3 raised(glm::ivec3 node, int to_height) const {
    node[axis] = along ? to_height : -to_height;
    return node;
  }
};

Up up_of(const glm::dvec3& gravity, const Pose& pose) {
  Up up;
  const double g = glm::length(gravity);
  if (!(g > 0.0)) return up;
  const glm::dvec3 local = glm::conjugate(pose.orientation) * (-gravity / g);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(local[axis]) > std::abs(local[up.axis]) + 1e-9) up.axis = axis;
  }
  up.along = local[up.axis] > 0.0;
  return up;
}

mesh::Grid lattice(const TriangleMesh& mesh, double spacing, const Up& up) {
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
    // Centred sideways; what is left over lies at the top.
    const double below = axis != up.axis ? 0.5 : up.along ? 0.0 : 1.0;
    const double slack = std::max(0.0, extent - count * spacing);
    grid.origin[axis] = low[axis] + below * slack + 0.5 * std::min(spacing, extent);
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
  Up up;
  std::vector<glm::ivec3> nodes;     ///< kept
  std::vector<glm::vec3> positions;  ///< of the kept ones, world
  std::size_t inside = 0;            ///< points inside the mesh

  glm::dvec3 local(const glm::ivec3& node) const { return grid.origin + grid.cell * glm::dvec3(node); }
  glm::dvec3 at(const glm::ivec3& node) const { return transform_point(pose, local(node)); }
  void add(const glm::ivec3& node) {
    nodes.push_back(node);
    positions.emplace_back(at(node));
  }
};

double closed_volume(const TriangleMesh& mesh) {
  const mesh::WeldedMesh welded = mesh::weld(mesh);
  mesh::Components parts;
  mesh::find_defects(welded, &parts);
  return mesh::integrate_union(welded, parts).solid.volume;
}

/// How much of the cells inside a mesh is inside bodies, in cells. Points of the lattice alone would say it
/// to a plane of them: a partition of a cell and a half would count as one cell or two.
double buried_cells(const Filling& filling, const mesh::MeshTree& volume, std::vector<Obstacle>& obstacles,
                    const std::vector<std::int8_t>& winding) {
  constexpr int kParts = 4;
  const double cell = filling.grid.cell;
  const auto inside_a_body = [&](const glm::dvec3& point) {
    return std::any_of(obstacles.begin(), obstacles.end(), [&](const Obstacle& o) {
      if (glm::any(glm::lessThan(point, o.low)) || glm::any(glm::greaterThan(point, o.high))) return false;
      return distance_to(o, glm::vec3(transform_point(o.to_body, point)), 0.0) < 0.0;
    });
  };
  const auto near_a_body = [&](const glm::dvec3& point) {
    return std::any_of(obstacles.begin(), obstacles.end(), [&](const Obstacle& o) {
      if (glm::any(glm::lessThan(point, o.low - cell)) || glm::any(glm::greaterThan(point, o.high + cell)))
        return false;
      return sample_distance(o.field, glm::vec3(transform_point(o.to_body, point))).distance < cell;
    });
  };
  std::size_t buried = 0;
  std::size_t index = 0;
  for (int k = 0; k < filling.grid.size.z; ++k) {
    for (int j = 0; j < filling.grid.size.y; ++j) {
      for (int i = 0; i < filling.grid.size.x; ++i, ++index) {
        const glm::ivec3 node(i, j, k);
        if (winding[index] <= 0 || !near_a_body(filling.at(node))) continue;
        for (int part = 0; part < kParts * kParts * kParts; ++part) {
          const glm::ivec3 step(part % kParts, part / kParts % kParts, part / (kParts * kParts));
          const glm::dvec3 local =
              filling.local(node) + cell * ((glm::dvec3(step) + 0.5) / double{kParts} - 0.5);
          buried += inside_a_body(transform_point(filling.pose, local)) && volume.inside(glm::vec3(local));
        }
      }
    }
  }
  return static_cast<double>(buried) / (kParts * kParts * kParts);
}

/// The kept nodes of the highest layer; none where the shape tapers to a tip (a drop, a cone): on that no
/// layer can be put without growing a tower.
std::vector<glm::ivec3> broad_top(const Filling& filling) {
  std::map<int, std::size_t> layers;
  for (const glm::ivec3& node : filling.nodes) ++layers[filling.up.height(node)];
  std::size_t widest = 0;
  for (const auto& [height, size] : layers) widest = std::max(widest, size);
  std::vector<glm::ivec3> top;
  if (layers.empty() || 4 * layers.rbegin()->second < widest) return top;
  for (const glm::ivec3& node : filling.nodes) {
    if (filling.up.height(node) == layers.rbegin()->first) top.push_back(node);
  }
  return top;
}

/// A wall keeps the lattice off itself by half a spacing, though the fluid will lie against it, and a lattice
/// has whole layers only: what is missing goes on top, in layers over the highest, and finds its level when
/// the world moves. Without this a round vessel of ten spacings would start a sixth too light. Returns what
/// found no place.
template <class Free>
std::size_t pile_up(Filling& filling, std::size_t missing, Free&& is_free) {
  const std::vector<glm::ivec3> columns = broad_top(filling);
  if (columns.empty()) return missing;
  for (int height = filling.up.height(columns.front()) + 1; missing > 0; ++height) {
    std::vector<glm::ivec3> layer;
    for (const glm::ivec3& column : columns) {
      const glm::ivec3 node = filling.up.raised(column, height);
      if (is_free(filling.at(node))) layer.push_back(node);
    }
    if (layer.empty()) break;
    // A last layer that is not full is spread over the whole of it.
    const std::size_t count = std::min(missing, layer.size());
    for (std::size_t i = 0; i < count; ++i) filling.add(layer[i * layer.size() / count]);
    missing -= count;
  }
  return missing;
}

/// The nodes in the order of their distance to the mesh.
std::vector<glm::ivec3> by_distance(const Filling& filling, const mesh::MeshTree& volume,
                                    const std::vector<glm::ivec3>& nodes) {
  std::vector<std::pair<float, std::size_t>> order;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    order.emplace_back(volume.nearest(glm::vec3(filling.local(nodes[i]))).distance, i);
  std::sort(order.begin(), order.end());
  std::vector<glm::ivec3> sorted;
  for (const auto& [distance, i] : order) sorted.push_back(nodes[i]);
  return sorted;
}

using NodeSet = std::set<std::array<int, 3>>;

NodeSet set_of(const std::vector<glm::ivec3>& nodes) {
  NodeSet set;
  for (const glm::ivec3& node : nodes) set.insert({node.x, node.y, node.z});
  return set;
}

/// Lays what is missing on a shape that tapers, like a skin, where the mesh is nearest. Returns what found no
/// place.
template <class Free>
std::size_t grow(Filling& filling, const mesh::MeshTree& volume, std::size_t missing, Free&& is_free) {
  NodeSet known = set_of(filling.nodes);
  std::vector<glm::ivec3> skin;
  for (const glm::ivec3& node : filling.nodes) {
    for (int side = 0; side < 6; ++side) {
      glm::ivec3 next = node;
      next[side / 2] += side % 2 == 0 ? 1 : -1;
      if (known.insert({next.x, next.y, next.z}).second && is_free(filling.at(next))) skin.push_back(next);
    }
  }
  for (const glm::ivec3& node : by_distance(filling, volume, skin)) {
    if (missing == 0) break;
    filling.add(node);
    --missing;
  }
  return missing;
}

/// Takes what is too much from the top layer, or from all over a shape that tapers.
void trim(Filling& filling, const mesh::MeshTree& volume, std::size_t excess) {
  const std::vector<glm::ivec3> top = broad_top(filling);
  NodeSet gone;
  if (top.size() > excess) {
    for (std::size_t i = 0; i < excess; ++i) gone.merge(set_of({top[i * top.size() / excess]}));
  } else {
    std::vector<glm::ivec3> outermost = by_distance(filling, volume, filling.nodes);
    outermost.resize(std::min(excess, outermost.size() - 1));
    gone = set_of(outermost);
  }
  const std::vector<glm::ivec3> all = std::move(filling.nodes);
  filling.nodes.clear();
  filling.positions.clear();
  for (const glm::ivec3& node : all) {
    if (!gone.count({node.x, node.y, node.z})) filling.add(node);
  }
}

/// Why a volume holds not one particle. `in_others`: m³ that earlier fluids have.
Error no_particle(const std::string& where, const TriangleMesh& mesh, double volume, double in_others,
                  double spacing) {
  using gltf::short_number;
  const std::string what = "holds no particle at a spacing of " + short_number(1000.0 * spacing) + " mm: ";
  if (in_others > 0.5 * volume)
    return {where, what + "another fluid is where it would be",
            "Move one of the two fluids' meshes out of the other"};
  // Of a flat box twice its volume over its surface is its thickness.
  const double thick = 2.0 * volume / std::max(mesh::surface_area(mesh), 1e-12);
  if (thick < spacing)
    return {where,
            what + "it is about " + short_number(1000.0 * thick) + " mm thick, thinner than a particle",
            "Make the fluid's mesh thicker, or the scene's spacing_max_m smaller (here --spacing " +
                short_number(0.25 * thick) + ")"};
  return {where, what + "bodies leave no room for it",
          "Make the fluid's mesh larger, or the scene's spacing_max_m smaller"};
}

/// Adds the particles of one volume. Where volumes that are there at the start overlap, the first one wins.
std::optional<Error> fill_volume(const Scene& scene, std::size_t index_of_volume,
                                 std::vector<Obstacle>& obstacles, SampledScene& sampled,
                                 FilledVolume& filled) {
  using gltf::short_number;
  const FluidVolume& volume = scene.fluid_volumes[index_of_volume];
  const double spacing = sampled.spacing;
  const double clear = kClear * spacing;
  const std::string where = place_of(scene, "node '" + volume.name + "'");
  const TriangleMesh& mesh = scene.meshes[volume.mesh];
  const Up up = up_of(scene.gravity, volume.pose);
  const mesh::Grid grid = lattice(mesh, spacing, up);
  if (static_cast<double>(grid.size.x) * grid.size.y * grid.size.z > kMaxPoints) {
    return Error{where,
                 "would take more than 30 million lattice points at a spacing of " +
                     short_number(1000.0 * spacing) + " mm",
                 "Choose a larger spacing (the scene's spacing_min_m)"};
  }
  const std::vector<std::int8_t> winding = mesh::winding_numbers(mesh, grid);
  const PointGrid earlier(volume.starts_away ? std::vector<glm::vec3>() : sampled.fluid_positions,
                          static_cast<float>(0.9 * spacing));
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
  Filling filling{grid, volume.pose, up, {}, {}, 0};
  std::size_t index = 0;
  for (int k = 0; k < grid.size.z; ++k) {
    for (int j = 0; j < grid.size.y; ++j) {
      for (int i = 0; i < grid.size.x; ++i, ++index) {
        if (winding[index] <= 0) continue;
        ++filling.inside;
        const glm::ivec3 node(i, j, k);
        const glm::dvec3 point = filling.at(node);
        if (is_free(point)) filling.add(node);
      }
    }
  }
  std::size_t overlapping = 0;
  for (const Obstacle& o : obstacles) {
    overlapping += o.overlaps;
    if (static_cast<double>(o.overlaps) <= kMaxOverlap * static_cast<double>(filling.inside)) continue;
    return Error{
        where,
        "overlaps the body '" + scene.bodies[o.body].name + "': " +
            short_number(100.0 * static_cast<double>(o.overlaps) / static_cast<double>(filling.inside)) +
            " % of the fluid starts inside it",
        "Make the fluid's mesh smaller, so that it ends at the wall's surface"};
  }
  const double cell = spacing * spacing * spacing;
  const mesh::MeshTree tree(mesh);
  filled.mesh = closed_volume(mesh);
  filled.in_bodies = overlapping > 0 ? cell * buried_cells(filling, tree, obstacles, winding) : 0.0;
  filled.in_others = cell * static_cast<double>(shared);
  // What the mesh holds, whatever the lattice made of it.
  const double wanted = std::max(0.0, (filled.mesh - filled.in_bodies - filled.in_others) / cell);
  const auto count = static_cast<std::size_t>(std::llround(wanted));
  if (!filling.nodes.empty() && filling.nodes.size() < count) {
    const std::size_t left = pile_up(filling, count - filling.nodes.size(), is_free);
    filled.no_place = cell * static_cast<double>(grow(filling, tree, left, is_free));
  } else if (filling.nodes.size() > count) {
    trim(filling, tree, filling.nodes.size() - count);
  }
  filled.sampled = cell * static_cast<double>(filling.nodes.size());
  const std::vector<glm::vec3>& kept = filling.positions;
  sampled.fillings[index_of_volume] = {static_cast<std::uint32_t>(sampled.fluid_positions.size()),
                                       static_cast<std::uint32_t>(kept.size()), 0, 0};
  if (kept.empty()) return no_particle(where, mesh, filled.mesh, filled.in_others, spacing);
  sampled.fluid_positions.insert(sampled.fluid_positions.end(), kept.begin(), kept.end());
  sampled.fluid_velocities.resize(sampled.fluid_positions.size(), glm::vec3(volume.velocity));
  sampled.fluid_index.resize(sampled.fluid_positions.size(), static_cast<std::uint8_t>(volume.fluid));
  return std::nullopt;
}

/// What later fillings have room for lies where the first one does, and is not there yet.
void add_spares(const Scene& scene, SampledScene& sampled) {
  for (std::size_t v = 0; v < scene.fluid_volumes.size(); ++v) {
    FillingIds& ids = sampled.fillings[v];
    ids.spare_first = static_cast<std::uint32_t>(sampled.fluid_positions.size());
    ids.spare_count = ids.count * static_cast<std::uint32_t>(scene.fluid_volumes[v].fillings - 1);
    for (std::uint32_t i = 0; i < ids.spare_count; ++i)
      sampled.fluid_positions.push_back(sampled.fluid_positions[ids.first + i % ids.count]);
    sampled.fluid_velocities.resize(sampled.fluid_positions.size(), glm::vec3(0.0f));
    sampled.fluid_index.resize(sampled.fluid_positions.size(),
                               static_cast<std::uint8_t>(scene.fluid_volumes[v].fluid));
  }
}

}  // namespace

std::optional<Error> fill_fluids(const Scene& scene, SampledScene& sampled, SampleReport* report) {
  const double clear = kClear * sampled.spacing;
  std::vector<Obstacle> all = find_obstacles(scene, sampled, clear), there;
  for (const Obstacle& o : all)
    if (!scene.bodies[o.body].starts_away) there.push_back(o);
  sampled.fillings.resize(scene.fluid_volumes.size());
  std::vector<FilledVolume> filled(scene.fluid_volumes.size());
  // Those that come later last, so that nothing gives way to them.
  for (const bool later : {false, true}) {
    for (std::size_t v = 0; v < scene.fluid_volumes.size(); ++v) {
      if (scene.fluid_volumes[v].starts_away != later) continue;
      if (auto problem = fill_volume(scene, v, later ? all : there, sampled, filled[v])) return problem;
    }
  }
  double room = 0.0;
  for (std::size_t v = 0; v < filled.size(); ++v) {
    room += double{1.0} * sampled.fillings[v].count * scene.fluid_volumes[v].fillings;
    if (room > kMaxPoints)
      return Error{place_of(scene, "node '" + scene.fluid_volumes[v].name + "'"),
                   "has room for " + std::to_string(scene.fluid_volumes[v].fillings) +
                       " fillings: more than 30 million particles with the others",
                   "Lower its fillings, or choose a larger spacing"};
  }
  add_spares(scene, sampled);
  if (report) report->volumes = std::move(filled);
  return std::nullopt;
}

}  // namespace slosh::sampling
