#include "tests/lab/picture/reference/fluid_mesh.h"

#include <algorithm>
#include <cmath>

namespace slosh::reference {
namespace {

constexpr float kReach = 4.0f;    // particle radii
constexpr float kLevel = 0.984f;  // likewise: half-space weights put the mean 0.246 reaches behind its face
constexpr double kMaxNodes = 50e6;

/// The field on a lattice of nodes.
class Grid {
 public:
  Grid(const std::vector<glm::vec3>& points, float radius, float cell) : radius_(radius) {
    glm::vec3 low = points[0], high = points[0];
    for (const glm::vec3& p : points) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    low -= kReach * radius;
    high += kReach * radius;
    cell_ = cell * radius;
    const glm::dvec3 span(high - low);
    cell_ = std::max(cell_, static_cast<float>(std::cbrt(span.x * span.y * span.z / kMaxNodes)));
    origin_ = low;
    count_ = glm::ivec3(glm::ceil((high - low) / cell_)) + 2;
    const std::size_t nodes = std::size_t(count_.x) * count_.y * count_.z;
    sum_.assign(nodes, glm::vec4(0.0f));
    for (const glm::vec3& p : points) add(p);
  }

  /// Below 0 inside. m
  float at(const glm::ivec3& node) const {
    const glm::vec4& s = sum_[index(node)];
    // Sums are relative to the node: nothing is lost far from the origin.
    return s.w > 1e-9f ? glm::length(glm::vec3(s)) / s.w - kLevel * radius_ : kReach * radius_;
  }
  glm::vec3 place(const glm::ivec3& node) const { return origin_ + glm::vec3(node) * cell_; }
  const glm::ivec3& count() const { return count_; }
  std::size_t index(const glm::ivec3& node) const {
    return (std::size_t(node.z) * count_.y + node.y) * count_.x + node.x;
  }
  float cell() const { return cell_; }

 private:
  void add(const glm::vec3& p) {
    const float reach = kReach * radius_;
    const glm::ivec3 low = glm::max(glm::ivec3(glm::ceil((p - reach - origin_) / cell_)), glm::ivec3(0));
    const glm::ivec3 high = glm::min(glm::ivec3(glm::floor((p + reach - origin_) / cell_)), count_ - 1);
    for (int z = low.z; z <= high.z; ++z) {
      for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
          const glm::vec3 way = p - place({x, y, z});
          const float left = 1.0f - glm::dot(way, way) / (reach * reach);
          if (left <= 0.0f) continue;
          const float weight = left * left * left;
          sum_[index({x, y, z})] += glm::vec4(weight * way, weight);
        }
      }
    }
  }

  float radius_;
  float cell_ = 0.0f;
  glm::vec3 origin_{0.0f};
  glm::ivec3 count_{0};
  std::vector<glm::vec4> sum_;  // weighted ways to the particles; weight
};

/// The mean of where a cell's edges cross the surface; false if none does.
bool crossing(const Grid& grid, const glm::ivec3& cell, glm::vec3& out) {
  float value[8];
  for (int c = 0; c < 8; ++c) value[c] = grid.at(cell + glm::ivec3(c & 1, c >> 1 & 1, c >> 2));
  glm::vec3 sum(0.0f);
  int count = 0;
  for (int a = 0; a < 8; ++a) {
    for (int axis = 0; axis < 3; ++axis) {
      const int b = a | 1 << axis;
      if (b == a || (value[a] < 0.0f) == (value[b] < 0.0f)) continue;
      glm::vec3 at(a & 1, a >> 1 & 1, a >> 2);
      at[axis] += value[a] / (value[a] - value[b]);
      sum += at;
      ++count;
    }
  }
  if (count == 0) return false;
  out = grid.place(cell) + sum / static_cast<float>(count) * grid.cell();
  return true;
}

FluidMesh mesh_of(const std::vector<glm::vec3>& points, float radius, float cell) {
  const Grid grid(points, radius, cell);
  const glm::ivec3 cells = grid.count() - 1;
  FluidMesh mesh;
  std::vector<std::uint32_t> vertex(std::size_t(grid.count().x) * grid.count().y * grid.count().z, ~0u);
  glm::ivec3 at;
  for (at.z = 0; at.z < cells.z; ++at.z) {
    for (at.y = 0; at.y < cells.y; ++at.y) {
      for (at.x = 0; at.x < cells.x; ++at.x) {
        glm::vec3 where;
        if (!crossing(grid, at, where)) continue;
        vertex[grid.index(at)] = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(where);
      }
    }
  }
  // A quad over each lattice edge that crosses the surface, between the four cells round it.
  for (at.z = 1; at.z < cells.z; ++at.z) {
    for (at.y = 1; at.y < cells.y; ++at.y) {
      for (at.x = 1; at.x < cells.x; ++at.x) {
        const bool inside = grid.at(at) < 0.0f;
        for (int axis = 0; axis < 3; ++axis) {
          glm::ivec3 step(0), u(0), v(0);
          step[axis] = 1;
          if ((grid.at(at + step) < 0.0f) == inside) continue;
          u[(axis + 1) % 3] = 1;
          v[(axis + 2) % 3] = 1;
          const std::uint32_t a = vertex[grid.index(at - u - v)], b = vertex[grid.index(at - v)],
                              c = vertex[grid.index(at)], d = vertex[grid.index(at - u)];
          if (std::max({a, b, c, d}) == ~0u) continue;
          if (inside) {
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
          } else {
            mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {a, d, c}});
          }
        }
      }
    }
  }
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0f));
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 area =
        glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
    for (int k = 0; k < 3; ++k) mesh.normals[t[k]] += area;
  }
  for (glm::vec3& n : mesh.normals) {
    const float length = glm::length(n);
    n = length > 0.0f ? n / length : glm::vec3(0.0f, 1.0f, 0.0f);
  }
  return mesh;
}

}  // namespace

std::vector<FluidMesh> mesh_fluids(const Frame& frame, float cell) {
  std::vector<FluidMesh> meshes;
  const glm::vec3 eye(glm::inverse(frame.view.view)[3]);
  const std::size_t count = std::min(frame.particles.size(), frame.particle_fluid.size());
  for (std::size_t fluid = 0; fluid < frame.fluids.size(); ++fluid) {
    std::vector<glm::vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
      const float away = glm::distance(frame.particles[i], eye);
      if (frame.particle_fluid[i] == fluid && away < frame.view.far_plane)
        points.push_back(frame.particles[i]);
    }
    if (points.empty()) continue;
    meshes.push_back(mesh_of(points, frame.particle_radius, cell));
    meshes.back().fluid = static_cast<std::uint32_t>(fluid);
  }
  return meshes;
}

}  // namespace slosh::reference
