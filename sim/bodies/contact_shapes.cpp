// The surfaces that contacts are looked for on: their points, which of them are flat, and clusters of them.
#include <algorithm>
#include <numeric>

#include "sim/bodies/contacts.h"
#include "sim/bodies/corners.h"

namespace slosh {

namespace {

// Points whose neighbours within `reach` all have their normal, but for those that are round an edge.
std::vector<char> flat_points(const std::vector<glm::vec3>& points, const std::vector<glm::vec3>& normals,
                              float reach) {
  constexpr float kSame = 0.9999f, kRoundAnEdge = 0.8f;
  std::vector<std::uint32_t> along(points.size());  // by x, so that near ones are near
  std::iota(along.begin(), along.end(), 0u);
  std::sort(along.begin(), along.end(),
            [&](std::uint32_t a, std::uint32_t b) { return points[a].x < points[b].x; });
  std::vector<char> flat(points.size(), 1);
  for (std::size_t n = 0; n < along.size(); ++n) {
    const std::uint32_t i = along[n];
    for (std::size_t m = n + 1; m < along.size(); ++m) {
      const std::uint32_t j = along[m];
      if (points[j].x - points[i].x > reach) break;
      if (glm::distance(points[i], points[j]) > reach) continue;
      const float together = glm::dot(normals[i], normals[j]);
      if (together > kSame || together < kRoundAnEdge) continue;
      flat[i] = flat[j] = 0;
    }
  }
  return flat;
}

Corners corners_of(const TriangleMesh& mesh) {
  CornerFinder<glm::vec3> corners;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    const glm::vec3 area = glm::cross(b - a, c - a);
    if (!(glm::length(area) > 0.0f)) continue;
    const glm::vec3 normal = glm::normalize(area);
    for (const glm::vec3& p : {a, b, c}) corners.add(p, normal);
  }
  return corners.found();
}

}  // namespace

ContactFinder::ContactFinder(const Scene& scene, const SampledScene& sampled) : spacing_(sampled.spacing) {
  shapes_.resize(scene.bodies.size());
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    Shape& shape = shapes_[i];
    if (scene.bodies[i].point_probe) {  // a point that meets solids, and that nothing meets
      shape.points = {glm::vec3(0.0f)};
      shape.normals = {glm::vec3(0.0f)};
      shape.flat = {0};
      shape.clusters = {{glm::vec3(0.0f), 0.0f, {0}}};
      continue;
    }
    shape.points = sampled.surfaces[i].positions;
    shape.normals = sampled.surfaces[i].normals;
    shape.field = sampled.distance_fields[i];
    if (scene.bodies[i].mesh >= 0) {
      const Corners corners = corners_of(scene.meshes[static_cast<std::size_t>(scene.bodies[i].mesh)]);
      shape.points.insert(shape.points.end(), corners.points.begin(), corners.points.end());
      shape.normals.insert(shape.normals.end(), corners.normals.begin(), corners.normals.end());
    }
    measure(shape);
  }
}

// All that follows from the points and their normals.
void ContactFinder::measure(Shape& shape) const {
  shape.flat = flat_points(shape.points, shape.normals, static_cast<float>(1.5 * spacing_));
  shape.clusters.clear();
  if (shape.points.empty()) return;
  std::vector<std::uint32_t> all(shape.points.size());
  std::iota(all.begin(), all.end(), 0u);
  cluster(shape.points, all, shape.clusters);
  shape.lower = shape.upper = shape.points.front();
  shape.radius = 0.0;
  for (const glm::vec3& p : shape.points) {
    shape.lower = glm::min(shape.lower, p);
    shape.upper = glm::max(shape.upper, p);
    shape.radius = std::max(shape.radius, static_cast<double>(glm::length(p)));
  }
}

void ContactFinder::set_shape(int body, const NewShape* as) {
  Shape& shape = shapes_[static_cast<std::size_t>(body)];
  const auto whole = whole_.find(body);
  if (!as) {
    if (whole != whole_.end()) shape = whole->second;
    return;
  }
  if (whole == whole_.end()) whole_.emplace(body, shape);
  shape.points = as->points;
  shape.normals = as->normals;
  shape.field = as->field;
  measure(shape);
}

// Halves them across their longest side until few are left.
void ContactFinder::cluster(const std::vector<glm::vec3>& points, std::span<std::uint32_t> which,
                            std::vector<Cluster>& out) {
  constexpr std::size_t kTogether = 32;
  glm::vec3 lower = points[which.front()], upper = lower;
  for (const std::uint32_t i : which) {
    lower = glm::min(lower, points[i]);
    upper = glm::max(upper, points[i]);
  }
  if (which.size() > kTogether) {
    const glm::vec3 size = upper - lower;
    const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    const std::size_t half = which.size() / 2;
    std::nth_element(which.begin(), which.begin() + static_cast<std::ptrdiff_t>(half), which.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return points[a][axis] < points[b][axis]; });
    cluster(points, which.first(half), out);
    cluster(points, which.subspan(half), out);
    return;
  }
  Cluster all{0.5f * (lower + upper), 0.0f, {which.begin(), which.end()}};
  for (const std::uint32_t i : which) all.radius = std::max(all.radius, glm::distance(all.center, points[i]));
  out.push_back(std::move(all));
}

}  // namespace slosh
