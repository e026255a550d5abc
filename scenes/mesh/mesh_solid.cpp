#include "scenes/mesh/mesh_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace slosh::mesh {

namespace {

// The triangles of each part.
std::vector<TriangleMesh> split(const WeldedMesh& mesh, const Components& parts) {
  TriangleMesh none;
  for (const auto& p : mesh.points) none.positions.emplace_back(p);
  std::vector<TriangleMesh> out(static_cast<std::size_t>(parts.count), none);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    out[static_cast<std::size_t>(parts.of_triangle[t])].triangles.push_back(mesh.triangles[t]);
  return out;
}

bool faces_inward(const TriangleMesh& part) {
  double volume = 0.0;
  for (const glm::uvec3& t : part.triangles) {
    const auto corner = [&](unsigned i) {
      return glm::dvec3(part.positions[i] - part.positions[part.triangles[0].x]);
    };
    volume += glm::dot(corner(t.x), glm::cross(corner(t.y), corner(t.z)));
  }
  return volume < 0.0;
}

// m from p to the tree's box; 0 inside.
float to_box(const MeshTree& tree, const glm::vec3& p) {
  return glm::distance(p, glm::clamp(p, tree.low(), tree.high()));
}

}  // namespace

MeshSolid::MeshSolid(const WeldedMesh& mesh, MeshTree tree, const Components& parts)
    : whole_(std::move(tree)) {
  constexpr float kHair = 1e-5f;  // of the longest side
  const glm::vec3 size = whole_.high() - whole_.low();
  hair_ = kHair * std::max({size.x, size.y, size.z});
  if (parts.count < 2) return;
  const std::vector<TriangleMesh> meshes = split(mesh, parts);
  cavities_ = std::ranges::any_of(meshes, faces_inward);
  if (cavities_) return;
  for (const TriangleMesh& part : meshes) parts_.emplace_back(part);
}

// Straight off a face its normal tells the side. Off an edge or a corner, and where the nearest face may be a
// cavity's, rays do, which take ten times as long.
DistanceSample MeshSolid::at(const MeshTree& tree, const glm::vec3& point) const {
  constexpr float kStraight = 0.999f;
  const NearestPoint near = tree.nearest(point);
  const float along = glm::dot(point - near.point, tree.face_normal(near.triangle));
  const bool straight = !cavities_ && std::abs(along) > kStraight * near.distance;
  const float side = (straight ? along < 0.0f : tree.inside(point)) ? -1.0f : 1.0f;
  // So near, the way to the surface is rounding.
  if (near.distance < hair_) return {side * near.distance, tree.face_normal(near.triangle)};
  return {side * near.distance, side / near.distance * (point - near.point)};
}

// A face that is inside another part is no surface: a bucket's wall is as deep where a handle ends in it.
DistanceSample MeshSolid::at(const glm::vec3& point) const {
  if (parts_.empty()) return at(whole_, point);
  DistanceSample nearest{std::numeric_limits<float>::infinity(), glm::vec3(0.0f)};
  for (const MeshTree& part : parts_) {
    const float off = to_box(part, point);
    if (off > 0.0f && off >= nearest.distance) continue;
    const DistanceSample s = at(part, point);
    if (s.distance < nearest.distance) nearest = s;
  }
  return nearest;
}

float MeshSolid::thickness(const glm::vec3& surface, const glm::vec3& inward) const {
  constexpr float kSlant = 0.5f;  // cosine
  struct Hit {
    float way, out;  // m; how far the face's normal goes along the way
  };
  std::vector<Hit> hits;
  int winding = 0;
  // From a hair before the surface, so that this is the first hit whatever the rounding.
  whole_.each_hit(surface - hair_ * inward, inward, [&](float way, int triangle) {
    hits.push_back({way - hair_, glm::dot(whole_.face_normal(triangle), inward)});
    winding += hits.back().out > 0.0f ? 1 : -1;
  });
  std::ranges::sort(hits, {}, &Hit::way);
  for (const Hit& hit : hits) {
    winding -= hit.out > 0.0f ? 1 : -1;
    if (winding <= 0 && hit.out > 0.0f && hit.way > hair_)
      return hit.out > kSlant ? hit.way : std::numeric_limits<float>::infinity();
  }
  return std::numeric_limits<float>::infinity();
}

}  // namespace slosh::mesh
